#include "frontend/network/order.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

namespace frontend::network {
namespace {

constexpr uint32_t kNoNode = std::numeric_limits<uint32_t>::max();

// Element::order, y, x, number.
using Key = std::tuple<uint32_t, int32_t, int32_t, uint32_t>;

// A directed graph of elements: an edge leads to what is executed later.
class Graph {
 public:
  struct Edge {
    uint32_t to = 0;
    bool cuttable = false;  // from an output that keeps its value
  };
  // `data`: values that are kept nowhere, and precedences, alone.
  Graph(const Network& network, std::span<const Precedence> precedences, bool data = false);

  // Component of each element; elements of a loop share one.
  std::vector<uint32_t> components() const;
  // Takes edges out that may be cut and lie inside of a loop: those upwards, or all.
  void cut(bool all, const std::vector<Key>& keys);
  // Elements of one loop; empty: there is none.
  std::vector<uint32_t> loop() const;
  const std::vector<Edge>& behind(uint32_t element) const { return edges_[element]; }
  size_t size() const { return edges_.size(); }

 private:
  std::vector<std::vector<Edge>> edges_;
};

Graph::Graph(const Network& network, std::span<const Precedence> precedences, bool data)
    : edges_(network.elements.size()) {
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    for (const Input& input : network.elements[i].inputs) {
      for (Link link : input.from) {
        const Element& from = network.elements[link.element];
        const bool keeps = from.kind == Kind::kBlock && !from.operand.empty();
        if ((link.element != i || !keeps) && (!data || !keeps))
          edges_[link.element].push_back({i, keeps});
      }
    }
  }
  for (Precedence each : precedences) edges_[each.first].push_back({each.second, false});
  if (data) return;
  std::vector<std::pair<uint32_t, uint32_t>> given;
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    if (network.elements[i].order != 0) given.emplace_back(network.elements[i].order, i);
  }
  std::sort(given.begin(), given.end());
  for (size_t i = 1; i < given.size(); ++i) {
    if (given[i - 1].first == given[i].first) continue;
    edges_[given[i - 1].second].push_back({given[i].second, false});
  }
}

// Tarjan's algorithm without recursion.
std::vector<uint32_t> Graph::components() const {
  struct Frame {
    uint32_t element;
    size_t next;
  };
  const size_t count = edges_.size();
  std::vector<uint32_t> number(count, kNoNode), low(count), component(count, kNoNode), stack;
  std::vector<Frame> frames;
  uint32_t numbers = 0, components = 0;
  for (uint32_t root = 0; root < count; ++root) {
    if (number[root] != kNoNode) continue;
    frames.push_back({root, 0});
    while (!frames.empty()) {
      Frame& frame = frames.back();
      const uint32_t at = frame.element;
      if (frame.next == 0 && number[at] == kNoNode) {
        number[at] = low[at] = numbers++;
        stack.push_back(at);
      }
      if (frame.next < edges_[at].size()) {
        const uint32_t to = edges_[at][frame.next++].to;
        if (number[to] == kNoNode) {
          frames.push_back({to, 0});
        } else if (component[to] == kNoNode) {
          low[at] = std::min(low[at], number[to]);
        }
        continue;
      }
      if (low[at] == number[at]) {
        for (uint32_t member = kNoNode; member != at;) {
          member = stack.back();
          stack.pop_back();
          component[member] = components;
        }
        ++components;
      }
      frames.pop_back();
      if (!frames.empty()) {
        low[frames.back().element] = std::min(low[frames.back().element], low[at]);
      }
    }
  }
  return component;
}

void Graph::cut(bool all, const std::vector<Key>& keys) {
  const std::vector<uint32_t> component = components();
  for (uint32_t from = 0; from < edges_.size(); ++from) {
    std::erase_if(edges_[from], [&](Edge edge) {
      return edge.cuttable && component[from] == component[edge.to] &&
             (all || keys[edge.to] <= keys[from]);
    });
  }
}

std::vector<uint32_t> Graph::loop() const {
  const std::vector<uint32_t> component = components();
  std::vector<uint32_t> members(edges_.size(), 0);
  for (uint32_t each : component) ++members[each];
  for (uint32_t i = 0; i < edges_.size(); ++i) {
    const bool self =
        std::any_of(edges_[i].begin(), edges_[i].end(), [i](Edge edge) { return edge.to == i; });
    if (members[component[i]] < 2 && !self) continue;
    std::vector<uint32_t> out;
    for (uint32_t j = 0; j < edges_.size(); ++j) {
      if (component[j] == component[i]) out.push_back(j);
    }
    return out;
  }
  return {};
}

void renumber(Network& network, const std::vector<uint32_t>& sequence) {
  std::vector<uint32_t> place(sequence.size());
  for (uint32_t i = 0; i < sequence.size(); ++i) place[sequence[i]] = i;
  std::vector<Element> sorted;
  sorted.reserve(sequence.size());
  for (uint32_t from : sequence) sorted.push_back(std::move(network.elements[from]));
  for (Element& element : sorted) {
    for (Input& input : element.inputs) {
      for (Link& link : input.from) link.element = place[link.element];
    }
  }
  network.elements = std::move(sorted);
}

// Edges of `graph` are followed; of what could come next, the first by `keys`, and sinks at once.
std::vector<uint32_t> sequence_of(const Network& network, const Graph& graph,
                                  const std::vector<Key>& keys) {
  std::vector<uint32_t> waits(graph.size(), 0);
  for (uint32_t i = 0; i < graph.size(); ++i) {
    for (Graph::Edge edge : graph.behind(i)) ++waits[edge.to];
  }
  auto rank = [&](uint32_t i) {
    const bool at_once = network.elements[i].kind == Kind::kSink && waits[i] == 0;
    return std::pair(at_once ? 0 : 1, keys[i]);
  };
  using Entry = std::pair<std::pair<int, Key>, uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> ready;
  for (uint32_t i = 0; i < graph.size(); ++i) {
    if (waits[i] == 0) ready.push({{1, keys[i]}, i});
  }
  std::vector<uint32_t> out;
  while (!ready.empty()) {
    const uint32_t next = ready.top().second;
    ready.pop();
    out.push_back(next);
    for (Graph::Edge edge : graph.behind(next)) {
      if (--waits[edge.to] == 0) ready.push({rank(edge.to), edge.to});
    }
  }
  return out;
}

// What has no order of its own, as a contact, is read for the first that has one and needs it.
void inherit_orders(const Graph& graph, const std::vector<uint32_t>& sequence,
                    std::vector<Key>& keys) {
  for (auto from = sequence.rbegin(); from != sequence.rend(); ++from) {
    uint32_t& order = std::get<0>(keys[*from]);
    if (order != 0) continue;
    uint32_t least = kNoNode;
    for (Graph::Edge edge : graph.behind(*from)) {
      const uint32_t needed = std::get<0>(keys[edge.to]);
      if (needed != 0) least = std::min(least, needed);
    }
    if (least != kNoNode) order = least;
  }
}

}  // namespace

std::vector<uint32_t> order(Network& network, std::span<const Precedence> precedences) {
  Graph graph(network, precedences);
  std::vector<Key> keys;
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    const Element& element = network.elements[i];
    keys.emplace_back(element.order, element.position.y, element.position.x, i);
  }
  graph.cut(false, keys);
  graph.cut(true, keys);
  std::vector<uint32_t> loop = graph.loop();
  if (!loop.empty()) return loop;
  inherit_orders(graph, sequence_of(network, graph, keys), keys);
  renumber(network, sequence_of(network, graph, keys));
  return {};
}

std::vector<Precedence> follow_data(Network& network, std::span<const Precedence> precedences) {
  const size_t count = network.elements.size();
  const Graph graph(network, precedences, true);
  std::vector<Precedence> out;
  if (!graph.loop().empty()) return out;
  const std::vector<Key> no_keys(count);
  std::vector<uint32_t> latest(count, kNoNode);  // of what it reads, that with the last order
  const auto order_of = [&](uint32_t element) {
    return element == kNoNode ? 0 : network.elements[element].order;
  };
  for (const uint32_t at : sequence_of(network, graph, no_keys)) {
    uint32_t& own = network.elements[at].order;
    const uint32_t wanted = order_of(latest[at]);
    if (own != 0 && own < wanted) {
      out.push_back({latest[at], at});
      own = wanted;
    }
    const uint32_t last = own != 0 ? at : latest[at];
    for (Graph::Edge edge : graph.behind(at)) {
      if (order_of(last) > order_of(latest[edge.to])) latest[edge.to] = last;
    }
  }
  return out;
}

}  // namespace frontend::network
