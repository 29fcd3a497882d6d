#include "adapters/twincat/networks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "adapters/twincat/network_reader.h"
#include "adapters/xml/operand.h"
#include "base/limits.h"
#include "frontend/network/head.h"

namespace twincat {
namespace {

using base::same_name;
using network::Element;
using xml::Code;

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
  if (failed_) return;
  failed_ = true;
  if (out_.disabled) {  // nothing of it would be executed
    report_.add(Code::kXmlLeftOut, at, "a network that is commented out does not come in: " + text);
  } else {
    report_.add(Code::kXmlBody, at, "the body of " + what_ + ": " + text, fix);
  }
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

// The marks of an item, of which there may be some: an edge stands alone, as nobody says what an
// edge of a negated value is.
uint32_t NetworkReader::marks(Node owner, uint32_t known, const char* what) {
  const uint32_t flags = flags_of(owner);
  const uint32_t edges = flags & (kRising | kFalling);
  const uint32_t others = flags & (kNegation | kSet | kJump | kReturn);
  const bool alone = edges == 0 || ((edges == kRising || edges == kFalling) && others == 0);
  if ((flags & ~known) == 0 && alone) return flags;
  fail(owner, std::string(what) +
                  (flags == kUnreadable
                       ? " has marks that are no number"
                       : " has the marks " + std::to_string(flags) + ", which are not known here"));
  return 0;
}

// One expression and nothing else, since it stands between other text.
network::Text NetworkReader::operand(Node owner, const char* what) {
  const std::string text = member_text(owner, "Operand");
  if (text.empty() || text == "???") {
    fail(owner, std::string(what) + " has no variable", "give its name in TwinCAT");
  } else if (!xml::is_operand(text)) {
    fail(owner, std::string(what) + " is `" + text + "`, which is no expression");
  }
  return {text, {}};
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
    const uint32_t flags = marks(operand, kNegation | kRising | kFalling, "an operand");
    if (member_text(operand, "Operand").empty()) {
      if (flags != 0) fail(item.node, "an operand without a variable has marks");
      return {};
    }
    source.operand = this->operand(operand, "an operand");
    source.outputs.resize(1);
    return {{{push(std::move(source)), 0}}, modifier_of(flags)};
  }
  if (item.type == "BoxTreeBox") return box(item, true);
  if (item.type == "BoxTreeAssign") return assign(item, true);
  marks(item.node, 0, "a branch or the end of a wire");
  if (item.type == "BoxTreeDemux") return demux(item);
  if (item.type == "BoxTreeTerminator") {
    const Item input = object_member(item.node, "Input");
    return ladder_ ? powered(item) : value(input);
  }
  if (item.type == "BoxTreeParallel" && ladder_) return powered(item);
  fail(item.node, "an element of type `" + std::string(item.type) + "` is not known here");
  return {};
}

// As text, a variable is read where its value is used: behind a box it is read here, once, however
// often it is used, and whatever is written meanwhile.
Wire NetworkReader::read_once(Wire wire, Node at) {
  if (wire.from.size() != 1) return wire;
  const Element& source = out_.elements[wire.from[0].element];
  if (source.kind != Kind::kSource || xml::is_literal(source.operand.text)) return wire;
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
    Wire wire = ladder_ && carries_power(input) ? powered(input) : value(input);
    wire = read_once(std::move(wire), item.node);
    if (wire.from.empty()) fail(item.node, "nothing is connected to wire " + number);
    if (number.empty() || !wires_.emplace(number, wire).second) {
      fail(item.node, "there are two wires " + number);
    }
    return wire;
  }
  const auto known = wires_.find(number);
  if (known != wires_.end()) return known->second;
  fail(item.node, "a branch leads from wire " + number + ", which begins nowhere in front of it");
  return {};
}

// --- coils and other ends

// What a wire does to a variable, or where it jumps to.
void NetworkReader::end(Node target, uint32_t flags, const Wire& wire, bool power) {
  Element element;
  element.inputs.resize(1);
  const uint32_t flow = flags & (kJump | kReturn);
  const uint32_t rest = flags & ~flow;
  if (flow != 0) {
    if (flow == (kJump | kReturn) || (rest & kSet) != 0) {
      fail(target, "a jump has marks that are not known here");
    }
    element.kind = flow == kJump ? Kind::kJump : Kind::kReturn;
    if (flow == kJump) element.operand.text = member_text(target, "Operand");
    if (flow == kJump && !xml::is_name(element.operand.text)) {
      fail(target, "a jump goes to `" + element.operand.text + "`, which is no label");
    }
  } else {
    element.kind = power ? Kind::kCoil : Kind::kSink;
    element.operand = operand(target, "a coil or output");
    element.modifier = storage_of(rest);
    element.outputs.resize(power ? 1 : 0);
  }
  connect(element.inputs[0], wire, target);
  // A variable and a jump see no edges, and a jump has no mark of its own: the pin in front does.
  const bool edge = (rest & (kRising | kFalling)) != 0;
  if (flow != 0 || (!power && edge)) {
    element.modifier = Modifier::kNone;
    connect(element.inputs[0], {element.inputs[0].from, modifier_of(rest)}, target);
  }
  push(std::move(element));
}

// `leads_on`: its value goes somewhere else, too.
Wire NetworkReader::assign(const Item& item, bool leads_on) {
  const Item from = object_member(item.node, "RValue");
  const std::vector<Item> targets = items(member(item.node, "OutputItems"), "OutputItems");
  const uint32_t all = kNegation | kSet | kJump | kReturn | kRising | kFalling;
  const uint32_t own = marks(item.node, all, "an assignment");
  const bool bools = std::all_of(targets.begin(), targets.end(), [](const Item& target) {
    return is_bool(member_text(target.node, "Type"));
  });
  const bool is_power = ladder_ && bools && carries_power(from);
  Wire wire = is_power ? powered(from) : value(from);
  if (targets.size() > 1 || leads_on) wire = read_once(std::move(wire), item.node);
  if (wire.from.empty() && (own & (kJump | kReturn)) != 0) {
    fail(item.node, "nothing is connected to a jump or RETURN", "connect a condition in TwinCAT");
  }
  if (wire.from.empty() && !failed_) {
    report_.add(Code::kXmlLeftOut, item.node, "nothing is connected to a coil or output");
    return {};
  }
  if (targets.empty()) {
    if (own != kReturn) {
      fail(item.node, "an assignment has no variable");
    } else {
      end(item.node, own, wire, is_power);
    }
  }
  for (const Item& target : targets) {
    const uint32_t flags = marks(target.node, all, "a coil or output");
    if ((own & ~(kJump | kReturn) & ~flags) != 0) {
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
  out_.disabled = is_true(network, "OutCommented");
  out_.label.text = member_text(network, "Label");
  if (!out_.label.empty() && !xml::is_name(out_.label.text)) {
    fail(network, "the label `" + out_.label.text + "` is no name");
  }
  out_.comments = lines_of(member_text(network, "Comment"));
  if (is_true(network, "ILActive") && !items(network, "ILLines").empty()) {
    fail(network, "an instruction list does not come in", "show it as FBD in TwinCAT, and save it");
  }
  if (ladder_) {
    Element left;
    left.kind = Kind::kLeftRail;
    left.outputs.resize(1);
    push(std::move(left));
  }
  if (!xml::is(member(network, "NetworkItems"), "l2")) fail(network, "a network has no elements");
  if (!items(network, "Connectors").empty()) fail(network, "connectors are not known here");
  for (const Item& item : items(network, "NetworkItems")) {
    if (item.type == "BoxTreeBox") {
      box(item, false);
    } else if (item.type == "BoxTreeAssign") {
      assign(item, false);
    } else if (item) {
      value(item);
    } else {
      fail(network, "a network has an element that is none");
    }
  }
  if (failed_) out_.elements.clear();
  if (out_.elements.size() == (ladder_ ? 1 : 0)) out_.elements.clear();
  return std::move(out_);
}

std::optional<network::Body> read_networks(Node nwl, const std::string& what,
                                           xml::Reporter& report) {
  if (const ArchiveProblem problem = archive_problem(nwl); problem.node) {
    report.add(Code::kXmlBody, problem.node, "the body of " + what + ": " + problem.text);
    return std::nullopt;
  }
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
    failed = failed || (reader.failed() && !made.disabled);
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
