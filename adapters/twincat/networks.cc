#include "adapters/twincat/networks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "adapters/twincat/network_reader.h"
#include "base/limits.h"
#include "frontend/network/head.h"

namespace twincat {
namespace {

using base::same_name;
using network::Element;
using xml::Code;

// A number, a text, TRUE, INT#5: nothing that could change.
bool is_literal(std::string_view operand) {
  if (operand.empty() || same_name(operand, "TRUE") || same_name(operand, "FALSE")) return true;
  const char quote = operand[0];
  if (quote == '\'' || quote == '"') return operand.find(quote, 1) == operand.size() - 1;
  const bool one = std::all_of(operand.begin(), operand.end(), [](char c) {
    return c == '#' || c == '.' || c == ':' || xml::is_name("_" + std::string(1, c));
  });
  const bool digit = operand[0] >= '0' && operand[0] <= '9';
  return one && (digit || operand.find('#') != std::string_view::npos);
}

Modifier storage_of(uint32_t flags) {
  if ((flags & kSet) != 0) return (flags & kNegation) != 0 ? Modifier::kReset : Modifier::kSet;
  return modifier_of(flags);
}

}  // namespace

Modifier modifier_of(uint32_t flags) {
  if ((flags & kRising) != 0) return Modifier::kRising;
  if ((flags & kFalling) != 0) return Modifier::kFalling;
  return (flags & kNegation) != 0 ? Modifier::kNegated : Modifier::kNone;
}

void NetworkReader::fail(Node at, const std::string& text, const std::string& fix) {
  if (!failed_) report_.add(Code::kXmlBody, at, "the body of " + what_ + ": " + text, fix);
  failed_ = true;
}

uint32_t NetworkReader::push(Element element) {
  out_.elements.push_back(std::move(element));
  return static_cast<uint32_t>(out_.elements.size() - 1);
}

void NetworkReader::connect(network::Input& input, Wire wire, Node at) {
  links_ += wire.from.size();
  if (links_ > base::kMaxLinks) {
    fail(at, "its wires connect more than " + std::to_string(base::kMaxLinks) + " pairs");
    return;
  }
  input.from = std::move(wire.from);
  if (input.modifier == Modifier::kNone) {
    input.modifier = wire.modifier;
  } else if (wire.modifier == Modifier::kNegated && input.modifier == Modifier::kNegated) {
    input.modifier = Modifier::kNone;
  } else if (wire.modifier != Modifier::kNone) {
    fail(at, "a pin has two marks, an edge and another one", "put a block or a variable between");
  }
}

std::string NetworkReader::name_of(Node box) const {
  const std::string instance = member_text(member(box, "Instance"), "Operand");
  return "`" + (instance.empty() ? member_text(box, "BoxType") : instance) + "`";
}

// --- values

Wire NetworkReader::value(const Item& item) {
  if (!item || failed_) return {};
  if (item.type == "BoxTreeOperand") {
    const Node operand = member(item.node, "Operand");
    Element source;
    source.kind = Kind::kSource;
    source.operand.text = member_text(operand, "Operand");
    source.outputs.resize(1);
    if (source.operand.empty()) return {};
    return {{{push(std::move(source)), 0}}, modifier_of(flags_of(operand))};
  }
  if (item.type == "BoxTreeBox") return box(item);
  if (item.type == "BoxTreeAssign") return assign(item);
  if (item.type == "BoxTreeDemux") return demux(item);
  if (item.type == "BoxTreeTerminator") {
    const Item input = object_member(item.node, "Input");
    return ladder_ ? Wire{power(item, {rail()})} : value(input);
  }
  if (item.type == "BoxTreeParallel" && ladder_) return {power(item, {rail()})};
  fail(item.node, "an element of type `" + std::string(item.type) + "` is not known here");
  return {};
}

// As text, a variable is read where its value is used: behind a box it is read here, once, however
// often it is used, and whatever is written meanwhile.
Wire NetworkReader::read_once(Wire wire, Node at) {
  if (wire.from.size() != 1) return wire;
  const Element& source = out_.elements[wire.from[0].element];
  if (source.kind != Kind::kSource || is_literal(source.operand.text)) return wire;
  Element block;
  block.kind = Kind::kBlock;
  block.type.text = "MOVE";
  block.inputs.resize(1);
  block.outputs.resize(1);
  connect(block.inputs[0], {wire.from}, at);
  return {{{push(std::move(block)), 0}}, wire.modifier};
}

// A wire that branches: one says what it carries, the others have its number.
Wire NetworkReader::demux(const Item& item) {
  const std::string number = member_text(item.node, "VarId");
  if (const Item input = object_member(item.node, "Input")) {
    Wire wire = ladder_ && carries_power(input) ? Wire{power(input, {rail()})} : value(input);
    wire = read_once(std::move(wire), item.node);
    wires_[number] = wire;
    return wire;
  }
  const auto known = wires_.find(number);
  if (known != wires_.end()) return known->second;
  fail(item.node, "a branch leads from wire " + number + ", which begins nowhere in front of it");
  return {};
}

// --- boxes

void NetworkReader::box_inputs(const Item& item, Element& block) {
  const std::vector<std::string> names = texts(member(item.node, "InputParam"), "Names");
  const std::vector<Item> pins = items(item.node, "InputItems");
  const std::vector<Item> marks = items(item.node, "InputFlags");
  bool powered = false;
  for (size_t i = 0; i < pins.size() && !failed_; ++i) {
    const bool may_be_power = ladder_ && carries_power(pins[i]);
    const bool plain = pins[i].type == "BoxTreeOperand";
    Wire wire =
        may_be_power && !(powered && plain) ? Wire{power(pins[i], {rail()})} : value(pins[i]);
    powered = powered || may_be_power;
    network::Input input;
    if (i < names.size()) input.name = names[i];
    if (wire.from.empty()) {
      // What is not wired keeps its value; by position that would move those behind it.
      if (input.name.empty() && !failed_) {
        fail(item.node, "a pin of the box " + name_of(item.node) + " is not connected",
             "connect it in TwinCAT");
      }
      continue;
    }
    if (i < marks.size() && marks[i]) {
      const Node mark = xml::is(marks[i].node, "o") ? marks[i].node : Node();
      const std::string bits = member_text(mark, "Flags");
      if (bits == "1") input.modifier = Modifier::kNegated;
      if (bits == "16") input.modifier = Modifier::kRising;
      if (bits == "32") input.modifier = Modifier::kFalling;
      if (!bits.empty() && bits != "0" && input.modifier == Modifier::kNone) {
        fail(item.node, "a pin of the box " + name_of(item.node) + " has the marks " + bits +
                            ", which are not known here");
      }
    }
    connect(input, std::move(wire), item.node);
    block.inputs.push_back(std::move(input));
  }
}

// Writes what outputs go to; gives the output that leads on: the one without an entry.
uint32_t NetworkReader::box_outputs(const Item& item, uint32_t block) {
  const std::vector<Item> pins = items(member(item.node, "OutputItems"), "OutputItems");
  uint32_t leads_on = 0;
  bool found = false;
  for (uint32_t i = 0; i < pins.size() && !failed_; ++i) {
    if (!pins[i]) {
      if (!found) leads_on = i;
      found = true;
      continue;
    }
    if (member_text(pins[i].node, "Operand").empty()) continue;
    end(pins[i].node, flags_of(pins[i].node), {{{block, i}}}, false);
  }
  return leads_on;
}

Wire NetworkReader::box(const Item& item) {
  Element block;
  block.kind = Kind::kBlock;
  block.type.text = member_text(item.node, "BoxType");
  block.operand.text = member_text(member(item.node, "Instance"), "Operand");
  const std::string how = member_text(item.node, "CallType");
  if (is_true(item.node, "ProvidesSTSnippet") || member(item.node, "STSnippet")) {
    fail(item.node, "a box with statements of its own (EXECUTE) does not come in",
         "write its statements as an action or a function, and call that");
  }
  const bool instance = how == "FunctionBlock" || !block.operand.empty();
  if (block.type.empty() || (instance && (block.operand.empty() || block.operand.text == "???"))) {
    fail(item.node, "the box `" + block.type.text + "` calls an instance that has no name",
         "give its name in TwinCAT");
  }
  box_inputs(item, block);
  const std::vector<std::string> names = texts(member(item.node, "OutputParam"), "Names");
  const size_t pins = items(member(item.node, "OutputItems"), "OutputItems").size();
  for (size_t i = 0; i < std::max<size_t>({names.size(), pins, 1}); ++i) {
    block.outputs.push_back({i < names.size() ? names[i] : std::string(), false});
  }
  if (failed_) return {};
  const uint32_t number = push(std::move(block));
  const uint32_t output = box_outputs(item, number);
  return {{{number, output}}, modifier_of(flags_of(item.node))};
}

// --- coils and other ends

// What a wire does to a variable, or where it jumps to.
void NetworkReader::end(Node target, uint32_t flags, const Wire& wire, bool power) {
  Element element;
  element.operand.text = member_text(target, "Operand");
  element.inputs.resize(1);
  connect(element.inputs[0], wire, target);
  if ((flags & kJump) != 0) {
    element.kind = Kind::kJump;
  } else if ((flags & kReturn) != 0) {
    element.kind = Kind::kReturn;
    element.operand = {};
  } else {
    element.kind = power ? Kind::kCoil : Kind::kSink;
    element.modifier = storage_of(flags);
    element.outputs.resize(power ? 1 : 0);
    // A variable sees no edges: the pin in front of it does.
    if (!power && (flags & (kRising | kFalling)) != 0) {
      element.modifier = Modifier::kNone;
      connect(element.inputs[0], {element.inputs[0].from, modifier_of(flags)}, target);
    }
    if (element.operand.text == "???" || element.operand.empty()) {
      fail(target, "a coil or output has no variable", "give its name in TwinCAT");
    }
  }
  push(std::move(element));
}

Wire NetworkReader::assign(const Item& item) {
  const Item from = object_member(item.node, "RValue");
  const std::vector<Item> targets = items(member(item.node, "OutputItems"), "OutputItems");
  const uint32_t own = flags_of(item.node);
  const bool bools = std::all_of(targets.begin(), targets.end(), [](const Item& target) {
    return is_bool(member_text(target.node, "Type"));
  });
  const bool is_power = ladder_ && bools && carries_power(from);
  Wire wire = is_power ? Wire{power(from, {rail()})} : value(from);
  if (targets.size() > 1) wire = read_once(std::move(wire), item.node);
  if (wire.from.empty() && !failed_) {
    report_.add(Code::kXmlLeftOut, item.node, "nothing is connected to a coil or output");
    return {};
  }
  for (const Item& target : targets) {
    const uint32_t flags = flags_of(target.node);
    const uint32_t marks = kNegation | kSet | kRising | kFalling;
    if ((own & marks & ~flags) != 0) {
      fail(item.node,
           "an assignment has the marks " + std::to_string(own) + ", which its variables have not");
    }
    end(target.node, flags | (own & (kJump | kReturn)), wire, is_power);
  }
  return wire;
}

// --- networks

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> out;
  text = xml::trimmed(text);
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    if (const std::string_view line = xml::trimmed(text.substr(0, end)); !line.empty()) {
      out.emplace_back(line);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

network::Network NetworkReader::run(Node network) {
  out_.title = network::title_of(xml::trimmed(member_text(network, "Title")));
  out_.label.text = member_text(network, "Label");
  out_.comments = lines_of(member_text(network, "Comment"));
  out_.disabled = is_true(network, "OutCommented");
  if (is_true(network, "ILActive") && !items(network, "ILLines").empty()) {
    fail(network, "an instruction list does not come in", "show it as FBD in TwinCAT, and save it");
  }
  if (ladder_) {
    Element left;
    left.kind = Kind::kLeftRail;
    left.outputs.resize(1);
    push(std::move(left));
  }
  for (const Item& item : items(network, "NetworkItems")) value(item);
  if (out_.elements.size() == (ladder_ ? 1 : 0)) out_.elements.clear();
  return std::move(out_);
}

std::optional<network::Body> read_networks(Node nwl, const std::string& what,
                                           xml::Reporter& report) {
  const Node object = find_object(nwl, "NWLImplementationObject");
  if (!object || !member(object, "NetworkList")) {
    report.add(Code::kXmlBody, nwl, "the body of " + what + " holds no list of networks");
    return std::nullopt;
  }
  network::Body body;
  const bool ladder = same_name(member_text(object, "DefaultViewMode"), "Ld");
  body.language = ladder ? network::Language::kLadder : network::Language::kFbd;
  uint32_t number = 0;
  bool failed = false;
  bool below_head = false;
  std::vector<std::string> comments = lines_of(member_text(object, "NetworkListComment"));
  for (const Item& item : items(object, "NetworkList")) {
    report.set_network(++number);
    NetworkReader reader(ladder, what, report);
    network::Network made = reader.run(item.node);
    failed = failed || reader.failed();
    comments.insert(comments.end(), made.comments.begin(), made.comments.end());
    // An empty one, as the editor makes them for new bodies.
    if (made.elements.empty() && made.label.empty()) {
      if (!made.title.empty()) comments.push_back(made.title);
      continue;
    }
    made.comments = std::move(comments);
    comments.clear();
    // As text, what stands below a network with a head needs one.
    made.headed = !made.title.empty() || made.disabled || (below_head && made.label.empty());
    below_head = made.headed;
    body.networks.push_back(std::move(made));
  }
  report.set_network(0);
  if (failed) return std::nullopt;
  if (!comments.empty()) body.networks.emplace_back().comments = std::move(comments);
  return body;
}

}  // namespace twincat
