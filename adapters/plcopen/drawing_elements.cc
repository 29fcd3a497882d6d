// XML elements -> elements of the model, not linked yet.
#include <algorithm>
#include <limits>

#include "adapters/plcopen/drawing.h"
#include "adapters/plcopen/plcopen.h"
#include "base/name_case.h"
#include "frontend/network/comments.h"

namespace plcopen {

using network::Element;
using network::Kind;
using network::Modifier;

uint64_t id_of(std::string_view text) {
  uint64_t out = 0;
  if (text.empty() || text.size() > 18) return 0;
  for (char c : text) {
    if (c < '0' || c > '9') return 0;
    out = out * 10 + static_cast<uint64_t>(c - '0');
  }
  return out + 1;
}

namespace {

int32_t whole(double value) {
  constexpr double kMost = 1'000'000'000;
  return value >= -kMost && value <= kMost ? static_cast<int32_t>(value) : 0;
}

// What an export writes for several comments is several again.
std::vector<std::string> paragraphs(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const size_t end = std::min(text.find("\n\n"), text.size());
    if (end > 0) out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(std::max(text.find_first_not_of('\n', end), end), text.size()));
  }
  return out;
}

// As text keeps a comment: blanks around its lines are layout.
std::string remark_of(Node node) { return network::comment_text("(*" + xml::text_of(node) + "*)"); }

}  // namespace

void Drawing::fail(Code code, Node node, std::string text, std::string fix) {
  failed_ = true;
  report_.add(code, node, std::move(text), std::move(fix));
}

Element Drawing::made(Node node, Kind kind) {
  Element out;
  out.kind = kind;
  Node position = xml::child(node, "position");
  out.position = {whole(position.attribute("x").as_double()),
                  whole(position.attribute("y").as_double()),
                  whole(node.attribute("width").as_double()),
                  whole(node.attribute("height").as_double()), static_cast<bool>(position)};
  out.id = id_of(xml::attribute(node, "localId"));
  if (out.id != 0) --out.id;
  const uint64_t order = id_of(xml::attribute(node, "executionOrderId"));
  if (order > 1 && order < std::numeric_limits<uint32_t>::max()) {
    out.order = static_cast<uint32_t>(order - 1);
  }
  Node note = xml::child(node, "documentation");
  if (note) out.comments = paragraphs(remark_of(note));
  return out;
}

Drawing::Raw& Drawing::record(Node node, What what, uint32_t element) {
  Raw raw;
  raw.node = node;
  raw.what = what;
  raw.element = element;
  raws_.push_back(std::move(raw));
  if (element != kNone) nodes_.emplace(element, node);
  std::string_view text = xml::attribute(node, "localId");
  const uint64_t id = id_of(text);
  if (id == 0) {
    fail(text.empty() ? Code::kXmlMissing : Code::kXmlBadValue, node,
         text.empty() ? xml::shown(node) + " has no attribute `localId`"
                      : "localId `" + std::string(text) + "` is no number");
  } else if (!by_id_.emplace(id, raws_.size() - 1).second) {
    fail(Code::kXmlDoubleId, node, "localId " + std::string(text) + " is there twice");
  }
  report_inside(node);
  return raws_.back();
}

// Vendors' data inside of an element: code of theirs is more than how it looks.
void Drawing::report_inside(Node node) {
  for (Node add : xml::children(node, "addData")) {
    for (Node data : xml::children(add, "data")) {
      if (is_vendor(data, kWireData)) continue;  // add_block() has read it
      if (is_vendor(data, "stcode")) {
        fail(Code::kXmlBody, data, xml::shown(node) + " holds statements of its own",
             "make them an ACTION, a function or a function block, and call that here");
      } else {
        std::vector<std::string>& kept = report_.out().kept.data[plcopen::place_of(node)];
        const size_t count = kept.size();
        report_data(data, report_);
        if (report_.origin(node) == node) kept.resize(count);  // the kept drawing has it
      }
    }
  }
}

uint32_t Drawing::push(Element element) {
  all_.elements.push_back(std::move(element));
  return static_cast<uint32_t>(all_.elements.size() - 1);
}

void Drawing::wait_for(uint32_t element, uint32_t input, Node owner, bool required) {
  pending_.push_back({element, input, xml::child(owner, "connectionPointIn"), required});
  if (required && !pending_.back().point) pending_.back().point = owner;
}

bool Drawing::negated(Node node) {
  std::string_view text = xml::attribute(node, "negated");
  std::optional<bool> value = xml::boolean(text);
  if (!text.empty() && !value) {
    fail(Code::kXmlBadValue, node,
         "negated=\"" + std::string(text) + "\" is neither true nor false");
  }
  return value.value_or(false);
}

Modifier Drawing::edge_of(Node node) {
  std::string_view edge = xml::attribute(node, "edge");
  if (edge == "rising") return Modifier::kRising;
  if (edge == "falling") return Modifier::kFalling;
  if (!edge.empty() && edge != "none") {
    fail(Code::kXmlBadValue, node, "edge `" + std::string(edge) + "` is unknown",
         "known are none, rising and falling");
  }
  return Modifier::kNone;
}

Modifier Drawing::storage_of(Node node) {
  std::string_view storage = xml::attribute(node, "storage");
  if (storage == "set") return Modifier::kSet;
  if (storage == "reset") return Modifier::kReset;
  if (!storage.empty() && storage != "none") {
    fail(Code::kXmlBadValue, node, "storage `" + std::string(storage) + "` is unknown",
         "known are none, set and reset");
  }
  return Modifier::kNone;
}

// negated, edge and, where it `stores`, storage: at most one of them.
Modifier Drawing::modifier_of(Node node, bool stores) {
  Modifier out = negated(node) ? Modifier::kNegated : Modifier::kNone;
  uint32_t count = out == Modifier::kNone ? 0 : 1;
  const Modifier edge = edge_of(node);
  if (edge != Modifier::kNone) {
    out = edge;
    ++count;
  }
  const Modifier storage = storage_of(node);
  if (storage != Modifier::kNone) {
    out = storage;
    ++count;
    if (!stores) fail(Code::kXmlBody, node, xml::shown(node) + " cannot set or reset anything");
  }
  if (count > 1) {
    fail(Code::kXmlBody, node,
         xml::shown(node) + " is several of negated, edge and storage at once",
         "make a block or a coil of its own of one of them");
  }
  return out;
}

std::string Drawing::operand(Node node, const char* name) {
  Node child = xml::child(node, name);
  std::string text = expression(child);
  if (text.empty()) {
    fail(Code::kXmlMissing, node, xml::shown(node) + " has no <" + std::string(name) + ">");
  }
  return text;
}

// What stands at an element or pin; empty when there is nothing.
std::string Drawing::expression(Node node) {
  std::string text(xml::trimmed(xml::text_of(node)));
  if (text.empty() || text == "???") return text;  // nothing yet, as an editor says it
  const bool good = is_operand(text);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (!good) fail(Code::kXmlBadValue, node, "`" + text + "` is no operand");
  return text;
}

void Drawing::add_rail(Node node, Kind kind) {
  Element rail = made(node, kind);
  if (kind == Kind::kLeftRail) rail.outputs.resize(1);
  if (kind == Kind::kRightRail) rail.inputs.resize(1);
  const uint32_t element = push(std::move(rail));
  record(node, What::kElement, element);
  if (kind != Kind::kRightRail) return;
  for (Node point : xml::children(node, "connectionPointIn")) {
    pending_.push_back({element, 0, point, false});
  }
}

void Drawing::add_contact(Node node, Kind kind) {
  Element element = made(node, kind);
  element.operand.text = operand(node, "variable");
  element.modifier = modifier_of(node, kind == Kind::kCoil);
  element.inputs.resize(1);
  element.outputs.resize(1);
  const uint32_t number = push(std::move(element));
  record(node, What::kElement, number);
  wait_for(number, 0, node, true);
}

bool Drawing::is_open(Node node) {
  const Node place = xml::child(node, "expression");
  const std::string text(xml::trimmed(xml::text_of(place)));
  if (!place || !(text.empty() || text == "???")) return false;
  record(node, What::kOpen, kNone);
  return true;
}

void Drawing::add_read(Node node, Kind kind) {
  if (is_open(node)) return;
  Element element = made(node, kind);
  element.operand.text = operand(node, "expression");
  element.outputs.resize(1);
  const Modifier modifier = modifier_of(node, false);
  if (modifier == Modifier::kNegated) {
    const bool name = xml::is_name(element.operand.text);
    element.operand.text =
        name ? "NOT " + element.operand.text : "NOT (" + element.operand.text + ")";
  }
  const uint32_t number = push(std::move(element));
  Raw& raw = record(node, What::kElement, number);
  if (modifier != Modifier::kNegated) raw.edge = modifier;
}

void Drawing::add_written(Node node, Kind kind) {
  if (is_open(node)) return;
  Element element = made(node, kind);
  element.operand.text = operand(node, "expression");
  element.inputs.resize(1);
  const Modifier modifier = modifier_of(node, true);
  const bool edge = modifier == Modifier::kRising || modifier == Modifier::kFalling;
  (edge ? element.inputs[0].modifier : element.modifier) = modifier;
  const uint32_t number = push(std::move(element));
  record(node, What::kElement, number);
  wait_for(number, 0, node, false);
}

// What is written is read after it.
void Drawing::add_both(Node node, Kind kind) {
  const bool plain = !xml::boolean(xml::attribute(node, "negatedIn")).value_or(false) &&
                     !xml::boolean(xml::attribute(node, "negatedOut")).value_or(false);
  if (!plain || edge_of(node) != Modifier::kNone) {
    fail(Code::kXmlBody, node, xml::shown(node) + " is negated or sees edges",
         "make a variable to read and one to write of it");
  }
  Element source = made(node, kind);
  source.operand.text = operand(node, "expression");
  source.outputs.resize(1);
  Element sink = made(node, Kind::kSink);
  sink.operand = source.operand;
  sink.inputs.resize(1);
  const uint32_t number = push(std::move(source));
  record(node, What::kInOut, number);
  if (!xml::find(node, {"connectionPointIn", "connection"})) return;
  const uint32_t written = push(std::move(sink));
  wait_for(written, 0, node, false);
  precedences_.push_back({written, number});
}

void Drawing::add_block(Node node, Kind kind) {
  Element element = made(node, kind);
  element.type.text = xml::trimmed(report_.required(node, "typeName"));
  element.operand.text = xml::trimmed(xml::attribute(node, "instanceName"));
  const std::string& type = element.type.text;
  const bool named = std::all_of(type.begin(), type.end(), [](char c) {
    return c == '.' || xml::is_name("x" + std::string(1, c));
  });
  const bool instance_is_name = element.operand.empty() || is_operand(element.operand.text);
  if (type.empty() || !named || !instance_is_name) {
    fail(Code::kXmlBadValue, node, xml::shown(node) + " has no type or instance that is a name");
  }
  for (Node data : xml::children(xml::child(node, "addData"), "data")) {
    const std::string wire(xml::trimmed(xml::text_of(data)));
    if (is_vendor(data, kWireData) && xml::is_name(wire)) element.wire.text = wire;
    // CODESYS; a program is its own instance.
    if (is_vendor(data, "fbdcalltype") && wire == "program") element.operand = element.type;
  }
  const uint32_t number = push(std::move(element));
  Raw raw;
  add_pins(node, number, raw);
  record(node, What::kElement, number).passed = std::move(raw.passed);
}

void Drawing::add_end(Node node, Kind kind) {
  Element element = made(node, kind);
  element.inputs.resize(1);
  element.inputs[0].modifier = negated(node) ? Modifier::kNegated : Modifier::kNone;
  if (kind == Kind::kJump) element.operand.text = report_.required_name(node, "label");
  if (kind == Kind::kJump && element.operand.empty()) failed_ = true;
  const uint32_t number = push(std::move(element));
  record(node, What::kElement, number);
  if (xml::find(node, {"connectionPointIn", "connection"})) {
    return wait_for(number, 0, node, true);
  }
  Element always = made(node, Kind::kSource);  // without a condition
  always.operand.text = "TRUE";
  always.outputs.resize(1);
  const uint32_t source = push(std::move(always));
  all_.elements[number].inputs[0].from.push_back({source, 0});
}

void Drawing::add_connector(Node node, Kind kind) {
  const What what = kind == Kind::kSink ? What::kConnector : What::kContinuation;
  record(node, what, kNone);
  const std::string name(report_.required(node, "name"));
  if (name.empty()) failed_ = true;
  if (what != What::kConnector || name.empty()) return;
  if (!connectors_.emplace(base::fold_name(name), raws_.size() - 1).second) {
    fail(Code::kDoubleConnector, node, "there are two connectors `" + name + "`");
  }
}

namespace {

// Titles and comments of networks, as CODESYS keeps them.
bool is_vendor_remark(Node node, const char* kind) {
  for (Node data : xml::children(xml::child(node, "addData"), "data")) {
    if (!is_vendor(data, "fbdelementtype")) continue;
    if (base::same_name(xml::trimmed(xml::text_of(data)), kind)) return true;
  }
  return false;
}

bool is_title(Node node) { return is_vendor_remark(node, "networktitle"); }

}  // namespace

void Drawing::add_remark(Node node, Kind) {
  const int32_t y = whole(xml::child(node, "position").attribute("y").as_double());
  const bool label = xml::is(node, "label");
  std::string text;
  if (label) {
    text = report_.required_name(node, "label");
    if (text.empty()) failed_ = true;
  } else {
    text = remark_of(xml::child(node, xml::is(node, "comment") ? "content" : "alternativeText"));
  }
  const bool title = xml::is(node, "vendorElement") && is_title(node);
  if (text.empty()) return;
  Node disabled;
  for (Node data : xml::children(xml::child(node, "addData"), "data")) {
    if (is_vendor(data, kDisabledData)) disabled = xml::child(data, "network");
  }
  remarks_.push_back({y, std::move(text), node, label, title, all_.elements.size(), y, disabled});
}

bool Drawing::add(Node node) {
  struct Form {
    const char* name;
    void (Drawing::*add)(Node, Kind);
    Kind kind;
  };
  static constexpr Form kForms[] = {{"contact", &Drawing::add_contact, Kind::kContact},
                                    {"coil", &Drawing::add_contact, Kind::kCoil},
                                    {"leftPowerRail", &Drawing::add_rail, Kind::kLeftRail},
                                    {"rightPowerRail", &Drawing::add_rail, Kind::kRightRail},
                                    {"block", &Drawing::add_block, Kind::kBlock},
                                    {"inVariable", &Drawing::add_read, Kind::kSource},
                                    {"outVariable", &Drawing::add_written, Kind::kSink},
                                    {"inOutVariable", &Drawing::add_both, Kind::kSource},
                                    {"jump", &Drawing::add_end, Kind::kJump},
                                    {"return", &Drawing::add_end, Kind::kReturn},
                                    {"connector", &Drawing::add_connector, Kind::kSink},
                                    {"continuation", &Drawing::add_connector, Kind::kSource},
                                    {"label", &Drawing::add_remark, Kind::kSource},
                                    {"comment", &Drawing::add_remark, Kind::kSource},
                                    {"vendorElement", &Drawing::add_remark, Kind::kSource}};
  for (const Form& form : kForms) {
    if (!xml::is(node, form.name)) continue;
    const bool remark = is_title(node) || is_vendor_remark(node, "networkcomment");
    if (form.name == std::string_view("vendorElement") && !remark) return false;
    (this->*form.add)(node, form.kind);
    return true;
  }
  return false;
}

}  // namespace plcopen
