#include "frontend/network/branches.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "frontend/network/layout.h"

namespace frontend::network {

namespace {

constexpr uint32_t kNone = 0xffffffffu;

// The rung as a graph of points: an element leads from one to another. `element` is kNone for a
// wire.
struct Edge {
  uint32_t element = kNone;
  uint32_t to = 0;
};
struct Point {
  std::vector<Edge> out;
  uint32_t in = 0;
};

// From a point to where other branches arrive, too (`stop`), or to the rung's end (kNone).
struct Branch {
  Series items;
  uint32_t stop = kNone;
  uint32_t weight = 1;  // wires at `stop` that it stands for
};

bool is_power(Kind kind) { return is_placed(kind) || kind == Kind::kLeftRail; }

class Finder {
 public:
  explicit Finder(const Network& network) : network_(network) {}

  std::optional<Branches> run() {
    if (!find_pins() || !find_points()) return std::nullopt;
    std::optional<Branch> all = from(0, 0);
    // What is left over has no power.
    if (!all || all->stop != kNone || passed_ != placed_) return std::nullopt;
    result_.rung = std::move(all->items);
    return std::move(result_);
  }

 private:
  bool find_pins();
  bool input_pin(uint32_t element);
  bool output_pin(Link link);
  bool find_points();
  uint32_t point_of(const std::vector<Link>& links);
  std::optional<Branch> from(uint32_t point, uint32_t depth);
  std::optional<Branch> fork(uint32_t point, uint32_t depth);
  std::optional<Branch> walk(const Edge& edge, uint32_t depth);
  void append(Branch& branch, const Edge& edge);

  const Network& network_;
  Branches result_;
  std::vector<Point> points_;                        // 0: the left rail
  std::vector<uint32_t> behind_;                     // point behind an element
  std::map<std::vector<uint32_t>, uint32_t> joins_;  // by the points that meet
  uint32_t placed_ = 0;
  uint32_t passed_ = 0;
};

bool Finder::find_pins() {
  result_.pins.resize(network_.elements.size());
  for (uint32_t i = 0; i < network_.elements.size(); ++i) {
    const Element& element = network_.elements[i];
    if (is_placed(element.kind) && !input_pin(i)) return false;
    if (element.kind != Kind::kSink) continue;
    for (Link link : element.inputs.empty() ? std::vector<Link>{} : element.inputs[0].from) {
      if (network_.elements[link.element].kind != Kind::kBlock) return false;
    }
  }
  return true;
}

// The one input that is linked to power. Sources stand at the other inputs of boxes.
bool Finder::input_pin(uint32_t i) {
  const Element& element = network_.elements[i];
  uint32_t found = kNone;
  for (uint32_t pin = 0; pin < element.inputs.size(); ++pin) {
    for (Link link : element.inputs[pin].from) {
      if (!is_power(network_.elements[link.element].kind)) {
        if (element.kind != Kind::kBlock || element.inputs[pin].from.size() != 1) return false;
        continue;
      }
      if (found != kNone && found != pin) return false;
      // Feedback is no rung.
      if (link.element >= i || !output_pin(link)) return false;
      found = pin;
    }
  }
  if (found == kNone) return false;
  result_.pins[i].input = found;
  ++placed_;
  return true;
}

bool Finder::output_pin(Link link) {
  uint32_t& output = result_.pins[link.element].output;
  if (output != kNoPin && output != link.output) return false;
  output = link.output;
  return true;
}

bool Finder::find_points() {
  points_.resize(1);
  behind_.resize(network_.elements.size());
  for (uint32_t i = 0; i < network_.elements.size(); ++i) {
    const Element& element = network_.elements[i];
    if (!is_placed(element.kind)) continue;
    uint32_t point = point_of(element.inputs[result_.pins[i].input].from);
    behind_[i] = static_cast<uint32_t>(points_.size());
    points_.push_back({{}, 1});
    points_[point].out.push_back({i, behind_[i]});
  }
  return true;
}

uint32_t Finder::point_of(const std::vector<Link>& links) {
  std::vector<uint32_t> from;
  for (Link link : links) from.push_back(behind_[link.element]);  // of the left rail: 0
  std::sort(from.begin(), from.end());
  from.erase(std::unique(from.begin(), from.end()), from.end());
  if (from.size() == 1) return from[0];
  auto [at, is_new] = joins_.try_emplace(from, static_cast<uint32_t>(points_.size()));
  if (is_new) {
    points_.push_back({{}, static_cast<uint32_t>(from.size())});
    for (uint32_t point : from) points_[point].out.push_back({kNone, at->second});
  }
  return at->second;
}

void Finder::append(Branch& branch, const Edge& edge) {
  if (edge.element == kNone) return;
  ++passed_;
  bool contact = network_.elements[edge.element].kind == Kind::kContact;
  branch.items.push_back({edge.element, {}, false, edge.element, contact ? kNone : edge.element});
}

void put_before(Series& items, Branch& branch) {
  branch.items.insert(branch.items.begin(), std::make_move_iterator(items.begin()),
                      std::make_move_iterator(items.end()));
}

std::optional<Branch> Finder::walk(const Edge& edge, uint32_t depth) {
  Branch branch;
  append(branch, edge);
  if (points_[edge.to].in > 1) {
    branch.stop = edge.to;
    return branch;
  }
  std::optional<Branch> rest = from(edge.to, depth);
  if (!rest) return std::nullopt;
  put_before(branch.items, *rest);
  return rest;
}

// Everything behind a point all of whose wires have been followed.
std::optional<Branch> Finder::from(uint32_t point, uint32_t depth) {
  Branch branch;
  for (;;) {
    const std::vector<Edge>& out = points_[point].out;
    if (out.empty()) return branch;
    if (out.size() == 1) {
      append(branch, out[0]);
      point = out[0].to;
      if (points_[point].in > 1) {
        branch.stop = point;
        return branch;
      }
      continue;
    }
    std::optional<Branch> parts = fork(point, depth + 1);
    if (!parts) return std::nullopt;
    for (Item& item : parts->items) branch.items.push_back(std::move(item));
    bool whole = parts->stop != kNone && parts->weight == points_[parts->stop].in;
    branch.stop = parts->stop;
    branch.weight = parts->weight;
    if (!whole) return branch;
    point = parts->stop;
    branch.stop = kNone;
    branch.weight = 1;
  }
}

// The smallest element of a series; the smallest that is no contact.
std::pair<uint32_t, uint32_t> first_of(const Series& series) {
  std::pair<uint32_t, uint32_t> out{kNone, kNone};
  for (const Item& item : series) {
    out.first = std::min(out.first, item.first);
    out.second = std::min(out.second, item.does);
  }
  return out;
}

// What is done in a branch is done in its order; contacts may be read whenever.
uint32_t rank(const Series& series) {
  auto [first, does] = first_of(series);
  return does != kNone ? does : first;
}

Item side_by_side(std::vector<Branch>& branches, bool end) {
  Item item;
  item.end = end;
  item.first = kNone;
  for (Branch& branch : branches) {
    auto [first, does] = first_of(branch.items);
    item.first = std::min(item.first, first);
    item.does = std::min(item.does, does);
    item.branches.push_back(std::move(branch.items));
  }
  std::stable_sort(item.branches.begin(), item.branches.end(),
                   [](const Series& a, const Series& b) { return rank(a) < rank(b); });
  return item;
}

// The branches behind a point. Where some of them meet and nothing else arrives, they are one
// branch that goes on from there.
std::optional<Branch> Finder::fork(uint32_t point, uint32_t depth) {
  if (depth > kMaxBranchNesting) return std::nullopt;
  struct Group {
    std::vector<Branch> branches;
    uint32_t weight = 0;
  };
  std::map<uint32_t, Group> by_stop;
  std::vector<Branch> pending;
  for (const Edge& edge : points_[point].out) {
    std::optional<Branch> branch = walk(edge, depth);
    if (!branch) return std::nullopt;
    pending.push_back(std::move(*branch));
  }
  uint32_t apart = static_cast<uint32_t>(pending.size());  // branches that have not met yet
  while (!pending.empty()) {
    Branch branch = std::move(pending.back());
    pending.pop_back();
    uint32_t stop = branch.stop;
    Group& group = by_stop[stop];
    group.weight += branch.weight;
    group.branches.push_back(std::move(branch));
    bool all_arrived = stop != kNone && group.weight == points_[stop].in;
    if (!all_arrived || group.branches.size() == apart) continue;
    apart -= static_cast<uint32_t>(group.branches.size()) - 1;
    Series met;
    met.push_back(side_by_side(group.branches, false));
    by_stop.erase(stop);
    std::optional<Branch> rest = from(stop, depth);
    if (!rest) return std::nullopt;
    put_before(met, *rest);
    pending.push_back(std::move(*rest));
  }
  if (by_stop.size() != 1) return std::nullopt;
  Group& group = by_stop.begin()->second;
  Branch all;
  all.stop = by_stop.begin()->first;
  all.weight = group.weight;
  if (group.branches.size() == 1) {
    all.items = std::move(group.branches[0].items);
  } else {
    all.items.push_back(side_by_side(group.branches, all.stop == kNone));
  }
  return all;
}

}  // namespace

std::optional<Branches> find_branches(const Network& network) { return Finder(network).run(); }

}  // namespace frontend::network
