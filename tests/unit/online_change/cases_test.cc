// Change cases (docs/REQUIREMENTS.md) that take tasks, devices, time, or more than one controller.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/unit/online_change/plant.h"
#include "tests/unit/sanitized.h"

namespace online_change {
namespace {

using plant::Plant;

constexpr int64_t kUs = 1000;

// Scans of the slow task take 25 ms; each writes its version first and compares it last.
std::string two_tasks(int version) {
  const std::string number = std::to_string(version);
  return "FUNCTION Version : INT Version := " + number +
         "; END_FUNCTION\n"
         "PROGRAM Fast VAR n, seen : INT; END_VAR n := n + 1; seen := Version(); END_PROGRAM\n"
         "PROGRAM Slow VAR begun, i, scans, mixed, newest : INT; END_VAR\n"
         "  begun := " +
         number +
         ";\n"
         "  FOR i := 1 TO 250 DO newest := Version(); END_FOR\n"
         "  IF begun <> " +
         number +
         " OR newest <> begun THEN mixed := mixed + 1; END_IF\n"
         "  scans := scans + 1;\n"
         "END_PROGRAM\n"
         "CONFIGURATION c RESOURCE r ON cpu\n"
         "  TASK T1 (INTERVAL := T#10ms, PRIORITY := 1);\n"
         "  TASK T2 (INTERVAL := T#50ms, PRIORITY := 2);\n"
         "  PROGRAM F WITH T1 : Fast;  PROGRAM S WITH T2 : Slow;\n"
         "END_RESOURCE END_CONFIGURATION\n";
}

TEST(Cases, C6_case43_every_scan_of_every_task_runs_one_version) {
  Plant plant(two_tasks(1), {}, 50 * kUs);
  int version = 1;
  int refused = 0;
  int switched = 0;
  for (int cycle = 0; cycle < 300; ++cycle) {
    plant.run(1);
    if (plant.driver().state() == State::kIdle) {
      ASSERT_TRUE(plant.driver().stage(plant.package(two_tasks(version + 1))).ok());
      ASSERT_TRUE(plant.driver().arm(false, true).ok());
    }
    const bool boundary = plant.controller().at_boundary();
    auto report = plant.driver().switch_now();
    EXPECT_EQ(report.ok(), boundary);
    if (!report.ok()) {
      EXPECT_EQ(report.error().refusal, base::Refusal::kBusy);
      EXPECT_EQ(plant.driver().state(), State::kArmed) << "it waits for a boundary";
      ++refused;
      continue;
    }
    ++version;
    ++switched;
    plant.accept();
  }
  EXPECT_GT(refused, 50) << "the slow task was inside a scan often";
  EXPECT_GT(switched, 50);
  plant.run(10);
  EXPECT_EQ(plant.get("S.mixed"), "0");
  EXPECT_NE(plant.get("S.scans"), "0");
  EXPECT_EQ(plant.get("F.seen"), std::to_string(version));
  for (const vm::TaskStatus& task : plant.controller().tasks()) EXPECT_EQ(task.missed, 0u);
}

// With `again` the event's own task ends it, and the other two bring it anew in every cycle, when
// that task has run already: at each boundary it waits for the next cycle. Version 2 has an
// instance whose FB_Init runs during the switch.
std::string with_event(const char* extra) {
  return std::string(
             "FUNCTION_BLOCK Pump VAR n : INT; END_VAR METHOD FB_Init : BOOL VAR_INPUT "
             "bInitRetains, bInCopyCode : BOOL; END_VAR n := 7; END_METHOD END_FUNCTION_BLOCK\n"
             "VAR_GLOBAL start, again : BOOL; END_VAR\n"
             "PROGRAM Ticks VAR n : INT; ") +
         extra +
         " END_VAR n := n + 1; IF again THEN start := TRUE; END_IF END_PROGRAM\n"
         "PROGRAM OnEdge VAR n : INT; END_VAR n := n + 1; IF again THEN start := FALSE; END_IF "
         "END_PROGRAM\n"
         "CONFIGURATION c\n"
         "  TASK one (INTERVAL := T#10ms, PRIORITY := 5);\n"
         "  TASK two (INTERVAL := T#10ms, PRIORITY := 6);\n"
         "  TASK edge (SINGLE := start, PRIORITY := 1);\n"
         "  PROGRAM t WITH one : Ticks;  PROGRAM u WITH two : Ticks;\n"
         "  PROGRAM e WITH edge : OnEdge;\n"
         "END_CONFIGURATION\n";
}

TEST(Cases, A11_case44_an_event_during_the_switch_runs_once_afterwards) {
  Plant plant(with_event(""));
  plant.run(3);
  ASSERT_TRUE(plant.driver().stage(plant.package(with_event("more : Pump;"))).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  plant.set("start", "TRUE");
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("t.more.n"), "7") << "its FB_Init has run";
  EXPECT_EQ(plant.get("e.n"), "0") << "no event task begins during the switch";
  plant.run(5);
  EXPECT_EQ(plant.get("e.n"), "1");
  EXPECT_EQ(plant.controller().tasks()[2].delay.max, 0) << "it is noticed with the next cycle";
  // And one that ran before does not run again because of the switch.
  plant.accept();
  plant.change(with_event(""), true);
  plant.run(5);
  EXPECT_EQ(plant.get("e.n"), "1");
}

TEST(Cases, A11_a_task_that_waits_does_not_begin_during_the_switch) {
  Plant plant(with_event(""));
  plant.set("again", "TRUE");
  plant.run(3);
  const int before = std::stoi(plant.get("e.n"));
  EXPECT_GE(before, 2);
  ASSERT_TRUE(plant.driver().stage(plant.package(with_event("more : Pump;"))).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("t.more.n"), "7");
  EXPECT_EQ(plant.get("e.n"), std::to_string(before)) << "it has waited since the last cycle";
  plant.run(1);
  EXPECT_EQ(plant.get("e.n"), std::to_string(before + 1)) << "and begins with the next one";
}

TEST(Cases, case46_an_output_moves_and_goes_without_a_glitch) {
  Plant plant(
      "PROGRAM Main VAR q AT %QX0.0 : BOOL := TRUE; w AT %QB1 : BYTE := 7; END_VAR "
      "END_PROGRAM");
  plant.run(3);
  const size_t before = plant.devices().sent.size();
  plant.change(
      "PROGRAM Main VAR q AT %QX0.1 : BOOL := TRUE; w AT %QB1 : BYTE := 7; END_VAR "
      "END_PROGRAM");
  plant.run(3);
  bool moved = false;
  for (size_t i = before; i < plant.devices().sent.size(); ++i) {
    const base::Bytes& sent = plant.devices().sent[i];
    ASSERT_GE(sent.size(), 2u);
    EXPECT_EQ(sent[1], 7) << "of an output that stays";
    moved = moved || sent[0] == 2;
    EXPECT_EQ(sent[0], moved ? 2 : 1) << "one of the two in every image, and never back";
  }
  EXPECT_TRUE(moved);
  plant.accept();
  plant.change("PROGRAM Main VAR q AT %QX0.1 : BOOL := TRUE; END_VAR END_PROGRAM", true);
  plant.run(1);
  const base::Bytes& last = plant.devices().sent.back();
  EXPECT_EQ(last[0], 2);
  const uint8_t gone = last.size() > 1 ? last[1] : 0;
  EXPECT_EQ(gone, 0) << "a removed output goes to its safe value";
}

uint64_t free_bytes(const ir::Image& image) {
  uint64_t sum = 0;
  for (const ir::Extent& extent : image.free) sum += extent.size;
  return sum;
}

TEST(Cases, A8_case49_growing_and_shrinking_ten_thousand_times) {
  const std::string block =
      "FUNCTION_BLOCK B VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK\n";
  const std::string small =
      block + "VAR_GLOBAL g : INT; END_VAR PROGRAM Main VAR b : B; END_VAR b(); END_PROGRAM";
  const std::string large = block +
                            "VAR_GLOBAL g : INT; h : ARRAY[1..300] OF INT; END_VAR PROGRAM Main "
                            "VAR b : B; c : ARRAY[1..5] OF B; x : ARRAY[1..200] OF LINT; END_VAR "
                            "b(); c[1](); END_PROGRAM";
  Plant plant(small);
  struct Figures {
    int64_t pause = 0;
    size_t steps = 0;
    uint64_t free = 0;
    size_t package = 0;
  };
  Figures early[2];
  int scans = 0;
  for (int i = 0; i < static_cast<int>(10'000 / kOneOf); ++i) {
    const bool grows = i % 2 == 0;
    const base::Bytes package = plant.package(grows ? large : small);
    ASSERT_TRUE(plant.driver().stage(package).ok()) << i;
    const Plan& plan = plant.driver().plan();
    const Figures now{plan.predicted_pause_ns, plan.steps.size(),
                      free_bytes(plant.controller().image()), package.size()};
    ASSERT_TRUE(plant.driver().arm(true).ok()) << i;
    ASSERT_TRUE(plant.driver().switch_now().ok()) << i;
    plant.accept();
    if (i % 100 == 0) plant.run(1), ++scans;
    if (i < 100) early[grows] = now;
    ASSERT_EQ(now.pause, early[grows].pause) << i;
    ASSERT_EQ(now.steps, early[grows].steps) << i;
    ASSERT_EQ(now.free, early[grows].free) << i;
    // A generation number or two may take a digit more.
    ASSERT_NEAR(static_cast<double>(now.package), static_cast<double>(early[grows].package), 64.0)
        << i;
  }
  EXPECT_EQ(plant.get("Main.b.n"), std::to_string(scans));
}

TEST(Cases, case61_the_one_that_would_lose_refuses_and_the_others_go_on) {
  const std::string wide =
      "PROGRAM Main VAR v : INT := 100; n : INT; END_VAR n := n + 1; "
      "END_PROGRAM";
  const std::string narrow = "PROGRAM Main VAR v : SINT; n : INT; END_VAR n := n + 1; END_PROGRAM";
  Plant one(wide);
  Plant two(wide);
  Plant three(wide);
  two.set("Main.v", "300");
  const base::Bytes package = one.package(narrow);
  int switched = 0;
  for (Plant* plant : {&one, &two, &three}) {
    plant->run(2);
    ASSERT_TRUE(plant->driver().stage(package).ok()) << "one package for all of them";
    base::Status armed = plant->driver().arm(false);
    if (armed.ok()) {
      switched += plant->driver().switch_now().ok();
    } else {
      EXPECT_EQ(plant, &two);
      EXPECT_EQ(armed.error().refusal, base::Refusal::kWouldLose);
      plant->driver().cancel();
    }
    plant->run(2);
    EXPECT_EQ(plant->get("Main.n"), "4");
  }
  EXPECT_EQ(switched, 2);
  EXPECT_EQ(two.get("Main.v"), "300");
  EXPECT_EQ(one.controller().verified().digest(), three.controller().verified().digest());
}

std::string trace_of(Plant& plant, int scans) {
  std::string trace;
  for (int i = 0; i < scans; ++i) {
    plant.run(1);
    trace += plant.get("A.n") + " " + plant.get("A.t.ET") + " " + plant.get("A.sum") + "\n";
  }
  return trace;
}

TEST(Cases, law_non_interference) {
  auto source = [](const char* other) {
    return std::string(
               "PROGRAM PA VAR n, sum : DINT; t : TON; END_VAR n := n + 1; "
               "t(IN := TRUE, PT := T#1s); IF n MOD 7 = 3 THEN sum := sum + n; END_IF "
               "END_PROGRAM\nPROGRAM PB VAR ") +
           other +
           " END_VAR x := x + 1; END_PROGRAM\n"
           "CONFIGURATION c RESOURCE r ON cpu\n"
           "  TASK T1 (INTERVAL := T#10ms, PRIORITY := 1);\n"
           "  TASK T2 (INTERVAL := T#30ms, PRIORITY := 2);\n"
           "  PROGRAM A WITH T1 : PA;  PROGRAM B WITH T2 : PB;\n"
           "END_RESOURCE END_CONFIGURATION\n";
  };
  const std::string first = source("x : INT; y : ARRAY[1..10] OF INT;");
  const std::string second = source("y : ARRAY[0..400] OF LREAL; x : LINT;");
  Plant alone(first);
  const std::string expected = trace_of(alone, 40);
  for (int at = 0; at < 20; ++at) {
    Plant plant(first);
    std::string trace = trace_of(plant, at);
    plant.change(second);
    trace += trace_of(plant, 10);
    plant.undo();
    trace += trace_of(plant, 30 - at);
    EXPECT_EQ(trace, expected) << "changed behind scan " << at;
  }
}

// With leave for what the report showed, a value that would be lost besides stops the switch.
TEST(Cases, X1_case2_leave_is_for_what_the_report_showed) {
  const std::string wide = "PROGRAM Main VAR a : INT := 300; b : INT := 5; END_VAR END_PROGRAM";
  const std::string narrow = "PROGRAM Main VAR a, b : SINT; END_VAR END_PROGRAM";
  for (Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Plant plant(wide);
    plant.run(1);
    ASSERT_TRUE(plant.driver().stage(plant.package(narrow), strategy).ok());
    ASSERT_EQ(plant.driver().live_losses().size(), 1u);
    ASSERT_TRUE(plant.driver().arm(true).ok());
    plant.set("Main.a", "400");
    plant.set("Main.b", "1000");
    const base::Digest before = plant.hash();
    auto report = plant.driver().switch_now();
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.error().refusal, base::Refusal::kWouldLose);
    EXPECT_NE(report.error().text.find("Main.b"), std::string::npos) << report.error().text;
    EXPECT_EQ(plant.hash(), before);
    EXPECT_EQ(plant.driver().state(), State::kIdle);
    // The new report shows both, and the value of `a` may have changed meanwhile.
    ASSERT_TRUE(plant.driver().stage(plant.package(narrow), strategy).ok());
    ASSERT_EQ(plant.driver().live_losses().size(), 2u);
    ASSERT_TRUE(plant.driver().arm(true).ok());
    plant.set("Main.a", "500");
    EXPECT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get("Main.b"), "127");
  }
}

TEST(Cases, X1_what_is_dropped_is_a_loss) {
  Plant plant("PROGRAM Main VAR a : INT := 300; b : INT; END_VAR END_PROGRAM");
  plant.run(1);
  const std::string without = "PROGRAM Main VAR b : INT; END_VAR END_PROGRAM";
  ASSERT_TRUE(plant.stage(plant.package(without)).ok());
  EXPECT_EQ(plant.driver().count_losses(plant.controller().memory().view()), 1u);
  const base::Status armed = plant.driver().arm(false);
  ASSERT_FALSE(armed.ok());
  EXPECT_EQ(armed.error().refusal, base::Refusal::kWouldLose);
  EXPECT_NE(armed.error().text.find("`Main.a` is 300"), std::string::npos) << armed.error().text;
  EXPECT_TRUE(plant.driver().arm(true).ok());
}

// A force ends where its variable goes: whoever permits no loss is told so.
TEST(Cases, X1_case47_a_force_that_ends_is_a_loss) {
  const std::string head = "PROGRAM Main VAR a : INT; ";
  Plant plant(head + "END_VAR a := 1; END_PROGRAM");
  plant.run(1);
  ASSERT_TRUE(plant.controller().force("Main.a", "300").ok());
  plant.run(1);
  const std::string narrow = "PROGRAM Main VAR a : SINT; END_VAR a := 1; END_PROGRAM";
  // The value itself would fit. It is written past the force, which `set` does not get over.
  const vm::Force& force = plant.controller().forces().front();
  const int16_t fits = 5;
  std::memcpy(plant.controller().memory().data() + force.symbol.data, &fits, sizeof fits);
  ASSERT_TRUE(plant.stage(plant.package(narrow)).ok());
  const std::vector<LiveLoss> losses = plant.driver().live_losses();
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(losses[0].path, "Main.a");
  EXPECT_EQ(losses[0].what, "loses its force");
  EXPECT_EQ(plant.driver().arm(false).error().refusal, base::Refusal::kWouldLose);
}

// The value that is forced fits the other type exactly, so the force goes on.
TEST(Cases, X1_case47_a_whole_real_stays_forced_as_an_integer) {
  for (const char* type : {"INT", "LINT", "REAL", "LREAL", "USINT"}) {
    Plant plant("PROGRAM Main VAR a : LREAL; END_VAR a := 1.0; END_PROGRAM");
    ASSERT_TRUE(plant.controller().force("Main.a", "95").ok());
    plant.run(1);
    const std::string next =
        std::string("PROGRAM Main VAR a : ") + type + "; END_VAR a := 1; END_PROGRAM";
    plant.change(next, true);
    plant.run(1);
    EXPECT_EQ(plant.controller().forces().size(), 1u) << type;
    EXPECT_EQ(std::stoi(plant.get("Main.a")), 95) << type;
    plant.undo();
    plant.run(1);
    EXPECT_EQ(plant.get("Main.a"), "95.0") << type;
  }
  Plant plant("PROGRAM Main VAR a : LREAL; END_VAR a := 1.0; END_PROGRAM");
  ASSERT_TRUE(plant.controller().force("Main.a", "2.5").ok());
  plant.run(1);
  plant.change("PROGRAM Main VAR a : INT; END_VAR a := 1; END_PROGRAM", true);
  EXPECT_TRUE(plant.controller().forces().empty());
}

}  // namespace
}  // namespace online_change
