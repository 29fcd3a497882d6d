#include "ir/lower/flow.h"

#include <algorithm>

namespace ir::codegen {
namespace {

// Before ordering, successors are node numbers: IR blocks first, then split edges.
using Graph = std::vector<FlowBlock>;

void split_edge(Graph& graph, uint32_t node, size_t successor, const Target& target) {
  FlowBlock edge;
  edge.edge = &target;
  edge.successors = {graph[node].successors[successor]};
  graph[node].successors[successor] = static_cast<uint32_t>(graph.size());
  graph.push_back(std::move(edge));
}

// The wanted ways of a switch; those that say the same share a block.
template <class Wanted>
bool split_switch(Graph& graph, uint32_t node, const Inst& end, Wanted wanted) {
  std::vector<size_t> split;
  for (size_t t = 0; t < end.targets.size(); ++t) {
    if (!wanted(t)) continue;
    const Target& way = end.targets[t];
    const auto same = std::find_if(split.begin(), split.end(), [&](size_t s) {
      return end.targets[s].block == way.block && end.targets[s].args == way.args;
    });
    if (same != split.end()) {
      graph[node].successors[t] = graph[node].successors[*same];
      continue;
    }
    split_edge(graph, node, t, way);
    split.push_back(t);
  }
  return !split.empty();
}

Graph graph_of(const Pou& pou) {
  Graph graph(pou.blocks.size());
  for (uint32_t i = 0; i < pou.blocks.size(); ++i) {
    graph[i].source = BlockId(i);
    for (const Target& target : pou.blocks[i].insts.back().targets) {
      graph[i].successors.push_back(target.block.index);
    }
  }
  for (uint32_t i = 0; i < pou.blocks.size(); ++i) {
    const Inst& end = pou.blocks[i].insts.back();
    if (end.op == Op::kSwitch) {
      split_switch(graph, i, end, [&](size_t t) { return !end.targets[t].args.empty(); });
    }
    if (end.op != Op::kBranch && end.op != Op::kTry) continue;
    for (size_t t = 0; t < end.targets.size(); ++t) {
      if (!end.targets[t].args.empty()) split_edge(graph, i, t, end.targets[t]);
    }
  }
  return graph;
}

// The last successor is visited first, so that the first one follows its branch.
std::vector<uint32_t> reverse_post_order(const Graph& graph) {
  std::vector<uint32_t> order;
  std::vector<bool> seen(graph.size());
  struct Visit {
    uint32_t node;
    size_t left;
  };
  std::vector<Visit> stack{{0, graph[0].successors.size()}};
  seen[0] = true;
  while (!stack.empty()) {
    Visit& top = stack.back();
    if (top.left == 0) {
      order.push_back(top.node);
      stack.pop_back();
      continue;
    }
    const uint32_t next = graph[top.node].successors[--top.left];
    if (seen[next]) continue;
    seen[next] = true;
    stack.push_back({next, graph[next].successors.size()});
  }
  std::reverse(order.begin(), order.end());
  return order;
}

std::vector<uint32_t> positions_of(const std::vector<uint32_t>& order, size_t nodes) {
  std::vector<uint32_t> positions(nodes, 0);
  for (uint32_t i = 0; i < order.size(); ++i) positions[order[i]] = i;
  return positions;
}

// Conditional jumps, entries of tables and ways to handlers go forwards only, so one of two
// backward edges gets a block, and so does a backward entry; a handler that comes before its try
// gets one in front.
bool split_backward(Graph& graph, const std::vector<uint32_t>& order, const Pou& pou) {
  const std::vector<uint32_t> positions = positions_of(order, graph.size());
  bool changed = false;
  for (uint32_t node : order) {
    if (graph[node].successors.size() < 2) continue;
    const Inst& end = pou.blocks[graph[node].source.index].insts.back();
    const auto is_back = [&](size_t t) {
      return positions[graph[node].successors[t]] <= positions[node];
    };
    if (end.op == Op::kSwitch) {
      changed |= split_switch(graph, node, end, [&](size_t t) { return t != 0 && is_back(t); });
      continue;
    }
    if (!is_back(1) || (end.op != Op::kTry && !is_back(0))) continue;
    split_edge(graph, node, 1, end.targets[1]);
    changed = true;
  }
  return changed;
}

}  // namespace

Flow order_blocks(const Pou& pou) {
  Graph graph = graph_of(pou);
  std::vector<uint32_t> order = reverse_post_order(graph);
  while (split_backward(graph, order, pou)) order = reverse_post_order(graph);
  const std::vector<uint32_t> positions = positions_of(order, graph.size());
  Flow flow;
  for (uint32_t node : order) {
    FlowBlock block = std::move(graph[node]);
    for (uint32_t& successor : block.successors) successor = positions[successor];
    if (block.source.valid()) {
      const BlockId handler = pou.blocks[block.source.index].handler;
      if (handler.valid()) block.handler = positions[handler.index];
    }
    flow.blocks.push_back(std::move(block));
  }
  return flow;
}

}  // namespace ir::codegen
