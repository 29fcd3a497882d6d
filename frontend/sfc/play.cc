#include "frontend/sfc/play.h"

#include <algorithm>
#include <deque>
#include <set>

namespace frontend::sfc {
namespace {

// In steps of all situations that were looked at; some milliseconds.
constexpr uint64_t kMaxWork = 300'000;

using Situation = std::vector<uint32_t>;  // active steps, sorted

class Player {
 public:
  explicit Player(const Net& net) : net_(net) {
    play_.entered.resize(net.steps.size());
    play_.fired.resize(net.transitions.size());
    play_.unsafe.resize(net.initial.size(), kNone);
  }

  Play run() {
    for (uint32_t initial : net_.initial) {
      if (initial != kNone) network(initial);
    }
    if (!play_.complete) spread();
    return std::move(play_);
  }

 private:
  void network(uint32_t initial) {
    std::set<Situation> known;
    std::deque<const Situation*> open;  // nearest first, so that the first mistake is found first
    auto meet = [&](Situation situation) {
      work_ += situation.size();
      auto [at, added] = known.insert(std::move(situation));
      if (added) open.push_back(&*at);
    };
    play_.entered[initial] = true;
    meet({initial});
    while (!open.empty()) {
      if (work_ > kMaxWork) {
        play_.complete = false;
        return;
      }
      const Situation& now = *open.front();
      open.pop_front();
      for (uint32_t step : now) {
        for (uint32_t t : net_.steps[step].out) {
          ++work_;
          // Each transition once: at its first step.
          if (net_.transitions[t].from[0] == step && enabled(t, now)) meet(fire(t, now));
        }
      }
    }
  }

  bool enabled(uint32_t t, const Situation& now) const {
    const std::vector<uint32_t>& from = net_.transitions[t].from;
    return std::all_of(from.begin(), from.end(), [&](uint32_t step) {
      return std::binary_search(now.begin(), now.end(), step);
    });
  }

  Situation fire(uint32_t t, const Situation& now) {
    const Transition& transition = net_.transitions[t];
    play_.fired[t] = true;
    Situation next;
    std::set_difference(now.begin(), now.end(), transition.from.begin(), transition.from.end(),
                        std::back_inserter(next));
    for (uint32_t step : transition.to) {
      play_.entered[step] = true;
      auto at = std::lower_bound(next.begin(), next.end(), step);
      if (at != next.end() && *at == step) {
        uint32_t& first = play_.unsafe[net_.steps[step].network];
        if (first == kNone) first = t;
      } else {
        next.insert(at, step);
      }
    }
    return next;
  }

  // Every transition whose steps can be entered may fire.
  void spread() {
    std::vector<uint32_t> missing(net_.transitions.size());
    for (uint32_t t = 0; t < missing.size(); ++t) {
      missing[t] = static_cast<uint32_t>(net_.transitions[t].from.size());
    }
    std::fill(play_.entered.begin(), play_.entered.end(), false);
    std::vector<uint32_t> open;
    auto enter = [&](uint32_t step) {
      if (play_.entered[step]) return;
      play_.entered[step] = true;
      open.push_back(step);
    };
    for (uint32_t initial : net_.initial) {
      if (initial != kNone) enter(initial);
    }
    while (!open.empty()) {
      uint32_t step = open.back();
      open.pop_back();
      for (uint32_t t : net_.steps[step].out) {
        if (--missing[t] != 0) continue;
        for (uint32_t next : net_.transitions[t].to) enter(next);
      }
    }
  }

  const Net& net_;
  Play play_;
  uint64_t work_ = 0;
};

}  // namespace

Play play(const Net& net) { return Player(net).run(); }

}  // namespace frontend::sfc
