// Random charts against a second implementation of docs/adr/0009-sfc.md, which is written as
// the rules are read: after every scan steps, times, actions, and the order in which
// statements ran are the same. The same seed is the same chart everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

constexpr int kScanMs = 10;
const char* const kQualifiers[] = {"N", "R", "S", "L", "D", "P", "P0", "P1", "SD", "DS", "SL"};

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
  uint32_t below(uint32_t limit) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<uint32_t>((state_ >> 24) % limit);
  }

 private:
  uint64_t state_;
};

struct Use {
  uint32_t action;
  std::string qualifier;
  int time_ms;
};

struct Condition {
  enum class Kind : uint8_t { kTrue, kInput, kStep, kTime } kind = Kind::kTrue;
  bool negated = false;
  uint32_t number = 0;  // of the input or step
  int time_ms = 0;
};

struct Transition {
  std::vector<uint32_t> from;
  std::vector<uint32_t> to;
  Condition condition;
  uint32_t priority;  // 3: none
};

struct Chart {
  std::vector<std::vector<Use>> steps;
  std::vector<Transition> transitions;
  std::vector<bool> has_body;     // by action
  std::vector<uint32_t> network;  // by step: its first step, which is the initial one
};

std::vector<uint32_t> some_steps(Random& random, uint32_t steps, uint32_t count) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(random.below(steps));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Chart make(Random& random) {
  Chart chart;
  chart.steps.resize(2 + random.below(6));
  chart.has_body.resize(1 + random.below(4));
  auto steps = static_cast<uint32_t>(chart.steps.size());
  auto actions = static_cast<uint32_t>(chart.has_body.size());
  for (std::vector<Use>& uses : chart.steps) {
    uses.resize(random.below(4));
    for (Use& use : uses) {
      use = {random.below(actions), kQualifiers[random.below(11)],
             kScanMs * static_cast<int>(random.below(4))};
    }
  }
  for (size_t i = 0; i < chart.has_body.size(); ++i) chart.has_body[i] = random.below(2) == 0;
  chart.transitions.resize(steps + random.below(2 * steps));
  for (uint32_t t = 0; t < chart.transitions.size(); ++t) {
    Transition& transition = chart.transitions[t];
    transition.from = {t};  // every step has a way on
    if (t >= steps) transition.from = some_steps(random, steps, 1 + random.below(2));
    transition.to = some_steps(random, steps, random.below(4) == 0 ? 3 : 1);
    Condition& condition = transition.condition;
    condition.kind = static_cast<Condition::Kind>(random.below(4));
    condition.negated = condition.kind != Condition::Kind::kTime && random.below(2) == 0;
    bool input = condition.kind == Condition::Kind::kInput;
    condition.number = input ? random.below(3) : transition.from[0];
    if (condition.kind == Condition::Kind::kStep) condition.number = random.below(steps);
    if (condition.kind == Condition::Kind::kTrue) condition.negated = false;
    condition.time_ms = kScanMs * static_cast<int>(random.below(4));
    transition.priority = 1 + random.below(3);
  }
  chart.network.resize(steps);
  std::iota(chart.network.begin(), chart.network.end(), 0u);
  for (uint32_t round = 0; round < steps; ++round) {
    for (const Transition& transition : chart.transitions) {
      std::vector<uint32_t> all = transition.from;
      all.insert(all.end(), transition.to.begin(), transition.to.end());
      uint32_t least = steps;
      for (uint32_t step : all) least = std::min(least, chart.network[step]);
      for (uint32_t step : all) chart.network[step] = least;
    }
  }
  return chart;
}

std::string list(const std::vector<uint32_t>& steps) {
  std::string out;
  for (uint32_t step : steps) out += (out.empty() ? "(S" : ", S") + std::to_string(step);
  return out + ")";
}

std::string text(const Condition& condition) {
  std::string number = std::to_string(condition.number);
  std::string out = condition.negated ? "NOT " : "";
  switch (condition.kind) {
    case Condition::Kind::kTrue:
      return "TRUE";
    case Condition::Kind::kInput:
      return out + "in" + number;
    case Condition::Kind::kStep:
      return out + "S" + number + ".X";
    case Condition::Kind::kTime:
      return "S" + number + ".T >= T#" + std::to_string(condition.time_ms) + "ms";
  }
  return out;
}

// A letter for each run of a body: A with Q, a without.
std::string source(const Chart& chart) {
  std::string out = "PROGRAM P\nVAR in0, in1, in2 : BOOL; log : STRING[250];";
  for (size_t a = 0; a < chart.has_body.size(); ++a) {
    if (!chart.has_body[a]) out += " A" + std::to_string(a) + " : BOOL;";
  }
  out += " END_VAR\n";
  for (uint32_t s = 0; s < chart.steps.size(); ++s) {
    out += (chart.network[s] == s ? "INITIAL_STEP S" : "STEP S") + std::to_string(s) + ":";
    for (const Use& use : chart.steps[s]) {
      bool timed = use.qualifier == "L" || use.qualifier == "D" || use.qualifier.size() == 2;
      timed = timed && use.qualifier[0] != 'P';
      out += " A" + std::to_string(use.action) + "(" + use.qualifier;
      if (timed) out += ", T#" + std::to_string(use.time_ms) + "ms";
      out += ");";
    }
    out += " END_STEP\n";
  }
  for (const Transition& transition : chart.transitions) {
    out += "TRANSITION ";
    if (transition.priority < 3) {
      out += "(PRIORITY := " + std::to_string(transition.priority) + ") ";
    }
    out += "FROM " + list(transition.from) + " TO " + list(transition.to) +
           " := " + text(transition.condition) + "; END_TRANSITION\n";
  }
  for (size_t a = 0; a < chart.has_body.size(); ++a) {
    if (!chart.has_body[a]) continue;
    std::string name = "A" + std::to_string(a);
    std::string letter(1, static_cast<char>('a' + a));
    std::string large(1, static_cast<char>('A' + a));
    out += "ACTION " + name + ": log := CONCAT(log, SEL(" + name + ".Q, '" + letter + "', '" +
           large + "')); END_ACTION\n";
  }
  return out + "END_PROGRAM\n";
}

class Model {
 public:
  explicit Model(const Chart& chart)
      : chart_(chart),
        active(chart.steps.size()),
        time_ms(chart.steps.size()),
        actions(chart.has_body.size()) {}

  void scan(const std::vector<bool>& inputs) {
    pass_time();
    std::vector<bool> begins(chart_.steps.size());
    for (uint32_t s = 0; s < begins.size(); ++s) begins[s] = chart_.network[s] == s;
    for (uint32_t s = 0; s < active.size(); ++s) {
      if (active[s]) begins[chart_.network[s]] = false;
    }
    move(inputs);
    for (uint32_t s = 0; s < begins.size(); ++s) {
      if (begins[s]) enter(s);
    }
    for (Action& action : actions)
      action.wanted = action.pulsed = action.released = action.reset = false;
    for (uint32_t s = 0; s < active.size(); ++s) {
      for (const Use& use : chart_.steps[s]) ask(s, use);
    }
    for (Action& action : actions) control(action);
    for (bool late : {false, true}) {
      for (uint32_t a = 0; a < actions.size(); ++a) {
        const Action& action = actions[a];
        if (!chart_.has_body[a] || action.late != late || (!late && !action.early)) continue;
        log += static_cast<char>((action.q ? 'A' : 'a') + static_cast<char>(a));
      }
    }
  }

 private:
  struct Action {
    bool s = false, ds = false, sd = false, sl = false;
    int sd_ms = 0, sd_limit = 0, sl_ms = 0, sl_limit = 0;
    bool wanted = false, pulsed = false, released = false, reset = false;
    bool q = false, late = false, early = false;
  };
  const Chart& chart_;

 public:
  std::vector<bool> active;
  std::vector<int> time_ms;
  std::vector<Action> actions;
  std::string log;

 private:
  void pass_time() {
    for (uint32_t s = 0; s < active.size(); ++s) {
      if (active[s]) time_ms[s] += kScanMs;
    }
    for (Action& action : actions) {
      if (action.sd) action.sd_ms += kScanMs;
      if (action.sl) action.sl_ms += kScanMs;
    }
  }

  bool holds(const Condition& condition, const std::vector<bool>& inputs) const {
    switch (condition.kind) {
      case Condition::Kind::kTrue:
        return true;
      case Condition::Kind::kInput:
        return inputs[condition.number] != condition.negated;
      case Condition::Kind::kStep:
        return active[condition.number] != condition.negated;
      case Condition::Kind::kTime:
        return time_ms[condition.number] >= condition.time_ms;
    }
    return false;
  }

  void move(const std::vector<bool>& inputs) {
    entered_.assign(active.size(), false);
    left_.assign(active.size(), false);
    std::vector<const Transition*> fired;
    for (uint32_t priority = 1; priority <= 3; ++priority) {
      for (const Transition& transition : chart_.transitions) {
        bool fires = transition.priority == priority && holds(transition.condition, inputs);
        for (uint32_t s : transition.from) fires = fires && active[s] && !left_[s];
        if (!fires) continue;
        fired.push_back(&transition);
        for (uint32_t s : transition.from) left_[s] = true;
      }
    }
    for (uint32_t s = 0; s < active.size(); ++s) active[s] = active[s] && !left_[s];
    for (const Transition* transition : fired) {
      for (uint32_t s : transition->to) enter(s);
    }
  }

  void enter(uint32_t step) {
    active[step] = true;
    time_ms[step] = 0;
    entered_[step] = true;
  }

  void ask(uint32_t step, const Use& use) {
    Action& action = actions[use.action];
    const std::string& q = use.qualifier;
    if (q == "P0") action.released = action.released || left_[step];
    if (!active[step]) return;
    bool over = time_ms[step] >= use.time_ms;
    action.wanted = action.wanted || q == "N" || (q == "L" && !over) || (q == "D" && over) ||
                    (q == "P" && entered_[step]);
    action.pulsed = action.pulsed || (q == "P1" && entered_[step]);
    action.reset = action.reset || q == "R";
    action.s = action.s || q == "S";
    action.ds = action.ds || (q == "DS" && over);
    if (q == "SD") {
      action.sd_limit = use.time_ms;
      if (!action.sd) action.sd_ms = 0;
      action.sd = true;
    }
    if (q == "SL") {
      action.sl_limit = use.time_ms;
      if (!action.sl) action.sl_ms = 0;
      action.sl = true;
    }
  }

  static void control(Action& action) {
    bool before = action.q;
    if (action.reset) {
      action.s = action.ds = action.sd = action.sl = false;
      action.wanted = action.pulsed = action.released = false;
    }
    action.q = action.wanted || action.s || action.ds ||
               (action.sd && action.sd_ms >= action.sd_limit) ||
               (action.sl && action.sl_ms < action.sl_limit);
    action.late = action.q || action.pulsed;
    action.early = (before && !action.q) || action.released;
  }

  std::vector<bool> entered_;
  std::vector<bool> left_;
};

// `changes` counts scans in which steps changed, so that the test knows that something happened.
void compare(uint64_t seed, uint32_t& changes) {
  Random random(seed);
  Chart chart = make(random);
  std::string program = source(chart);
  SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + program);
  Controlled run(program);
  Model model(chart);
  std::vector<bool> before;
  for (int scan = 1; scan <= 30; ++scan) {
    std::vector<bool> inputs;
    for (uint32_t i = 0; i < 3; ++i) {
      inputs.push_back(random.below(2) == 0);
      run.set("P.in" + std::to_string(i), inputs[i] ? 1 : 0);
    }
    model.scan(inputs);
    ASSERT_EQ(run.scan(), "");
    for (uint32_t s = 0; s < chart.steps.size(); ++s) {
      std::string step = "P.S" + std::to_string(s);
      ASSERT_EQ(run.number(step + ".X"), model.active[s] ? 1 : 0) << step << " scan " << scan;
      ASSERT_EQ(run.number(step + ".T"), model.time_ms[s] * 1'000'000) << step << " scan " << scan;
    }
    for (uint32_t a = 0; a < chart.has_body.size(); ++a) {
      std::string action = "P.A" + std::to_string(a);
      const auto& expected = model.actions[a];
      bool value = chart.has_body[a] ? expected.q : expected.late || expected.released;
      action += chart.has_body[a] ? ".Q" : "";
      ASSERT_EQ(run.number(action), value ? 1 : 0) << action << " scan " << scan;
    }
    ASSERT_EQ(run.text("P.log"), model.log) << "scan " << scan;
    if (model.active != before) ++changes;
    before = model.active;
  }
}

TEST(ChartModel, RandomChartsAgree) {
  uint32_t changes = 0;
  for (uint64_t seed = 1; seed <= 300 && !HasFatalFailure(); ++seed) compare(seed, changes);
  EXPECT_GT(changes, 2000u);
}

}  // namespace
}  // namespace frontend_test
