// Boxes: their pins, and what their outputs go to.
#include <algorithm>
#include <utility>

#include "adapters/twincat/network_reader.h"
#include "adapters/xml/operand.h"

namespace twincat {

using network::Element;

std::optional<uint32_t> leading_output(Node box) {
  const std::vector<Item> pins = items(member(box, "OutputItems"), "OutputItems");
  const std::vector<std::string> names = texts(member(box, "OutputParam"), "Names");
  const auto is_open = [](const Item& pin) { return !pin; };
  const auto open = std::count_if(pins.begin(), pins.end(), is_open);
  if (open == 1) {
    return static_cast<uint32_t>(std::find_if(pins.begin(), pins.end(), is_open) - pins.begin());
  }
  // An operator may say nothing of its only output.
  if (open == 0 && pins.empty() && names.size() < 2) return 0;
  return std::nullopt;
}

// What marks a pin; 0: nothing does.
Modifier NetworkReader::pin_mark(const Item& box, const std::vector<Item>& marks, size_t pin,
                                 bool connected) {
  if (pin >= marks.size() || !marks[pin]) return Modifier::kNone;
  const std::string bits = member_text(marks[pin].node, "Flags");
  if (bits == "0") return Modifier::kNone;
  if (connected && bits == "1") return Modifier::kNegated;
  if (connected && bits == "16") return Modifier::kRising;
  if (connected && bits == "32") return Modifier::kFalling;
  fail(box.node, "a pin of the box " + name_of(box.node) + " has the marks " + bits +
                     ", which are not known here");
  return Modifier::kNone;
}

void NetworkReader::box_inputs(const Item& item, Element& block) {
  const std::vector<std::string> names = texts(member(item.node, "InputParam"), "Names");
  const std::vector<Item> pins = items(item.node, "InputItems");
  const std::vector<Item> marks = items(item.node, "InputFlags");
  bool powered_pin = false;
  for (size_t i = 0; i < std::max(pins.size(), marks.size()) && !failed_; ++i) {
    if (i >= pins.size()) {
      pin_mark(item, marks, i, false);
      continue;
    }
    const bool may_be_power = ladder_ && carries_power(pins[i]);
    const bool plain = pins[i].type == "BoxTreeOperand";
    Wire wire = may_be_power && !(powered_pin && plain) ? powered(pins[i]) : value(pins[i]);
    powered_pin = powered_pin || may_be_power;
    network::Input input;
    if (i < names.size()) input.name = names[i];
    if (!input.name.empty() && !xml::is_name(input.name)) {
      fail(item.node, "a pin of the box " + name_of(item.node) + " is called `" + input.name + "`");
    }
    input.modifier = pin_mark(item, marks, i, !wire.from.empty());
    if (wire.from.empty()) {
      // What is not wired keeps its value; by position that would move those behind it.
      if (input.name.empty()) {
        fail(item.node, "a pin of the box " + name_of(item.node) + " is not connected",
             "connect it in TwinCAT");
      }
      continue;
    }
    connect(input, std::move(wire), item.node);
    block.inputs.push_back(std::move(input));
  }
  const bool named = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return base::same_name(name, "EN");
  });
  if (is_true(item.node, "EN") && !named) {
    fail(item.node, "the box " + name_of(item.node) + " has EN, and no pin of that name");
  }
}

void NetworkReader::box_outputs(const Item& item, uint32_t block) {
  const std::vector<Item> pins = items(member(item.node, "OutputItems"), "OutputItems");
  for (uint32_t i = 0; i < pins.size() && !failed_; ++i) {
    if (!pins[i] || member_text(pins[i].node, "Operand").empty()) continue;
    const uint32_t known = kNegation | kSet | kRising | kFalling;
    end(pins[i].node, marks(pins[i].node, known, "an output"), {{{block, i}}}, false);
  }
}

// `leads_on`: its value goes into what it stands in.
Wire NetworkReader::box(const Item& item, bool leads_on) {
  Element block;
  block.kind = Kind::kBlock;
  block.type.text = member_text(item.node, "BoxType");
  const Node called = member(item.node, "Instance");
  block.operand.text = member_text(called, "Operand");
  const std::string how = member_text(item.node, "CallType");
  if (is_true(item.node, "ProvidesSTSnippet") || member(item.node, "STSnippet")) {
    fail(item.node, "a box with statements of its own (EXECUTE) does not come in",
         "write its statements as an action or a function, and call that");
  }
  const bool instance = how == "FunctionBlock" || !block.operand.empty();
  if (instance && (block.operand.empty() || block.operand.text == "???")) {
    fail(item.node, "the box `" + block.type.text + "` calls an instance that has no name",
         "give its name in TwinCAT");
  }
  if (instance) block.operand = operand(called, "an instance");
  if (how == "Program") block.operand = block.type;  // it is its own instance
  if (!xml::is_dotted_name(block.type.text)) {
    fail(item.node, "a box is of type `" + block.type.text + "`, which is no name");
  }
  box_inputs(item, block);
  const std::vector<std::string> names = texts(member(item.node, "OutputParam"), "Names");
  const size_t pins = items(member(item.node, "OutputItems"), "OutputItems").size();
  for (size_t i = 0; i < std::max<size_t>({names.size(), pins, 1}); ++i) {
    block.outputs.push_back({i < names.size() ? names[i] : std::string(), false});
    if (block.outputs.back().name.empty() || xml::is_name(block.outputs.back().name)) continue;
    fail(item.node, "an output of the box " + name_of(item.node) + " is called `" +
                        block.outputs.back().name + "`");
  }
  const std::optional<uint32_t> output = leading_output(item.node);
  if (leads_on && !output) {
    fail(item.node, "which output of the box " + name_of(item.node) + " leads on is not said");
  }
  const uint32_t flags = marks(item.node, kNegation | kRising | kFalling, "a box");
  if (!leads_on && flags != 0) fail(item.node, "a box has marks, and nothing is behind it");
  if (failed_) return {};
  const uint32_t number = push(std::move(block));
  box_outputs(item, number);
  return {{{number, output.value_or(0)}}, modifier_of(flags)};
}

}  // namespace twincat
