// What the boundary costs, counted (A16, change cases 24, 35, 52): work in place follows what
// changes, not the program around it. Measured figures: docs/pause.md.
#include "online_change/plan/pause.h"
#include "bench/plain_method.h"
#include "ir/bytecode/symbols.h"
#include "online_change/apply/pace.h"
#include "tests/unit/online_change/instructions.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

#if !defined(__OPTIMIZE__) || defined(STC_SANITIZED_HEAP)
constexpr bool kOptimised = false;
#else
constexpr bool kOptimised = true;
#endif

// 50 variables in each of `instances` blocks, `globals` more, and one that changes.
std::string program(uint32_t instances, uint32_t globals, const char* changed,
                    const char* cell = "") {
  std::string cells;
  std::string more;
  for (int i = 0; i < 50; ++i) cells += "c" + std::to_string(i) + " : INT; ";
  for (uint32_t i = 0; i < globals; ++i) more += "g" + std::to_string(i) + " : INT; ";
  return "FUNCTION_BLOCK Cell VAR " + cells + cell + " END_VAR END_FUNCTION_BLOCK VAR_GLOBAL " +
         more + "cells : ARRAY[1.." + std::to_string(instances) + "] OF Cell; END_VAR " +
         "PROGRAM Main VAR x : " + changed + "; END_VAR x := x + 1; END_PROGRAM";
}

linker::Slack roomy() {
  linker::Slack slack;
  slack.free_bytes = 32u << 20;
  return slack;
}

// Of the machine that the model's times are of.
constexpr double kInstructionsPerNs = 30;

struct Cost {
  size_t steps = 0;
  uint64_t bytes = 0;
  int64_t predicted_ns = 0;
};

// Armed, so that a switch comes next.
void begin(Plant& plant, const std::string& second) {
  plant.use(Strategy::kInPlace);
  plant.run(2);
  EXPECT_TRUE(plant.stage(plant.package(second)).ok());
  EXPECT_TRUE(plant.driver().arm(true, true).ok());
}

Cost cost_of(const std::string& first, const std::string& second) {
  Plant plant(first, roomy());
  begin(plant, second);
  const Plan& plan = plant.driver().plan();
  Cost cost{plan.steps.size(), plan.boundary_bytes, plant.driver().predicted_pause_ns()};
  EXPECT_TRUE(plant.driver().switch_now().ok());
  return cost;
}

// Of the switch alone. Where no process may be traced the tests that ask for it are skipped, and
// nothing else is: they are tests of their own, with `instructions` in their names.
std::optional<uint64_t> instructions_of(const std::string& first, const std::string& second) {
  Plant plant(first, roomy());
  begin(plant, second);
  return plant::count_instructions([&] { (void)plant.driver().switch_now().ok(); });
}

TEST(Pause, A16_case52_one_change_costs_the_same_among_1000000_variables) {
  const Cost small = cost_of(program(20, 100, "INT"), program(20, 100, "DINT"));
  const Cost large = cost_of(program(20'000, 5000, "INT"), program(20'000, 5000, "DINT"));
  EXPECT_EQ(small.steps, 1u);
  EXPECT_EQ(large.steps, 1u);
  EXPECT_EQ(small.bytes, large.bytes);
  EXPECT_EQ(small.predicted_ns, large.predicted_ns);
}

TEST(Pause, A16_case52_one_change_takes_as_many_instructions) {
  const auto small = instructions_of(program(20, 100, "INT"), program(20, 100, "DINT"));
  const auto large = instructions_of(program(20'000, 5000, "INT"), program(20'000, 5000, "DINT"));
  if (!small || !large) GTEST_SKIP() << "no process may be traced here";
  EXPECT_LT(*large, 2 * *small);
  EXPECT_TRUE(!kOptimised || *large < 20'000u) << *large;
  RecordProperty("instructions", std::to_string(*large));
}

// All of it in the slack, and written before the boundary (A19).
TEST(Pause, A19_case35_ten_thousand_instances_gain_a_variable) {
  const Cost cost =
      cost_of(program(10'000, 0, "INT"), program(10'000, 0, "INT", "more : INT := 7;"));
  EXPECT_EQ(cost.steps, 10'000u);
  EXPECT_EQ(cost.bytes, 0u);
}

TEST(Pause, A19_case35_ten_thousand_instances_take_no_instructions) {
  if (!kOptimised) GTEST_SKIP() << "the number is for optimised code";
  const auto all =
      instructions_of(program(10'000, 0, "INT"), program(10'000, 0, "INT", "more : INT := 7;"));
  if (!all) GTEST_SKIP() << "no process may be traced here";
  EXPECT_LT(*all, 10'000u);
}

// The baseline of docs/pause.md: the same values, at the price of the whole program.
struct Plain {
  explicit Plain(uint32_t instances)
      : second(program(instances, 0, "DINT", "more : INT := 7;")),
        plant(program(instances, 0, "INT"), roomy()) {
    plant.run(3);
    plant.set("cells[1].c7", "-5");
    next.emplace(*ir::verify(decode(plant.package(second))->image));
    method.emplace(plant.controller(), *next);
  }
  std::string second;
  Plant plant;
  std::optional<ir::VerifiedImage> next;
  std::optional<bench::PlainMethod> method;
};

TEST(Pause, A18_the_plain_method_saves_and_restores_everything) {
  Plain plain(4);
  Plant in_place(program(4, 0, "INT"), roomy());
  in_place.run(3);
  in_place.set("cells[1].c7", "-5");
  plain.method->make_switch();
  in_place.change(plain.second);
  plain.plant.run(2);
  in_place.run(2);
  vm::Controller& controller = plain.plant.controller();
  EXPECT_EQ(ir::state_text(controller.image(), controller.memory().view()),
            ir::state_text(in_place.controller().image(), in_place.controller().memory().view()));
  EXPECT_EQ(plain.plant.get("Main.x"), "5");
}

TEST(Pause, A18_the_plain_method_takes_more_instructions_for_a_larger_program) {
  if (!kOptimised) GTEST_SKIP() << "sanitizers copy in another way";
  Plain small(1);
  Plain large(4);
  const auto few = plant::count_instructions([&] { small.method->make_switch(); });
  const auto many = plant::count_instructions([&] { large.method->make_switch(); });
  if (!few || !many) GTEST_SKIP() << "no process may be traced here";
  EXPECT_GT(*many, 2 * *few);
}

std::string converted_at_1_ms(int values, const char* type) {
  return "CONFIGURATION C TASK Fast (INTERVAL := T#1ms); PROGRAM Main WITH Fast : Main; "
         "END_CONFIGURATION PROGRAM Main VAR a : ARRAY[1.." +
         std::to_string(values) + "] OF " + type + "; END_VAR END_PROGRAM";
}

// On virtual time a switch and an undo take what the model says of the work that they did: so a
// release that they delay is seen, and what is admitted delays none.
TEST(Pause, C5_case45_VirtualTimePassesForTheSwitchAndForUndo) {
  for (const Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    for (const int values : {1000, 4'000'000}) {
      const bool fits = values == 1000;
      Plant plant(converted_at_1_ms(values, "INT"), roomy());
      plant.use(strategy);
      plant.run(1);
      ASSERT_TRUE(plant.stage(plant.package(converted_at_1_ms(values, "REAL"))).ok());
      ASSERT_TRUE(plant.driver().configure().ok());
      EXPECT_EQ(plant.driver().arm(true).ok(), fits);
      if (!fits) {
        ASSERT_TRUE(plant.driver().arm(true, true).ok());
      }
      for (int i = 1; i <= values; ++i) {
        plant.controller()
            .memory()
            .data()[ir::find_symbol(plant.controller().image(), "Main.a[1]")->data + 2 * (i - 1)] ^=
            1;  // all has drifted
      }
      int64_t predicted_ns = plant.driver().predicted_pause_ns();
      int64_t before_ns = plant.clock().now_ns();
      ASSERT_TRUE(plant.driver().switch_now().ok());
      int64_t took_ns = plant.clock().now_ns() - before_ns;
      EXPECT_GT(took_ns, predicted_ns / 2);
      EXPECT_LE(took_ns, predicted_ns);
      EXPECT_EQ(plant.clock().now_ns() <= plant.controller().next_cycle_ns(), fits);
      plant.run(2);
      EXPECT_EQ(plant.controller().missed_releases() == 0, fits);
      predicted_ns = plant.driver().predicted_pause_ns();
      before_ns = plant.clock().now_ns();
      plant.undo();
      took_ns = plant.clock().now_ns() - before_ns;
      EXPECT_EQ(took_ns, predicted_ns);
      plant.run(2);
      EXPECT_EQ(plant.controller().missed_releases() == 0, fits);
    }
  }
}

// What a switch takes is told by the work that is counted. The model's times of different kinds of
// work stand to each other as the instructions do, within a factor of two; how long one takes says
// the pace of a machine (docs/pause.md has what was measured).
TEST(Pause, case69_the_model_follows_the_instructions) {
  if (!kOptimised) GTEST_SKIP() << "the numbers are for optimised code";
  const auto cells = [](const char* type, const char* name) {
    return std::string("TYPE Mode : ") + name + "; END_TYPE FUNCTION_BLOCK Cell VAR x : " + type +
           "; y : INT; END_VAR END_FUNCTION_BLOCK PROGRAM Main VAR c : ARRAY[1..100] OF Cell; "
           "END_VAR END_PROGRAM";
  };
  const auto array = [](const char* type, int count, const char* mode = "(a, b, c)") {
    return std::string("TYPE Mode : ") + mode + "; END_TYPE PROGRAM Main VAR a : ARRAY[1.." +
           std::to_string(count) + "] OF " + type + "; END_VAR END_PROGRAM";
  };
  const std::pair<std::string, std::string> edits[] = {
      {cells("INT", "(a, b)"), cells("DINT", "(a, b)")},
      {array("INT", 1000), array("REAL", 1000)},
      {array("Mode", 100), array("Mode", 100, "(c, b, a)")},
      {array("STRING[20]", 100), array("STRING[30]", 100)},
  };
  for (const auto& [first, second] : edits) {
    Plant plant(first, roomy());
    begin(plant, second);
    const auto model_ns = static_cast<double>(plant.driver().predicted_pause_ns() - kPauseFixedNs);
    const auto count = plant::count_instructions([&] { (void)plant.driver().switch_now().ok(); });
    if (!count) GTEST_SKIP() << "no process may be traced here";
    const double each = static_cast<double>(*count) / model_ns;
    EXPECT_GT(each, kInstructionsPerNs / 2) << second;
    EXPECT_LT(each, kInstructionsPerNs * 2) << second;
  }
}

TEST(Pause, case69_a_slow_machine_is_expected_to_take_longer) {
  Plant plant(converted_at_1_ms(400'000, "INT"), roomy());
  plant.run(1);
  ASSERT_TRUE(plant.stage(plant.package(converted_at_1_ms(400'000, "REAL"))).ok());
  Change& change = plant.driver();
  const int64_t expected_ns = change.predicted_pause_ns();
  EXPECT_TRUE(change.admit(false).ok());
  change.set_pace(4);
  EXPECT_EQ(change.predicted_pause_ns(), 4 * expected_ns);
  EXPECT_EQ(change.admit(false).error().refusal, base::Refusal::kPauseTooLong);
}

// With a reserve: what is expected may be wrong by half.
TEST(Pause, case69_a_switch_that_just_fits_is_not_begun) {
  vm::TaskStatus task;
  task.period_ns = 1'000'000;
  task.recent_ns = 100'000;
  EXPECT_TRUE(fits_free_time(600'000, {task}).ok());
  EXPECT_FALSE(fits_free_time(600'001, {task}).ok());
}

class SlowClock : public vm::VirtualClock {
 public:
  explicit SlowClock(int64_t step_ns) : step_ns_(step_ns) {}
  int64_t now_ns() override {
    advance(step_ns_);
    return vm::VirtualClock::now_ns();
  }

 private:
  int64_t step_ns_;
};

TEST(Pause, case69_the_pace_of_a_machine_is_measured) {
  vm::VirtualClock still;
  EXPECT_EQ(measured_pace(still), 1);
  SlowClock fast(100);
  SlowClock slow(200);
  const double pace = measured_pace(fast);
  EXPECT_GT(pace, 0);
  EXPECT_DOUBLE_EQ(measured_pace(slow), 2 * pace);
  SlowClock set_back(int64_t{1} << 40);
  EXPECT_LE(measured_pace(set_back), 64);
}

}  // namespace
}  // namespace online_change
