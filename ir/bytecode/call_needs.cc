#include "ir/bytecode/call_needs.h"

#include <algorithm>
#include <span>

namespace ir {
namespace {

constexpr uint32_t kNotYet = 0xffffffffu;

// A node on the way down and its next callee.
struct Visit {
  uint32_t node;
  size_t next = 0;
};

// A circle among the nodes without a recursion depth; empty when there is none.
std::vector<uint32_t> undeclared_circle(const std::vector<CallNode>& nodes) {
  enum class State : uint8_t { kNew, kOpen, kDone };
  std::vector<State> states(nodes.size(), State::kNew);
  std::vector<Visit> path;
  for (uint32_t start = 0; start < nodes.size(); ++start) {
    if (states[start] == State::kNew && nodes[start].recursion_depth == 0) path.push_back({start});
    while (!path.empty()) {
      Visit& top = path.back();
      states[top.node] = State::kOpen;
      if (top.next == nodes[top.node].callees.size()) {
        states[top.node] = State::kDone;
        path.pop_back();
        continue;
      }
      const uint32_t callee = nodes[top.node].callees[top.next++];
      if (nodes[callee].recursion_depth != 0 || states[callee] == State::kDone) continue;
      if (states[callee] == State::kNew) {
        path.push_back({callee});
        continue;
      }
      std::vector<uint32_t> circle;
      for (const Visit& visit : path) {
        if (visit.node == callee || !circle.empty()) circle.push_back(visit.node);
      }
      return circle;
    }
  }
  return {};
}

class Measurer {
 public:
  explicit Measurer(const std::vector<CallNode>& nodes)
      : nodes_(nodes),
        needs_(nodes.size()),
        group_(nodes.size(), kNotYet),
        number_(nodes.size(), kNotYet),
        low_(nodes.size()),
        chains_(nodes.size()),
        has_chain_(nodes.size(), false) {}

  std::vector<CallNeeds> run() {
    for (uint32_t node = 0; node < nodes_.size(); ++node) {
      if (number_[node] == kNotYet) visit(node);
    }
    return std::move(needs_);
  }

 private:
  // Tarjan: groups are complete callees first.
  void visit(uint32_t start) {
    open(start);
    while (!path_.empty()) {
      Visit& top = path_.back();
      const uint32_t node = top.node;
      if (top.next < nodes_[node].callees.size()) {
        const uint32_t callee = nodes_[node].callees[top.next++];
        if (number_[callee] == kNotYet) {
          open(callee);
        } else if (group_[callee] == kNotYet) {
          low_[node] = std::min(low_[node], number_[callee]);
        }
        continue;
      }
      path_.pop_back();
      if (!path_.empty()) low_[path_.back().node] = std::min(low_[path_.back().node], low_[node]);
      if (low_[node] == number_[node]) close(node);
    }
  }

  void open(uint32_t node) {
    number_[node] = low_[node] = count_++;
    stack_.push_back(node);
    path_.push_back({node});
  }

  // The group is what lies on the stack from its root on.
  void close(uint32_t root) {
    size_t first = stack_.size();
    do {
      group_[stack_[--first]] = root;
    } while (stack_[first] != root);
    measure(std::span(stack_).subspan(first));
    stack_.resize(first);
  }

  // A group of one that does not call itself needs its own frame once.
  void measure(std::span<const uint32_t> members) {
    CallNeeds outside;
    uint64_t activations = 0;
    uint64_t declared_bytes = 0;
    for (uint32_t member : members) {
      const CallNode& node = nodes_[member];
      outside.bytes = std::max(outside.bytes, node.native_bytes);
      activations += node.recursion_depth;
      declared_bytes += node.recursion_depth * node.frame_bytes;
      for (uint32_t callee : node.callees) {
        if (group_[callee] == group_[member]) continue;
        outside.bytes = std::max(outside.bytes, needs_[callee].bytes);
        outside.depth = std::max(outside.depth, needs_[callee].depth);
      }
    }
    CallNeeds chain;
    for (uint32_t member : members) {
      const CallNeeds own = longest_chain(member);
      chain.bytes = std::max(chain.bytes, own.bytes);
      chain.depth = std::max(chain.depth, own.depth);
    }
    const uint64_t chains = members.size() == 1 && activations != 0 ? 0 : activations + 1;
    for (uint32_t member : members) {
      needs_[member].bytes = declared_bytes + chains * chain.bytes + outside.bytes;
      needs_[member].depth = activations + chains * chain.depth + outside.depth;
    }
  }

  // Through nodes of the same group without a recursion depth; these have no circle.
  CallNeeds longest_chain(uint32_t start) {
    if (nodes_[start].recursion_depth != 0) return {};
    chain_path_.assign(1, {start});
    while (!chain_path_.empty()) {
      Visit& top = chain_path_.back();
      const uint32_t node = top.node;
      if (has_chain_[node]) {
        chain_path_.pop_back();
        continue;
      }
      if (top.next < nodes_[node].callees.size()) {
        const uint32_t callee = nodes_[node].callees[top.next++];
        if (in_chain(node, callee) && !has_chain_[callee]) chain_path_.push_back({callee});
        continue;
      }
      CallNeeds longest;
      for (uint32_t callee : nodes_[node].callees) {
        if (!in_chain(node, callee)) continue;
        longest.bytes = std::max(longest.bytes, chains_[callee].bytes);
        longest.depth = std::max(longest.depth, chains_[callee].depth);
      }
      const uint32_t own = nodes_[node].is_pou ? 1 : 0;
      chains_[node] = {longest.bytes + nodes_[node].frame_bytes, longest.depth + own};
      has_chain_[node] = true;
      chain_path_.pop_back();
    }
    return chains_[start];
  }

  bool in_chain(uint32_t node, uint32_t callee) const {
    return group_[callee] == group_[node] && nodes_[callee].recursion_depth == 0;
  }

  const std::vector<CallNode>& nodes_;
  std::vector<CallNeeds> needs_;
  std::vector<uint32_t> group_;   // number of a member; kNotYet: not complete
  std::vector<uint32_t> number_;  // in order of the first visit
  std::vector<uint32_t> low_;
  std::vector<uint32_t> stack_;
  std::vector<Visit> path_;
  std::vector<CallNeeds> chains_;  // where has_chain_ says so
  std::vector<bool> has_chain_;
  std::vector<Visit> chain_path_;
  uint32_t count_ = 0;
};

CallNode choice() {
  CallNode node;
  node.is_pou = false;
  return node;
}

}  // namespace

void DynamicCalls::add_nodes(const Image& image, const std::vector<uint32_t>& pou_of_type,
                             std::vector<CallNode>& nodes) const {
  nodes.resize(size_t{pous_} * 2 + types_, choice());
  for (uint32_t i = 0; i < types_; ++i) {
    const TypeId type(i);
    if (pou_of_type[i] < pous_) nodes[any_body(type)].callees.push_back(pou_of_type[i]);
    const TypeId base = image.types[type].base;
    if (image.types[type].kind != Kind::kFunctionBlock || !base.valid()) continue;
    nodes[any_body(base)].callees.push_back(any_body(type));
  }
  for (const LinkedOverride& row : image.overrides) {
    nodes[any_target(row.prototype)].callees.push_back(row.target);
  }
}

CallMeasure measure_calls(const std::vector<CallNode>& nodes) {
  CallMeasure measure;
  measure.circle = undeclared_circle(nodes);
  if (measure.circle.empty()) measure.of = Measurer(nodes).run();
  return measure;
}

}  // namespace ir
