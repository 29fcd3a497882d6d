// What of a ladder carries power.
#include <algorithm>
#include <set>
#include <utility>

#include "adapters/twincat/network_reader.h"
#include "adapters/xml/comparison.h"
#include "adapters/xml/operand.h"
#include "base/limits.h"

namespace twincat {

using base::same_name;
using network::Element;

namespace {

bool has_marked_pins(Node box) {
  return std::ranges::any_of(items(box, "InputFlags"), [](const Item& mark) {
    const std::string bits = mark ? member_text(mark.node, "Flags") : std::string();
    return !bits.empty() && bits != "0";
  });
}

}  // namespace

// AND and OR of what is BOOL are series and branches.
bool NetworkReader::is_logic(const Item& item) const {
  if (item.type != "BoxTreeBox" || flags_of(item.node) != 0) return false;
  const std::string type = member_text(item.node, "BoxType");
  if (!same_name(type, "AND") && !same_name(type, "OR")) return false;
  const std::vector<Item> pins = items(item.node, "InputItems");
  return !has_marked_pins(item.node) && texts(member(item.node, "InputParam"), "Names").empty() &&
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
  const std::vector<std::string> types = texts(member(item.node, "OutputParam"), "Types");
  const uint32_t output = leading_output(item.node).value_or(0);
  if (output < types.size()) return is_bool(types[output]);
  const std::string type = member_text(item.node, "BoxType");
  return !xml::comparison_sign(type).empty();
}

std::vector<Link> NetworkReader::contact(const Item& item, std::vector<Link> from) {
  const Node operand = member(item.node, "Operand");
  const network::Text text = this->operand(operand, "a contact");
  const uint32_t flags = marks(operand, kNegation | kRising | kFalling, "a contact");
  return contact(text, modifier_of(flags), std::move(from), item.node);
}

std::vector<Link> NetworkReader::contact(network::Text operand, Modifier modifier,
                                         std::vector<Link> from, Node at) {
  Element out;
  out.kind = Kind::kContact;
  out.operand = std::move(operand);
  out.modifier = modifier;
  out.inputs.resize(1);
  out.outputs.resize(1);
  connect(out.inputs[0], {std::move(from)}, at);
  return {{push(std::move(out)), 0}};
}

// What a comparison of variables and numbers is as a contact; "": it is something else.
std::string NetworkReader::compared(const Item& item) const {
  if (item.type != "BoxTreeBox" || (flags_of(item.node) & ~kNegation) != 0) return {};
  const std::string box = member_text(item.node, "BoxType");
  const bool led_away = std::ranges::any_of(items(member(item.node, "OutputItems"), "OutputItems"),
                                            [](const Item& pin) { return bool(pin); });
  if (xml::comparison_sign(box).empty() || led_away || is_true(item.node, "EN")) return {};
  std::vector<std::string> operands;
  for (const Item& pin : items(item.node, "InputItems")) {
    const Node operand = pin.type == "BoxTreeOperand" ? member(pin.node, "Operand") : Node();
    if (!operand || flags_of(operand) != 0) return {};
    operands.push_back(member_text(operand, "Operand"));
    if (!xml::is_operand(operands.back())) return {};
  }
  return operands.size() < 2 || has_marked_pins(item.node) ? std::string()
                                                           : xml::comparison_text(box, operands);
}

// Power that also needs the wire.
std::vector<Link> NetworkReader::both(std::vector<Link> from, Wire wire, Node at) {
  if (wire.from.empty()) fail(at, "nothing is connected to a branch");
  const bool all = from == rail();
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
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const Item& tree : trees) {
    links_ += from.size();
    if (links_ > base::kMaxLinks) {
      fail(tree.node, "its wires connect more than " + std::to_string(base::kMaxLinks) + " pairs");
    }
    for (Link link : power(tree, from)) {
      if (seen.emplace(link.element, link.output).second) out.push_back(link);
    }
  }
  return out;
}

namespace {

template <class Is>
bool any_below(const Item& item, Is is) {
  struct Finder : pugi::xml_tree_walker {
    explicit Finder(Is wanted) : is(wanted) {}
    bool for_each(Node& node) override { return !(found = is(node)); }
    Is is;
    bool found = false;
  } finder(is);
  Node node = item.node;
  return is(node) || (node.traverse(finder), finder.found);
}

bool calls_instance(const Item& item) {
  return any_below(item, [](Node node) {
    return xml::attribute(node, "n") == "Instance" && !member_text(node, "Operand").empty();
  });
}

bool is_rail(Node node) {
  if (!xml::is(node, "o")) return false;
  const std::string_view own = xml::attribute(node, "t");
  const std::string_view type = own.empty() ? xml::attribute(node.parent(), "cet") : own;
  return type == "BoxTreeTerminator" && !member(node, "Input");
}

// Does power come into it from the rail, or from what stands for that in a way of a branch?
bool begins_at_rail(const Item& item) {
  if (item.type == "BoxTreeTerminator" && !member(item.node, "Input")) return true;
  if (item.type == "BoxTreeBox") {
    const std::vector<Item> pins = items(item.node, "InputItems");
    return !pins.empty() && begins_at_rail(pins[0]);
  }
  const char* const inside = item.type == "BoxTreeAssign" ? "RValue" : "Input";
  return item && begins_at_rail(object_member(item.node, inside));
}

}  // namespace

// Where the editor says BoxShortCircuit, a block in a branch is not called while another branch has
// power. That is no form of a drawing here.
void NetworkReader::check_parallel(const Item& item, const std::vector<Item>& trees) {
  const std::string mode = member_text(item.node, "Mode");
  if (!mode.empty() && mode != "BoxShortCircuit" && mode != "Sequential") {
    fail(item.node, "branches of mode `" + mode + "` are not known here");
  }
  if (trees.empty()) fail(item.node, "a branch has no ways");
  if (mode == "Sequential" || trees.size() < 2) return;
  if (std::any_of(trees.begin(), trees.end(), calls_instance)) {
    fail(item.node, "a function block stands in a branch whose evaluation ends early",
         "call it in a network of its own, and make its output a contact");
  }
}

std::vector<Link> NetworkReader::power(const Item& item, std::vector<Link> from) {
  if (failed_) return {};
  if (item.type == "BoxTreeOperand") return contact(item, std::move(from));
  if (item.type == "BoxTreeTerminator") {  // without an input it is what feeds it
    marks(item.node, 0, "the end of a wire");
    const Item input = object_member(item.node, "Input");
    if (input) return power(input, std::move(from));
    return from == rail() ? feed_ : from;
  }
  if (item.type == "BoxTreeParallel") {
    marks(item.node, 0, "a branch");
    const std::vector<Item> trees = items(item.node, "Trees");
    check_parallel(item, trees);
    const Item input = object_member(item.node, "Input");
    if (input) from = power(input, std::move(from));
    std::vector<Link> around = std::exchange(feed_, from);  // boxes in the ways begin there
    std::vector<Link> out = branches(trees, from);
    feed_ = std::move(around);
    return out;
  }
  if (is_logic(item)) {
    const std::vector<Item> pins = items(item.node, "InputItems");
    if (same_name(member_text(item.node, "BoxType"), "OR")) return branches(pins, from);
    for (const Item& pin : pins) from = power(pin, std::move(from));
    return from;
  }
  if (const std::string text = compared(item); !text.empty()) {
    return contact({text, {}}, modifier_of(flags_of(item.node)), std::move(from), item.node);
  }
  // What begins where the branch does has its power already: that of a box is its output.
  if (feed_ != rail() && any_below(item, is_rail)) {
    if (from != feed_ || !begins_at_rail(item)) {
      fail(item.node, "the rail stands in the middle of a way of a branch");
    }
    from = rail();
  }
  return both(std::move(from), value(item), item.node);
}

}  // namespace twincat
