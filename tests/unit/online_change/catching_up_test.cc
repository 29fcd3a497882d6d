// C7: what the program writes while a second area is made is brought up to date in passes, until
// what is left fits the free time of the tightest task. Bytes and passes are counted, in virtual
// time.
#include <sstream>

#include "ir/bytecode/symbols.h"
#include "online_change/apply/standby.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;
using plant::Settings;

constexpr uint64_t kMegabyte = 1u << 20;
constexpr int64_t kMs = 1'000'000;

Settings roomy() {
  Settings settings;
  settings.slack.free_bytes = 8u << 20;
  settings.ns_per_safe_point = vm::kIdleUnitNs;
  return settings;
}

std::string tasks(const char* interval) {
  return std::string(" CONFIGURATION c RESOURCE r ON cpu TASK T (INTERVAL := T#") + interval +
         "); PROGRAM Main WITH T : Main; END_RESOURCE END_CONFIGURATION";
}

// 2 MB that each scan writes anew, every page of it with another value than ever before. The loop
// takes 2 ms where a safe point takes 4 us.
std::string rewrites(const char* interval, const char* x) {
  return std::string("PROGRAM Main VAR data : ARRAY[0..524287] OF DINT; even : BOOL; ones : ") +
         "ARRAY[0..524287] OF DINT := [524288(1)]; twos : ARRAY[0..524287] OF DINT := " +
         "[524288(2)]; x : " + x + "; i : DINT; END_VAR even := NOT even; " +
         "IF even THEN data := twos; ELSE data := ones; END_IF " +
         "FOR i := 0 TO 524287 BY 1024 DO data[i] := x; END_FOR x := x + 1; END_PROGRAM" +
         tasks(interval);
}

// Until it says that it is done; how many cycles that took.
int catch_up(Plant& plant) {
  int cycles = 0;
  for (;; ++cycles) {
    base::Result<bool> done = plant.driver().catch_up();
    EXPECT_TRUE(done.ok());
    if (!done.ok() || *done || cycles == 1000) return cycles;
    plant.run(1);
  }
}

void configure(Plant& plant) {
  for (int i = 0; i < 1000 && !*plant.driver().configure(); ++i) plant.run(1);
}

std::string first_difference(Plant& a, Plant& b) {
  const auto state = [](Plant& plant) {
    return std::istringstream(
        ir::state_text(plant.controller().image(), plant.controller().memory().view()));
  };
  std::istringstream first = state(a);
  std::istringstream second = state(b);
  for (std::string x, y; !first.eof() || !second.eof();) {
    std::getline(first, x);
    std::getline(second, y);
    if (x != y) return x + " and " + y;
  }
  return "";
}

void expect_none_missed(Plant& plant) {
  for (const vm::TaskStatus& task : plant.controller().tasks()) {
    EXPECT_EQ(task.missed, 0u);
    EXPECT_EQ(task.delay.max, 0) << "no release begins late";
  }
}

// All of it is copied at the boundary, whose cost is known and fits; nothing helps beyond that, and
// nothing else is tried.
TEST(CatchingUp, C7_case80_two_megabytes_rewritten_in_every_scan_of_a_5_ms_task) {
  Settings settings = roomy();
  settings.slack.free_bytes = 1u << 20;
  settings.ns_per_safe_point = 4000;
  Plant plant(rewrites("5ms", "INT"), settings);
  Plant in_place(rewrites("5ms", "INT"), settings);
  plant.use(Strategy::kStandby);
  in_place.use(Strategy::kInPlace);
  plant.run(3);
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(rewrites("5ms", "DINT"))).ok());
  const int64_t at_worst_ns = change.predicted_pause_ns();
  configure(plant);
  const int cycles = catch_up(plant);
  EXPECT_LE(cycles, 12) << "a pass takes a few cycles";
  const int64_t predicted_ns = change.predicted_pause_ns();
  // All of it is compared, a third is copied.
  EXPECT_LT(predicted_ns, at_worst_ns);
  EXPECT_GT(predicted_ns, static_cast<int64_t>(2 * kMegabyte) / kPauseCopiedBytesPerNs);
  ASSERT_TRUE(change.arm(false).ok());
  plant.run(2);
  const int64_t before_ns = plant.clock().now_ns();
  auto report = change.switch_now();
  ASSERT_TRUE(report.ok());
  const int64_t took_ns = plant.clock().now_ns() - before_ns;
  // Each scan writes the same pages, but for one or two.
  EXPECT_NEAR(static_cast<double>(took_ns), static_cast<double>(predicted_ns), 5000);
  EXPECT_LE(plant.clock().now_ns(), plant.controller().next_cycle_ns());
  plant.run(5);
  EXPECT_EQ(plant.controller().missed_releases(), 0u);
  while (in_place.controller().cycles() < report->cycle_before) in_place.run(1);
  in_place.change(rewrites("5ms", "DINT"));
  in_place.run(5);
  EXPECT_EQ(first_difference(plant, in_place), "");
}

// A new value in each scan, a page further; the other 8 MB stay. While they are copied, many pages
// are written; in a pass, which is shorter, fewer are.
std::string walks(const char* x) {
  return std::string("PROGRAM Main VAR data : ARRAY[0..2097151] OF DINT; x : ") + x +
         "; i : DINT; END_VAR i := (i + 1024) MOD 2097152; data[i] := x; x := x + 1; END_PROGRAM" +
         tasks("700us");
}

TEST(CatchingUp, C7_passes_leave_less_and_less) {
  Settings settings = roomy();
  Plant plant(walks("INT"), settings);
  plant.use(Strategy::kStandby);
  plant.run(3);
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(walks("DINT"))).ok());
  EXPECT_EQ(change.admit(false).error().refusal, Refusal::kPauseTooLong) << "8 MB in 0.7 ms";
  const uint64_t begin = plant.controller().cycles();
  configure(plant);
  const uint64_t copied = plant.controller().cycles() - begin;
  EXPECT_GT(copied, 5u) << "the test needs more than one cycle's idle time";
  ASSERT_FALSE(*change.catch_up());
  const int cycles = catch_up(plant);
  EXPECT_LT(static_cast<uint64_t>(cycles), copied);
  ASSERT_TRUE(change.admit(false).ok());
  ASSERT_TRUE(change.arm(false).ok());
  plant.run(1);
  ASSERT_TRUE(change.switch_now().ok());
  plant.run(5);
  expect_none_missed(plant);
  const int x = static_cast<int>(plant.controller().cycles());
  EXPECT_EQ(plant.get("Main.x"), std::to_string(x));
  for (int i = 1; i <= x; ++i) {
    EXPECT_EQ(plant.get("Main.data[" + std::to_string(i * 1024) + "]"), std::to_string(i - 1));
  }
}

TEST(CatchingUp, C7_case80_what_never_fits_is_refused_with_the_figures) {
  Settings settings = roomy();
  settings.ns_per_safe_point = 40;
  Plant plant(rewrites("200us", "INT"), settings);
  plant.use(Strategy::kStandby);
  plant.run(3);
  const base::Digest before = plant.controller().verified().digest();
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(rewrites("200us", "DINT"))).ok());
  configure(plant);
  catch_up(plant);
  const base::Status armed = change.arm(false);
  ASSERT_FALSE(armed.ok());
  EXPECT_EQ(armed.error().refusal, Refusal::kPauseTooLong);
  const std::string& text = armed.error().text;
  EXPECT_NE(text.find("task `T` leaves"), std::string::npos) << text;
  const size_t figure = text.find("by standby ");
  ASSERT_NE(figure, std::string::npos) << text;
  EXPECT_GE(std::stoull(text.substr(figure + 11)), 2 * kMegabyte) << text;
  EXPECT_NE(text.find("bytes of data are found to have been written"), std::string::npos) << text;
  EXPECT_NE(text.find("in place (--strategy in-place)"), std::string::npos) << text;
  change.cancel();
  EXPECT_EQ(plant.controller().verified().digest(), before);
  plant.use(Strategy::kInPlace);
  plant.change(rewrites("1ms", "DINT"));
}

// More was written than the passes had found: the switch ends at its deadline, however far it has
// come, and at a later boundary it is made of the values of that one.
TEST(CatchingUp, C7_a_switch_that_its_deadline_ended_is_tried_again) {
  const auto source = [](const char* type) {
    // `b` keeps its place, the area of Main moves.
    return std::string("FUNCTION_BLOCK Kept VAR b : ARRAY[0..8191] OF INT; i : DINT; END_VAR ") +
           "FOR i := 0 TO 8191 BY 900 DO b[i] := 6 - b[i]; END_FOR END_FUNCTION_BLOCK " +
           "PROGRAM Main VAR a : ARRAY[0..8191] OF " + type + "; kept : Kept; i : DINT; END_VAR " +
           "FOR i := 0 TO 8191 BY 900 DO a[i] := a[i] + 1; END_FOR kept(); END_PROGRAM";
  };
  int points = 0;
  for (bool ended = false; !ended; ++points) {
    Plant plant(source("INT"), roomy().slack);
    Plant in_place(source("INT"), roomy().slack);
    plant.use(Strategy::kStandby);
    in_place.use(Strategy::kInPlace);
    plant.run(3);
    ASSERT_TRUE(plant.stage(plant.package(source("DINT"))).ok());
    configure(plant);
    ASSERT_TRUE(plant.driver().arm(false).ok());
    plant.run(1);
    int asked = 0;
    plant.driver().set_interruption([&] { return asked++ == points; });
    auto report = plant.driver().switch_now(true);
    ended = report.ok() || plant.driver().state() != State::kArmed;
    if (!ended) {
      EXPECT_EQ(report.error().refusal, Refusal::kDeadline);
      plant.driver().set_interruption(nullptr);
      plant.run(1);  // b is again what it was when the second area was made
      if (points % 2 == 0) catch_up(plant);
      plant.set("Main.a[900]", "77");
      ASSERT_TRUE(plant.driver().switch_now(true).ok());
      in_place.run(static_cast<int>(plant.controller().cycles()));
      in_place.set("Main.a[900]", "77");
      in_place.change(source("DINT"));
      EXPECT_EQ(first_difference(plant, in_place), "") << points;
    }
  }
  EXPECT_GT(points, 6) << "a point for each look at the deadline";
}

// Losses too are those of the boundary, whatever a pass has seen.
TEST(CatchingUp, C7_case2_losses_after_a_pass_are_those_of_the_boundary) {
  const char* const kInt = "PROGRAM Main VAR x : INT := 100; y : INT; END_VAR END_PROGRAM";
  const char* const kSint = "PROGRAM Main VAR x : SINT; y : INT; END_VAR END_PROGRAM";
  for (const char* in_pass : {"100", "300"}) {
    for (const char* at_boundary : {"100", "300"}) {
      Plant plant(kInt);
      plant.use(Strategy::kStandby);
      plant.run(1);
      Change& change = plant.driver();
      ASSERT_TRUE(plant.stage(plant.package(kSint)).ok());
      configure(plant);
      plant.set("Main.x", in_pass);
      plant.run(1);
      catch_up(plant);
      plant.set("Main.x", "100");
      ASSERT_TRUE(change.arm(false).ok());
      plant.set("Main.x", at_boundary);
      auto report = change.switch_now();
      EXPECT_EQ(report.ok(), std::string(at_boundary) == "100");
      EXPECT_TRUE(report.ok() || report.error().refusal == Refusal::kWouldLose);
      EXPECT_EQ(plant.get("Main.x"), at_boundary);
    }
  }
}

// --- the second area alone -----------------------------------------------------------

TEST(CatchingUp, C7_a_pass_counts_what_it_copies_and_does_again) {
  const auto source = [](const char* type) {
    return std::string("PROGRAM Main VAR a : ARRAY[0..16383] OF ") + type +
           "; b : ARRAY[0..99999] OF DINT; END_VAR END_PROGRAM";
  };
  Plant plant(source("INT"), roomy().slack);
  plant.use(Strategy::kStandby);
  plant.run(1);
  ASSERT_TRUE(plant.stage(plant.package(source("DINT"))).ok());
  const int64_t at_worst_ns = plant.driver().predicted_pause_ns();
  configure(plant);
  plant.run(1);
  catch_up(plant);
  const int64_t clean_ns = plant.driver().predicted_pause_ns();
  EXPECT_LT(clean_ns, at_worst_ns);
  // One page of integers, in pieces of 1024: the other two or three pages are left.
  plant.set("Main.a[5000]", "1");
  plant.run(1);
  catch_up(plant);
  const int64_t one_ns = plant.driver().predicted_pause_ns();
  EXPECT_GT(one_ns, clean_ns);
  EXPECT_LT(one_ns - clean_ns, (at_worst_ns - clean_ns) / 3);
  // What was brought up to date is not found again.
  plant.run(1);
  catch_up(plant);
  EXPECT_EQ(plant.driver().predicted_pause_ns(), clean_ns);
}

TEST(CatchingUp, C7_a_pass_begins_in_another_cycle) {
  Plant plant(rewrites("5ms", "INT"), roomy().slack);
  plant.use(Strategy::kStandby);
  plant.run(3);
  ASSERT_TRUE(plant.stage(plant.package(rewrites("5ms", "DINT"))).ok());
  ASSERT_TRUE(*plant.driver().configure());
  for (int i = 0; i < 5; ++i) {
    ASSERT_FALSE(*plant.driver().catch_up());
    EXPECT_EQ(plant.driver().units_left(), 0u);
  }
  plant.run(1);
  EXPECT_TRUE(*plant.driver().catch_up());
}

}  // namespace
}  // namespace online_change
