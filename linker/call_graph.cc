#include "linker/call_graph.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "base/limits.h"

namespace linker {
namespace {

struct Node {
  std::vector<uint32_t> callees;
  uint64_t native_bytes = 0;  // argument slots of native calls in the next frame
};

class CallGraph {
 public:
  CallGraph(const ir::Image& image, const std::vector<const ir::Object*>& objects)
      : image_(image), nodes_(objects.size()), state_(objects.size()), needs_(objects.size()) {
    for (uint32_t i = 0; i < image.pous.size(); ++i) {
      by_name_.emplace(ir::fold_name(image.pous[i].name), i);
      if (image.pous[i].self.valid()) by_type_.emplace(image.pous[i].self.index, i);
    }
    for (uint32_t i = 0; i < objects.size(); ++i) {
      if (objects[i] != nullptr) nodes_[i] = node_of(*objects[i]);
    }
  }

  base::Result<StackNeeds> run() {
    for (uint32_t pou = 0; pou < nodes_.size(); ++pou) {
      if (base::Status status = visit(pou); !status.ok()) return status.error();
    }
    StackNeeds needs;
    std::map<uint32_t, uint64_t> by_priority;
    for (const ir::ImageTask& task : image_.tasks) {
      for (uint32_t program : task.programs) {
        const Needs& deepest = needs_[image_.instances[program].pou];
        uint64_t& bytes = by_priority[task.priority];
        bytes = std::max(bytes, deepest.bytes);
        needs.depth = std::max(needs.depth, deepest.depth);
      }
    }
    uint64_t total = 0;
    for (const auto& [priority, bytes] : by_priority) total += bytes;
    if (needs.depth > base::kMaxCallDepth || total > ir::kStackLimit) {
      return base::Error{base::Refusal::kTooMany,
                         "the deepest chain of calls has " + std::to_string(needs.depth) +
                             " POUs (limit " + std::to_string(base::kMaxCallDepth) +
                             ") and the stack needs " + std::to_string(total) + " bytes (limit " +
                             std::to_string(ir::kStackLimit) + ")"};
    }
    needs.bytes = static_cast<uint32_t>(total);
    return needs;
  }

 private:
  enum class State : uint8_t { kNew, kOpen, kDone };
  struct Needs {
    uint64_t bytes = 0;
    uint32_t depth = 0;
  };

  uint32_t pou_of(ir::TypeId type) const {
    const auto found = by_type_.find(type.index);
    return found == by_type_.end() ? static_cast<uint32_t>(nodes_.size()) : found->second;
  }

  // The function block type in the ID slot at a place.
  ir::TypeId called_type(const ir::Object& object, uint32_t place) const {
    const ir::Region region = object.places[place].result;
    return region.dim != 0 ? image_.types[region.type].base : region.type;
  }

  Node node_of(const ir::Object& object) const {
    Node node;
    const auto call = [&](uint32_t pou) {
      if (pou < nodes_.size()) node.callees.push_back(pou);
    };
    for (size_t i = 0; i < object.code.size(); ++i) {
      const ir::Unit& unit = object.code[i];
      switch (unit.opcode()) {
        case ir::Opcode::CALL:
          call(by_name_.at(ir::fold_name(object.callees[unit.c])));
          break;
        case ir::Opcode::CALL_INST:
          call(pou_of(called_type(object, unit.bc())));
          break;
        case ir::Opcode::CALL_INST_AT:
          call(pou_of(called_type(object, unit.c)));
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

  base::Error circle(const std::vector<std::pair<uint32_t, size_t>>& path, uint32_t again) const {
    std::string text;
    bool inside = false;
    for (const auto& [pou, next] : path) {
      inside |= pou == again;
      if (inside) text += image_.pous[pou].name + " -> ";
    }
    return {base::Refusal::kRecursion,
            text + image_.pous[again].name + ": the last call closes a circle."};
  }

  base::Status visit(uint32_t start) {
    std::vector<std::pair<uint32_t, size_t>> path;  // POU, next callee
    if (state_[start] == State::kNew) path.emplace_back(start, 0);
    while (!path.empty()) {
      const uint32_t pou = path.back().first;
      state_[pou] = State::kOpen;
      if (path.back().second < nodes_[pou].callees.size()) {
        const uint32_t callee = nodes_[pou].callees[path.back().second++];
        if (state_[callee] == State::kOpen) return circle(path, callee);
        if (state_[callee] == State::kNew) path.emplace_back(callee, 0);
        continue;
      }
      finish(pou);
      path.pop_back();
    }
    return base::Ok{};
  }

  void finish(uint32_t pou) {
    Needs& needs = needs_[pou];
    needs.bytes = nodes_[pou].native_bytes;
    for (uint32_t callee : nodes_[pou].callees) {
      needs.bytes = std::max(needs.bytes, needs_[callee].bytes);
      needs.depth = std::max(needs.depth, needs_[callee].depth);
    }
    needs.bytes += image_.pous[pou].frame_size;
    ++needs.depth;
    state_[pou] = State::kDone;
  }

  const ir::Image& image_;
  std::vector<Node> nodes_;
  std::vector<State> state_;
  std::vector<Needs> needs_;
  std::unordered_map<std::string, uint32_t> by_name_;
  std::unordered_map<uint32_t, uint32_t> by_type_;
};

}  // namespace

base::Result<StackNeeds> stack_needs(const ir::Image& image,
                                     const std::vector<const ir::Object*>& objects) {
  return CallGraph(image, objects).run();
}

}  // namespace linker
