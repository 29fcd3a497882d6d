// The call graph: no circle without a depth, stack and depth as declared (V11), one writer task for
// every output (V14).
#include <algorithm>
#include <map>

#include "base/limits.h"
#include "ir/bytecode/call_needs.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

class CallGraph {
 public:
  CallGraph(const Context& context, const CodeFactsOfAll& code)
      : image_(context.image), nodes_(code.size()), code_(code) {
    for (uint32_t i = 0; i < code.size(); ++i) {
      const LinkedPou& pou = image_.pous[i];
      nodes_[i].frame_bytes = pou.frame_size;
      nodes_[i].recursion_depth = pou.recursion_depth;
      if (code[i] == nullptr) continue;
      nodes_[i].callees = code[i]->callees;
      nodes_[i].native_bytes = code[i]->native_bytes;
    }
    DynamicCalls(image_).add_nodes(image_, context.pou_of_type, nodes_);
  }

  base::Result<CallFacts> run() {
    if (base::Status s = measure(); !s) return s.error();
    if (base::Status s = check_stack(); !s) return s.error();
    std::map<uint32_t, OutputWriter> writers;  // by the offset of the output
    CallFacts facts;
    facts.running.resize(code_.size());
    for (uint32_t t = 0; t < image_.tasks.size(); ++t) {
      const std::vector<uint32_t> pous = reachable(image_.tasks[t]);
      for (const uint32_t pou : pous) facts.running[pou] = true;
      if (image_.tasks[t].once) continue;  // it is over before others begin
      if (base::Status s = add_writers(t, pous, writers); !s) return s.error();
    }
    for (const auto& [data, row] : writers) facts.writers.push_back(row);
    return facts;
  }

 private:
  base::Status measure() {
    needs_ = measure_calls(nodes_);
    if (needs_.circle.empty()) return base::Ok{};
    const auto pou = std::find_if(needs_.circle.begin(), needs_.circle.end(),
                                  [&](uint32_t node) { return nodes_[node].is_pou; });
    const std::string name = pou == needs_.circle.end() ? "" : image_.pous[*pou].name;
    return refuse(Refusal::kStackUnbounded,
                  "POU `" + name + "` is in a circle of calls that has no depth");
  }

  // Tasks of different priority may lie on top of each other.
  base::Status check_stack() const {
    std::map<uint32_t, uint64_t> by_priority;
    uint64_t depth = 0;
    for (const ImageTask& task : image_.tasks) {
      for (uint32_t id : task.programs) {
        const uint32_t pou = image_.instances[id].pou;
        uint64_t& most = by_priority[task.priority];
        most = std::max(most, needs_.of[pou].bytes);
        depth = std::max(depth, needs_.of[pou].depth - 1);
      }
    }
    for (const LinkedMigration& row : image_.migrations) {
      const CallNeeds& needs = needs_.of[row.pou];
      if (needs.bytes > kStackLimit || needs.depth > base::kMaxCallDepth) {
        return refuse(Refusal::kStackUnbounded,
                      "migration `" + image_.pous[row.pou].name + "` needs too much stack");
      }
    }
    uint64_t sum = 0;
    for (const auto& [priority, bytes] : by_priority) sum += bytes;
    if (sum > image_.stack_bytes || depth > image_.call_depth) {
      return refuse(Refusal::kStackUnbounded, "the calls need " + std::to_string(sum) +
                                                  " bytes of stack and depth " +
                                                  std::to_string(depth) + ", declared are " +
                                                  std::to_string(image_.stack_bytes) + " and " +
                                                  std::to_string(image_.call_depth));
    }
    return base::Ok{};
  }

  base::Status add_writers(uint32_t t, const std::vector<uint32_t>& pous,
                           std::map<uint32_t, OutputWriter>& writers) const {
    for (const uint32_t pou : pous) {
      if (code_[pou] == nullptr) continue;
      for (const Extent& output : code_[pou]->written_outputs) {
        const auto [entry, added] =
            writers.try_emplace(output.offset, OutputWriter{output.offset, output.size, t});
        if (entry->second.task == t) continue;
        return refuse(Refusal::kBadIoAccess,
                      "the output at data offset " + std::to_string(output.offset) +
                          " is written by task `" + image_.tasks[entry->second.task].name +
                          "` and by task `" + image_.tasks[t].name + "`");
      }
    }
    return base::Ok{};
  }

  std::vector<uint32_t> reachable(const ImageTask& task) const {
    std::vector<bool> seen(nodes_.size());
    std::vector<uint32_t> found;
    const auto add = [&](uint32_t node) {
      if (seen[node]) return;
      seen[node] = true;
      found.push_back(node);
    };
    for (uint32_t id : task.programs) add(image_.instances[id].pou);
    for (size_t i = 0; i < found.size(); ++i) {
      for (uint32_t callee : nodes_[found[i]].callees) add(callee);
    }
    std::erase_if(found, [&](uint32_t node) { return !nodes_[node].is_pou; });
    return found;
  }

  const Image& image_;
  std::vector<CallNode> nodes_;
  const CodeFactsOfAll& code_;
  CallMeasure needs_;
};

}  // namespace

base::Result<CallFacts> verify_calls(const Context& context, const CodeFactsOfAll& code) {
  return CallGraph(context, code).run();
}

}  // namespace ir::verification
