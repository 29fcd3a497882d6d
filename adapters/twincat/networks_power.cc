// What of a ladder carries power.
#include <algorithm>
#include <utility>

#include "adapters/twincat/network_reader.h"

namespace twincat {

using base::same_name;
using network::Element;

// AND and OR of what is BOOL are series and branches.
bool NetworkReader::is_logic(const Item& item) const {
  if (item.type != "BoxTreeBox" || flags_of(item.node) != 0) return false;
  const std::string type = member_text(item.node, "BoxType");
  if (!same_name(type, "AND") && !same_name(type, "OR")) return false;
  const std::vector<Item> pins = items(item.node, "InputItems");
  const std::vector<Item> marks = items(item.node, "InputFlags");
  const bool marked = std::any_of(marks.begin(), marks.end(), [](const Item& mark) {
    const std::string bits = mark ? member_text(mark.node, "Flags") : std::string();
    return !bits.empty() && bits != "0";
  });
  return !marked && texts(member(item.node, "InputParam"), "Names").empty() &&
         std::all_of(pins.begin(), pins.end(),
                     [this](const Item& pin) { return pin && carries_power(pin); });
}

bool NetworkReader::carries_power(const Item& item) const {
  if (item.type == "BoxTreeOperand") {
    const Node operand = member(item.node, "Operand");
    return !member_text(operand, "Operand").empty() && is_bool(member_text(operand, "Type"));
  }
  if (item.type != "BoxTreeBox") return bool(item);
  if (is_logic(item)) return true;
  const std::vector<Item> pins = items(member(item.node, "OutputItems"), "OutputItems");
  const std::vector<std::string> types = texts(member(item.node, "OutputParam"), "Types");
  const auto none = std::find_if(pins.begin(), pins.end(), [](const Item& pin) { return !pin; });
  const size_t output = none == pins.end() ? 0 : static_cast<size_t>(none - pins.begin());
  if (output < types.size()) return is_bool(types[output]);
  const std::string type = member_text(item.node, "BoxType");
  for (const char* name : {"EQ", "NE", "LT", "LE", "GT", "GE"}) {
    if (same_name(type, name)) return true;
  }
  return false;
}

std::vector<Link> NetworkReader::contact(const Item& item, std::vector<Link> from) {
  const Node operand = member(item.node, "Operand");
  Element out;
  out.kind = Kind::kContact;
  out.operand.text = member_text(operand, "Operand");
  out.modifier = modifier_of(flags_of(operand));
  if (out.operand.text == "???") fail(item.node, "a contact has no variable", "give its name");
  out.inputs.resize(1);
  out.outputs.resize(1);
  connect(out.inputs[0], {std::move(from)}, item.node);
  return {{push(std::move(out)), 0}};
}

// Power that also needs the wire.
std::vector<Link> NetworkReader::both(std::vector<Link> from, Wire wire, Node at) {
  const bool all = from == std::vector<Link>{rail()};
  if (all && wire.modifier == Modifier::kNone) return wire.from;
  Element block;
  block.kind = Kind::kBlock;
  block.type.text = "AND";
  block.inputs.resize(2);
  block.outputs.resize(1);
  connect(block.inputs[0], {std::move(from)}, at);
  connect(block.inputs[1], std::move(wire), at);
  return {{push(std::move(block)), 0}};
}

std::vector<Link> NetworkReader::branches(const std::vector<Item>& trees,
                                          const std::vector<Link>& from) {
  std::vector<Link> out;
  for (const Item& tree : trees) {
    for (Link link : power(tree, from)) {
      if (std::find(out.begin(), out.end(), link) == out.end()) out.push_back(link);
    }
  }
  return out;
}

std::vector<Link> NetworkReader::power(const Item& item, std::vector<Link> from) {
  if (failed_) return {};
  if (item.type == "BoxTreeOperand") return contact(item, std::move(from));
  if (item.type == "BoxTreeTerminator") {  // without an input it is the rail
    const Item input = object_member(item.node, "Input");
    return input ? power(input, std::move(from)) : from;
  }
  if (item.type == "BoxTreeParallel") {
    const Item input = object_member(item.node, "Input");
    return branches(items(item.node, "Trees"), input ? power(input, std::move(from)) : from);
  }
  if (is_logic(item)) {
    const std::vector<Item> pins = items(item.node, "InputItems");
    if (same_name(member_text(item.node, "BoxType"), "OR")) return branches(pins, from);
    for (const Item& pin : pins) from = power(pin, std::move(from));
    return from;
  }
  return both(std::move(from), value(item), item.node);
}

}  // namespace twincat
