#include "linker/call_graph.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/limits.h"

namespace linker {
namespace {

constexpr uint32_t kNoPou = 0xffffffffu;

class CallGraph {
 public:
  CallGraph(const ir::Image& image, const std::vector<const ir::Object*>& objects)
      : image_(image),
        nodes_(objects.size()),
        by_type_(image.types.size(), kNoPou),
        dynamic_(image) {
    for (uint32_t i = 0; i < image.pous.size(); ++i) {
      by_name_.emplace(ir::fold_name(image.pous[i].name), i);
      if (ir::is_body(image.pous[i].kind)) by_type_[image.pous[i].self.index] = i;
    }
    for (uint32_t i = 0; i < objects.size(); ++i) {
      if (objects[i] != nullptr) nodes_[i] = node_of(*objects[i], i);
    }
    dynamic_.add_nodes(image, by_type_, nodes_);
  }

  std::vector<ir::CallNode> take_nodes() { return std::move(nodes_); }

  base::Result<StackNeeds> run() {
    const ir::CallMeasure measured = ir::measure_calls(nodes_);
    if (!measured.circle.empty()) return circle(measured.circle);
    StackNeeds needs;
    uint64_t depth = 0;
    std::map<uint32_t, uint64_t> by_priority;
    for (const ir::ImageTask& task : image_.tasks) {
      for (uint32_t program : task.programs) {
        const ir::CallNeeds& deepest = measured.of[image_.instances[program].pou];
        uint64_t& bytes = by_priority[task.priority];
        bytes = std::max(bytes, deepest.bytes);
        depth = std::max(depth, deepest.depth);
      }
    }
    uint64_t total = 0;
    for (const auto& [priority, bytes] : by_priority) total += bytes;
    if (depth > base::kMaxCallDepth || total > ir::kStackLimit) {
      return base::Error{base::Refusal::kTooMany,
                         "the deepest chain of calls has " + std::to_string(depth) +
                             " POUs (limit " + std::to_string(base::kMaxCallDepth) +
                             ") and the stack needs " + std::to_string(total) + " bytes (limit " +
                             std::to_string(ir::kStackLimit) + ")"};
    }
    needs.bytes = static_cast<uint32_t>(total);
    needs.depth = static_cast<uint32_t>(depth);
    return needs;
  }

 private:
  // The function block type in the ID slot at a place.
  ir::TypeId called_type(const ir::Object& object, uint32_t place) const {
    const ir::Region region = object.places[place].result;
    return region.dim != 0 ? image_.types[region.type].base : region.type;
  }

  ir::CallNode node_of(const ir::Object& object, uint32_t number) const {
    ir::CallNode node;
    node.frame_bytes = image_.pous[number].frame_size;
    node.recursion_depth = object.recursion_depth;
    const auto call = [&](uint32_t callee) {
      if (callee != kNoPou) node.callees.push_back(callee);
    };
    const auto named = [&](uint32_t callee) {
      return by_name_.at(ir::fold_name(object.callees[callee]));
    };
    for (size_t i = 0; i < object.code.size(); ++i) {
      const ir::Unit& unit = object.code[i];
      switch (unit.opcode()) {
        case ir::Opcode::CALL:
        case ir::Opcode::CALL_OWN:
          call(named(unit.c));
          break;
        case ir::Opcode::CALL_METHOD:
        case ir::Opcode::CALL_METHOD_AT:
        case ir::Opcode::CALL_METHOD_REF:
          call(named(object.code[i + 1].x()));
          break;
        case ir::Opcode::CALL_VIRTUAL:
          call(dynamic_.any_target(named(object.code[i + 1].x())));
          break;
        case ir::Opcode::CALL_INST:
          call(by_type_[called_type(object, unit.bc()).index]);
          break;
        case ir::Opcode::CALL_INST_AT:
          call(by_type_[called_type(object, unit.c).index]);
          break;
        case ir::Opcode::CALL_REF:
          call(dynamic_.any_body(object.regions[object.code[i + 1].x()].type));
          break;
        default:
          break;
      }
      if (ir::opcode_row(unit.opcode()).extended) ++i;
    }
    for (const ir::Slot& slot : object.slots) {
      if (slot.kind != ir::SlotKind::kNativeArg) continue;
      node.native_bytes = std::max<uint64_t>(node.native_bytes, 8 * (uint64_t{slot.param} + 1));
    }
    std::sort(node.callees.begin(), node.callees.end());
    node.callees.erase(std::unique(node.callees.begin(), node.callees.end()), node.callees.end());
    return node;
  }

  base::Error circle(std::vector<uint32_t> pous) const {
    std::erase_if(pous, [&](uint32_t node) { return !nodes_[node].is_pou; });
    std::string text;
    for (uint32_t pou : pous) text += image_.pous[pou].name + " -> ";
    return {base::Refusal::kRecursion,
            text + image_.pous[pous.front()].name +
                ": the last call closes a circle. Where this is meant, declare how deep it may go: "
                "{attribute 'recursion_depth' := '20'}."};
  }

  const ir::Image& image_;
  std::vector<ir::CallNode> nodes_;
  std::unordered_map<std::string, uint32_t> by_name_;
  std::vector<uint32_t> by_type_;  // bodies
  ir::DynamicCalls dynamic_;
};

// What the instructions of an object call, by kind and by name or type.
std::set<std::string> calls_of(const ir::Object& object) {
  std::set<std::string> calls;
  const auto named = [&](const char* kind, uint32_t callee) {
    calls.insert(kind + ir::fold_name(object.callees[callee]));
  };
  const auto typed = [&](ir::Region region) {
    calls.insert("of " + std::to_string(region.type.index) + "." + std::to_string(region.dim));
  };
  for (size_t i = 0; i < object.code.size(); ++i) {
    const ir::Unit& unit = object.code[i];
    const bool extended = ir::opcode_row(unit.opcode()).extended;
    const uint32_t x = extended ? object.code[i + 1].x() : 0;
    switch (unit.opcode()) {
      case ir::Opcode::CALL:
      case ir::Opcode::CALL_OWN:
        named("", unit.c);
        break;
      case ir::Opcode::CALL_METHOD:
      case ir::Opcode::CALL_METHOD_AT:
      case ir::Opcode::CALL_METHOD_REF:
        named("", x);
        break;
      case ir::Opcode::CALL_VIRTUAL:
        named("any ", x);
        break;
      case ir::Opcode::CALL_INST:
        typed(object.places[unit.bc()].result);
        break;
      case ir::Opcode::CALL_INST_AT:
        typed(object.places[unit.c].result);
        break;
      case ir::Opcode::CALL_REF:
        calls.insert("any of " + std::to_string(object.regions[x].type.index));
        break;
      default:
        break;
    }
    i += extended ? 1 : 0;
  }
  return calls;
}

uint32_t native_slots(const ir::Object& object) {
  uint32_t slots = 0;
  for (const ir::Slot& slot : object.slots) {
    if (slot.kind == ir::SlotKind::kNativeArg) slots = std::max(slots, slot.param + 1);
  }
  return slots;
}

}  // namespace

bool same_calls(const ir::Object& a, const ir::Object& b) {
  return calls_of(a) == calls_of(b) && native_slots(a) == native_slots(b);
}

std::vector<ir::CallNode> call_nodes(const ir::Image& image,
                                     const std::vector<const ir::Object*>& objects) {
  return CallGraph(image, objects).take_nodes();
}

base::Result<StackNeeds> stack_needs(const ir::Image& image,
                                     const std::vector<const ir::Object*>& objects) {
  return CallGraph(image, objects).run();
}

}  // namespace linker
