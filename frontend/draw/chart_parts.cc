#include "frontend/draw/chart_parts.h"

#include <algorithm>
#include <set>

namespace frontend::draw {

namespace {

using sfc::kNone;

constexpr uint32_t kMaxDepth = 64;

// Where a sequence goes on, once all ways there have been seen.
struct Pending {
  enum class Kind : uint8_t { kNothing, kStep, kTransition };
  Kind kind = Kind::kNothing;
  uint32_t number = 0;
  friend bool operator==(Pending, Pending) = default;
};

struct Branch {
  Sequence parts;
  Pending next;
  uint32_t weight = 0;  // ways to `next` that it stands for
};

class Builder {
 public:
  explicit Builder(const sfc::Net& net) : net_(net) {
    placed_.resize(net.steps.size());
    drawn_.resize(net.transitions.size());
    ways_.resize(net.steps.size());
    find_loops();
  }

  std::vector<Sequence> run() {
    std::vector<Sequence> out;
    auto begin_at = [&](uint32_t step) {
      if (placed_[step]) return;
      Branch branch;
      step_on(branch, step, 0);
      follow(branch, 0);
      close(branch);
      out.push_back(std::move(branch.parts));
    };
    for (uint32_t step : net_.initial) {
      if (step != kNone) begin_at(step);
    }
    // Joins before the steps behind them.
    for (bool more = true; more;) {
      more = false;
      for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
        if (drawn_[t] || net_.transitions[t].from.size() < 2) continue;
        if (!all_placed(net_.transitions[t].from)) continue;
        Branch branch;
        branch.parts.push_back({PartKind::kWaits, t, {}, {}});
        transition_on(branch, t, 0);
        follow(branch, 0);
        close(branch);
        out.push_back(std::move(branch.parts));
        more = true;
      }
      for (uint32_t step = 0; step < net_.steps.size() && !more; ++step) {
        more = !placed_[step];
        begin_at(step);
      }
    }
    return out;
  }

 private:
  bool all_placed(const std::vector<uint32_t>& steps) const {
    return std::all_of(steps.begin(), steps.end(), [&](uint32_t step) { return placed_[step]; });
  }
  void find_loops();
  uint32_t needed(Pending next) const {
    if (next.kind == Pending::Kind::kStep) return ways_[next.number];
    return static_cast<uint32_t>(net_.transitions[next.number].from.size());
  }
  void step_on(Branch& branch, uint32_t step, uint32_t depth);
  void transition_on(Branch& branch, uint32_t transition, uint32_t depth);
  void target(Branch& branch, uint32_t transition, uint32_t step);
  void follow(Branch& branch, uint32_t depth);
  void gather(Branch& branch, PartKind kind, std::vector<Branch> branches);
  void close(Branch& branch);

  const sfc::Net& net_;
  std::vector<bool> placed_;                       // steps
  std::vector<bool> drawn_;                        // transitions
  std::vector<uint32_t> ways_;                     // to a step, those of loops left out
  std::set<std::pair<uint32_t, uint32_t>> loops_;  // transition and step that it leads back to
};

// A way back leads to a step that is above it on the way from where a search began.
void Builder::find_loops() {
  enum class State : uint8_t { kNew, kOpen, kDone };
  struct Place {
    uint32_t step;
    size_t edge;
  };
  std::vector<std::vector<std::pair<uint32_t, uint32_t>>> edges(net_.steps.size());
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
    for (uint32_t from : net_.transitions[t].from) {
      for (uint32_t to : net_.transitions[t].to) edges[from].emplace_back(t, to);
    }
  }
  std::vector<State> state(net_.steps.size(), State::kNew);
  std::vector<Place> stack;
  auto search = [&](uint32_t root) {
    if (root == kNone || state[root] != State::kNew) return;
    stack.push_back({root, 0});
    state[root] = State::kOpen;
    while (!stack.empty()) {
      Place& top = stack.back();
      if (top.edge == edges[top.step].size()) {
        state[top.step] = State::kDone;
        stack.pop_back();
        continue;
      }
      auto [transition, to] = edges[top.step][top.edge++];
      if (state[to] == State::kOpen) loops_.insert({transition, to});
      if (state[to] != State::kNew) continue;
      state[to] = State::kOpen;
      stack.push_back({to, 0});
    }
  };
  for (uint32_t root : net_.initial) search(root);
  for (uint32_t step = 0; step < net_.steps.size(); ++step) search(step);
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
    for (uint32_t to : net_.transitions[t].to) ways_[to] += loops_.count({t, to}) == 0 ? 1 : 0;
  }
}

void Builder::step_on(Branch& branch, uint32_t step, uint32_t depth) {
  placed_[step] = true;
  branch.parts.push_back({PartKind::kStep, step, {}, {}});
  const std::vector<uint32_t>& out = net_.steps[step].out;
  auto leave = [&](Branch& way, uint32_t transition) {
    if (net_.transitions[transition].from.size() > 1) {
      way.next = {Pending::Kind::kTransition, transition};
      way.weight = 1;
    } else {
      transition_on(way, transition, depth);
    }
  };
  if (out.size() == 1) {
    leave(branch, out[0]);
  } else if (out.size() > 1) {
    std::vector<Branch> ways(out.size());
    for (size_t i = 0; i < out.size(); ++i) {
      leave(ways[i], out[i]);
      follow(ways[i], depth + 1);
    }
    gather(branch, PartKind::kAlternatives, std::move(ways));
  }
}

void Builder::transition_on(Branch& branch, uint32_t transition, uint32_t depth) {
  drawn_[transition] = true;
  branch.parts.push_back({PartKind::kTransition, transition, {}, {}});
  const std::vector<uint32_t>& to = net_.transitions[transition].to;
  if (to.size() == 1) return target(branch, transition, to[0]);
  std::vector<Branch> ways(to.size());
  for (size_t i = 0; i < to.size(); ++i) {
    target(ways[i], transition, to[i]);
    follow(ways[i], depth + 1);
  }
  gather(branch, PartKind::kSimultaneous, std::move(ways));
}

void Builder::target(Branch& branch, uint32_t transition, uint32_t step) {
  if (placed_[step] || loops_.count({transition, step}) != 0) {
    branch.parts.push_back({PartKind::kJump, step, {}, {}});
    branch.next = {};
    return;
  }
  branch.next = {Pending::Kind::kStep, step};
  branch.weight = 1;
}

// As long as nobody else can arrive where the branch goes on.
void Builder::follow(Branch& branch, uint32_t depth) {
  while (branch.next.kind != Pending::Kind::kNothing && branch.weight == needed(branch.next)) {
    if (depth > kMaxDepth) return close(branch);
    Pending next = branch.next;
    branch.next = {};
    if (next.kind == Pending::Kind::kTransition) {
      transition_on(branch, next.number, depth);
      continue;
    }
    step_on(branch, next.number, depth);
  }
}

// Branches that go on at the same place meet; of several such places the first one is chosen, and
// the way to others becomes an arrow.
void Builder::gather(Branch& branch, PartKind kind, std::vector<Branch> branches) {
  Part part;
  part.kind = kind;
  branch.next = {};
  branch.weight = 0;
  for (const Branch& one : branches) {
    bool join = one.next.kind == Pending::Kind::kTransition;
    bool wanted = kind == PartKind::kSimultaneous ? join : one.next.kind == Pending::Kind::kStep;
    if (wanted && branch.next.kind == Pending::Kind::kNothing) branch.next = one.next;
  }
  for (const Branch& one : branches) {
    if (branch.next.kind == Pending::Kind::kNothing) branch.next = one.next;
  }
  // Simultaneous branches meet at a transition alone.
  bool simultaneous = kind == PartKind::kSimultaneous;
  if (simultaneous && branch.next.kind == Pending::Kind::kStep) branch.next = {};
  for (Branch& one : branches) {
    bool meets = one.next.kind != Pending::Kind::kNothing && one.next == branch.next;
    if (meets) {
      branch.weight += one.weight;
    } else {
      close(one);
    }
    part.meets.push_back(meets);
    part.branches.push_back(std::move(one.parts));
  }
  branch.parts.push_back(std::move(part));
}

void Builder::close(Branch& branch) {
  bool step = branch.next.kind == Pending::Kind::kStep;
  if (branch.next.kind == Pending::Kind::kNothing) return;
  branch.parts.push_back({step ? PartKind::kJump : PartKind::kJoin, branch.next.number, {}, {}});
  if (step && ways_[branch.next.number] > 0) --ways_[branch.next.number];
  branch.next = {};
}

}  // namespace

std::vector<Sequence> chart_parts(const sfc::Net& net) { return Builder(net).run(); }

}  // namespace frontend::draw
