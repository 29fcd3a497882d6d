// Networks as elements. The order of execution is written down; places are those of the drawing
// that was imported, or are laid out: inputs left of what uses them, networks below each other.
#include <algorithm>
#include <limits>
#include <set>

#include "adapters/plcopen/expression_boxes.h"
#include "adapters/plcopen/for_others.h"
#include "adapters/plcopen/iec10.h"
#include "adapters/plcopen/layout.h"
#include "adapters/plcopen/plcopen.h"
#include "adapters/plcopen/writer.h"
#include "base/name_case.h"
#include "frontend/network/same.h"

namespace plcopen {

namespace network = frontend::network;
using network::Element;
using network::Kind;
using network::Link;
using network::Modifier;

class DiagramWriter {
 public:
  DiagramWriter(Writer& writer, const network::Body& body, Node parent)
      : writer_(writer),
        body_(body),
        body_node_(parent),
        parent_(parent),
        by_order_(writer.in_.form == Edition::kIec10) {}

  // False: its elements would do something else.
  bool run() {
    placed_ = !by_order_;
    for (const network::Network& each : body_.networks) {
      for (const Element& element : each.elements) {
        placed_ = placed_ && element.position.known;
        next_id_ = std::max(next_id_, element.id);
      }
      placed_ = placed_ && !each.disabled;  // no place is left for it
    }
    if (next_id_ > kMaxId) placed_ = false;
    ordered_ = by_order_ || !is_order_of_places();
    for (const network::Network& each : body_.networks) put(each);
    return said_;
  }

 private:
  static constexpr uint64_t kMaxId = 1'000'000'000'000;

  void fail(base::SourceSpan at, const char* text) {
    said_ = false;
    writer_.fail(at, text);
  }
  void put(const network::Network& network);
  void put_head(const network::Network& network, int32_t y);
  void put_title(const std::string& title, int32_t y);
  void put_comment(const std::string& text, int32_t y, bool disabled);
  std::vector<Place> places(const network::Network& network);
  bool is_order_of_places();
  void put_element(const network::Network& network, uint32_t number, Place place);
  void put_block(const network::Network& network, const Element& element, Node node);
  void put_pin(const network::Network& network, Node list, const network::Input& input,
               const std::string& name);
  void put_links(const network::Network& network, Node owner, const network::Input& input);
  uint64_t inverted(const network::Network& network, const network::Input& input, Place place);
  void put_connection(const network::Network& network, Node point, Link link);
  Node node(const char* name, Place place, uint64_t id);
  static std::string output_name(const Element& element, uint32_t output);
  uint64_t new_id() { return ++next_id_; }

  Writer& writer_;
  const network::Body& body_;
  Node body_node_;
  Node parent_;
  bool by_order_;  // IEC 61131-10 has networks, and no order within one but that of places
  bool placed_ = false;
  bool ordered_ = true;  // elements say their order
  bool said_ = true;
  std::set<uint64_t> used_;  // ids
  uint64_t next_id_ = 0;
  uint32_t order_ = 0;
  int32_t y_ = 20;  // where the next network begins
  std::vector<uint64_t> ids_;
};

Node DiagramWriter::node(const char* name, Place place, uint64_t id) {
  Node out = parent_.append_child(name);
  out.append_attribute("localId") = static_cast<unsigned long long>(id);
  Node position = out.append_child("position");
  position.append_attribute("x") = place.x;
  position.append_attribute("y") = place.y;
  return out;
}

// Those of the drawing that was imported, or laid out.
std::vector<Place> DiagramWriter::places(const network::Network& network) {
  std::vector<Place> out;
  if (placed_) {
    for (const Element& element : network.elements) {
      out.push_back({element.position.x, element.position.y});
    }
    return out;
  }
  Layout layout = lay_out(network, y_, by_order_);
  y_ = layout.bottom + 40;
  if (by_order_ && !in_order(network, layout.at, false)) {
    fail(network.span,
         "the order of execution of this network follows from nothing that IEC 61131-10 has an "
         "element for");
  }
  return std::move(layout.at);
}

// Do ladders without an order of their own mean this one? Editors go by places then. Where some
// elements say an order, those of Beremiz and OpenPLC run them in front of all coils, which say
// none.
bool DiagramWriter::is_order_of_places() {
  if (body_.language != network::Language::kLadder) return false;
  const int32_t begin = y_;
  const bool same = std::ranges::all_of(body_.networks, [&](const network::Network& each) {
    return in_order(each, places(each), true);
  });
  y_ = begin;
  return same;
}

// As CODESYS does; others show the text. IEC 61131-10 has comments.
void DiagramWriter::put_title(const std::string& title, int32_t y) {
  if (by_order_) return put_comment(title, y, false);
  Node out = node("vendorElement", {20, y}, new_id());
  writer_.put_formatted(out.append_child("alternativeText"), title);
  for (const char* list : {"inputVariables", "inOutVariables", "outputVariables"}) {
    out.append_child(list);
  }
  Node type = Writer::data(out, "fbdelementtype").append_child("ElementType");
  type.append_attribute("xmlns") = "";
  type.append_child(pugi::node_pcdata).set_value("networktitle");
}

// `disabled`: it shows a network, which it is when it is read again.
void DiagramWriter::put_comment(const std::string& text, int32_t y, bool disabled) {
  Node out = node("comment", {20, y}, new_id());
  out.append_attribute("height") = 20;
  out.append_attribute("width") = 200;
  writer_.put_formatted(out.append_child("content"), text);
  if (!disabled || by_order_) return;
  const std::string shown = text.substr(kDisabledMark.size());
  Node data = out.append_child("addData").append_child("data");
  data.append_attribute("name") = kDisabledData;
  data.append_attribute("handleUnknown") = "discard";
  Node network = data.append_child("network");
  network.append_attribute("language") = shown.starts_with('|') ? "LADDER" : "FBD";
  network.append_child(pugi::node_pcdata).set_value(shown.c_str());
}

void DiagramWriter::put_head(const network::Network& network, int32_t y) {
  if (!network.title.empty()) put_title(network.title, y);
  for (const std::string& comment : network.comments) {
    put_comment(comment, y, network.disabled && &comment == &network.comments.back());
  }
  if (!network.label.empty()) {
    node("label", {20, y}, new_id()).append_attribute("label") = network.label.text.c_str();
  }
}

void DiagramWriter::put(const network::Network& network) {
  if (by_order_) {
    parent_ = body_node_.append_child("network");
    y_ = 20;
  }
  const int32_t top = y_;
  const bool head = !network.title.empty() || !network.comments.empty() || !network.label.empty();
  if (!placed_ && head) y_ += 20;
  std::vector<Place> at = places(network);
  int32_t first = placed_ ? std::numeric_limits<int32_t>::max() : top;
  for (size_t i = 0; i < at.size() && placed_; ++i) {
    const Kind kind = network.elements[i].kind;
    if (kind != Kind::kLeftRail && kind != Kind::kRightRail) first = std::min(first, at[i].y);
  }
  if (first == std::numeric_limits<int32_t>::max()) first = y_;  // no elements
  for (size_t i = 0; i < at.size() && placed_; ++i) {
    y_ = std::max(y_, at[i].y + std::max(network.elements[i].position.height, 0) + 40);
  }
  put_head(network, first);
  ids_.assign(network.elements.size(), 0);
  for (size_t i = 0; i < ids_.size(); ++i) {
    const uint64_t own = network.elements[i].id;
    // A rail of the drawing may stand in several networks.
    const bool keep = placed_ && own != 0 && used_.insert(own).second;
    ids_[i] = keep ? own : new_id();
  }
  for (uint32_t i = 0; i < network.elements.size(); ++i) put_element(network, i, at[i]);
}

std::string DiagramWriter::output_name(const Element& element, uint32_t output) {
  const std::string& name = element.outputs[output].name;
  return name.empty() ? "OUT" : name;
}

void DiagramWriter::put_connection(const network::Network& network, Node point, Link link) {
  const Element& from = network.elements[link.element];
  Node out = point.append_child("connection");
  out.append_attribute("refLocalId") = static_cast<unsigned long long>(ids_[link.element]);
  if (from.kind == Kind::kBlock) {
    out.append_attribute("formalParameter") = output_name(from, link.output).c_str();
  }
}

void DiagramWriter::put_links(const network::Network& network, Node owner,
                              const network::Input& input) {
  Node point = owner.append_child("connectionPointIn");
  for (Link link : input.from) put_connection(network, point, link);
}

// A block NOT for what no attribute of the element says.
uint64_t DiagramWriter::inverted(const network::Network& network, const network::Input& input,
                                 Place place) {
  const uint64_t id = new_id();
  Node block = node("block", {place.x - 10, place.y}, id);
  block.append_attribute("typeName") = "NOT";
  if (ordered_) block.append_attribute("executionOrderId") = ++order_;
  Node pin = block.append_child("inputVariables").append_child("variable");
  pin.append_attribute("formalParameter") = "IN";
  put_links(network, pin, input);
  Node out = block.append_child("outputVariables").append_child("variable");
  out.append_attribute("formalParameter") = "OUT";
  out.append_child("connectionPointOut");
  return id;
}

namespace {

void put_modifier(Node node, Modifier modifier) {
  if (modifier == Modifier::kNegated) node.append_attribute("negated") = "true";
  if (modifier == Modifier::kRising) node.append_attribute("edge") = "rising";
  if (modifier == Modifier::kFalling) node.append_attribute("edge") = "falling";
  if (modifier == Modifier::kSet) node.append_attribute("storage") = "set";
  if (modifier == Modifier::kReset) node.append_attribute("storage") = "reset";
}

const char* element_name(Kind kind) {
  switch (kind) {
    case Kind::kLeftRail:
      return "leftPowerRail";
    case Kind::kRightRail:
      return "rightPowerRail";
    case Kind::kContact:
      return "contact";
    case Kind::kCoil:
      return "coil";
    case Kind::kSource:
      return "inVariable";
    case Kind::kSink:
      return "outVariable";
    case Kind::kBlock:
      return "block";
    case Kind::kJump:
      return "jump";
    default:
      return "return";
  }
}

void put_operand(Node node, const char* name, const std::string& text) {
  node.append_child(name).append_child(pugi::node_pcdata).set_value(text.c_str());
}

}  // namespace

void DiagramWriter::put_pin(const network::Network& network, Node list, const network::Input& input,
                            const std::string& name) {
  Node pin = list.append_child("variable");
  pin.append_attribute("formalParameter") = name.c_str();
  put_modifier(pin, input.modifier);
  put_links(network, pin, input);
}

void DiagramWriter::put_block(const network::Network& network, const Element& element, Node out) {
  out.append_attribute("typeName") = element.type.text.c_str();
  if (!element.operand.empty()) {
    out.append_attribute("instanceName") = element.operand.text.c_str();
  }
  Node inputs = out.append_child("inputVariables");
  Node in_outs = out.append_child("inOutVariables");
  uint32_t position = 0;  // without EN
  for (const network::Input& input : element.inputs) {
    const bool enable = base::same_name(input.name, "EN");
    const std::string name =
        input.name.empty() ? writer_.input_name(element.type.text, position) : input.name;
    position += enable ? 0 : 1;
    const bool both = writer_.is_in_out(element.type.text, name);
    put_pin(network, both ? in_outs : inputs, input, name);
  }
  // Editors look for ENO in front.
  Node outputs = out.append_child("outputVariables");
  for (const bool enable : {true, false}) {
    for (uint32_t i = 0; i < element.outputs.size(); ++i) {
      if (base::same_name(element.outputs[i].name, "ENO") != enable) continue;
      Node pin = outputs.append_child("variable");
      pin.append_attribute("formalParameter") = output_name(element, i).c_str();
      if (element.outputs[i].negated) pin.append_attribute("negated") = "true";
      pin.append_child("connectionPointOut");
    }
  }
  if (element.wire.empty()) return;
  Node data = out.append_child("addData").append_child("data");
  data.append_attribute("name") = kWireData;
  data.append_attribute("handleUnknown") = "discard";
  data.append_child("wire").append_child(pugi::node_pcdata).set_value(element.wire.text.c_str());
}

void DiagramWriter::put_element(const network::Network& network, uint32_t number, Place place) {
  const Element& element = network.elements[number];
  const bool single = element.inputs.size() == 1 && element.kind != Kind::kBlock;
  Modifier modifier = element.modifier;
  uint64_t through = 0;  // a block in front of the input
  if (single && element.inputs[0].modifier != Modifier::kNone) {
    const Modifier own = element.inputs[0].modifier;
    const bool sink = element.kind == Kind::kSink;
    if (sink && modifier == Modifier::kNone) {
      modifier = own;
    } else if (own == Modifier::kNegated) {
      through = inverted(network, element.inputs[0], place);
    } else {
      fail(element.span, "an edge in front of this element has no attribute in PLCopen XML");
    }
  }
  const bool inline_negation = element.kind == Kind::kSource;
  // A rail that is left of a jump: a function block diagram has none.
  const bool as_true = element.kind == Kind::kLeftRail && body_.language == network::Language::kFbd;
  Node out = node(as_true ? "inVariable" : element_name(element.kind), place, ids_[number]);
  if (element.position.known && element.position.width > 0) {
    out.append_attribute("width") = element.position.width;
    out.append_attribute("height") = element.position.height;
  }
  const bool reads = element.kind == Kind::kContact;  // others read contacts when a coil needs them
  if (ordered_ && (acts(element.kind) || reads)) {
    out.append_attribute("executionOrderId") = ++order_;
  }
  if (!inline_negation) put_modifier(out, modifier);
  if (element.kind == Kind::kJump) out.append_attribute("label") = element.operand.text.c_str();
  if (element.kind == Kind::kBlock) {
    put_block(network, element, out);
  } else if (through != 0) {
    Node connection = out.append_child("connectionPointIn").append_child("connection");
    connection.append_attribute("refLocalId") = static_cast<unsigned long long>(through);
    connection.append_attribute("formalParameter") = "OUT";
  } else {
    for (const network::Input& input : element.inputs) put_links(network, out, input);
  }
  if (element.kind != Kind::kBlock && !element.outputs.empty()) {
    Node point = out.append_child("connectionPointOut");
    if (element.kind == Kind::kLeftRail && !as_true) point.append_attribute("formalParameter") = "";
  }
  if (as_true) put_operand(out, "expression", "TRUE");
  if (element.kind == Kind::kContact || element.kind == Kind::kCoil) {
    put_operand(out, "variable", element.operand.text);
  } else if (element.kind == Kind::kSource || element.kind == Kind::kSink) {
    put_operand(out, "expression", element.operand.text);
  }
  std::string note;  // a blank line between two comments
  for (const std::string& comment : element.comments) {
    note += (note.empty() ? "" : "\n\n") + comment;
  }
  writer_.put_documentation(out, note);
}

void Writer::diagram(Node body, const network::Body& drawn, const std::string& path) {
  const network::Body* best = &drawn;
  if (in_.kept != nullptr) {
    auto found = in_.kept->drawings.find(base::fold_name(path));
    if (found != in_.kept->drawings.end()) {
      const auto& [kept, text, elements] = found->second;
      const bool same = text.empty() ? kept.language == drawn.language &&
                                           network::canonical(kept) == network::canonical(drawn)
                                     : drawn.language == network::Language::kFbd &&
                                           text == network::canonical(drawn);
      if (same && !elements.empty() && in_.form != Edition::kIec10) {
        body.append_buffer(elements.data(), elements.size(), xml::kAsRead);
        return;
      }
      if (same) best = &kept;
    }
  }
  if (in_.form == Edition::kIec10 && !parts_) report_heads(drawn, diagnostics_);
  network::Body others = for_others(*best);
  if (const auto span = expressions_to_boxes(others)) {
    fail(*span, "no box of a function says what this expression does with a wire");
    return put_text(body, "ST", kTextOnlyBody);
  }
  Node parent = body.append_child(best->language == network::Language::kLadder ? "LD" : "FBD");
  if (DiagramWriter(*this, others, parent).run()) return;
  body.remove_child(parent);
  put_text(body, "ST", kTextOnlyBody);
}

}  // namespace plcopen
