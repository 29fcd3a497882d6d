// Statistics of tasks: classes an eighth wide, and what a controller reports of them.
#include "vm/runtime/histogram.h"

#include "tests/unit/runtime/plant.h"
#include "vm/runtime/recent_longest.h"

namespace runtime_test {
namespace {

TEST(Histogram, QuantilesAreRightToAnEighth) {
  vm::Histogram times;
  for (int64_t ns = 1; ns <= 100'000; ++ns) times.add(ns);
  EXPECT_EQ(times.count(), 100'000u);
  EXPECT_EQ(times.min(), 1);
  EXPECT_EQ(times.max(), 100'000);
  EXPECT_EQ(times.average(), 50'000);
  EXPECT_EQ(times.total(), 5'000'050'000);
  for (double share : {0.01, 0.1, 0.5, 0.9, 0.99}) {
    const double exact = share * 100'000;
    EXPECT_GE(times.quantile(share) * 1.001, exact);
    EXPECT_LE(times.quantile(share), exact * 1.126);
  }
  EXPECT_EQ(times.quantile(1.0), 100'000);
}

TEST(Histogram, ClassesMeetWithoutGaps) {
  for (uint32_t number = 1; number < vm::Histogram::kClasses - 24; ++number) {
    const int64_t begin = vm::Histogram::class_end(number - 1);
    ASSERT_LT(begin, vm::Histogram::class_end(number)) << number;
    vm::Histogram times;
    times.add(begin);
    ASSERT_EQ(times.in_class(number), 1u) << number;
    times.add(vm::Histogram::class_end(number) - 1);
    ASSERT_EQ(times.in_class(number), 2u) << number;
  }
}

TEST(Histogram, TakesAnything) {
  vm::Histogram times;
  EXPECT_EQ(times.quantile(0.99), 0);
  for (int64_t ns : {INT64_MIN, int64_t{-1}, int64_t{0}, INT64_MAX}) times.add(ns);
  EXPECT_EQ(times.min(), 0);
  EXPECT_EQ(times.max(), INT64_MAX);
  EXPECT_EQ(times.count(), 4u);
  EXPECT_EQ(times.in_class(0), 3u);
}

// A task above takes 4 ms of every 10 ms and this one 2 ms: it starts 4 ms late, and its own run
// time does not contain what it waited.
TEST(Statistics, RunTimesAndDelaysOfATask) {
  vm::ControllerOptions options;
  options.fuel_slice = 10;
  Plant plant(R"(
PROGRAM A VAR i : DINT; END_VAR FOR i := 1 TO 4000 DO ; END_FOR END_PROGRAM
PROGRAM B VAR i : DINT; END_VAR FOR i := 1 TO 2000 DO ; END_FOR END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 0); TASK Low (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM H WITH High : A; PROGRAM L WITH Low : B;
END_RESOURCE END_CONFIGURATION
)",
              options, 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(100);
  const vm::TaskStatus low = plant.task("Low");
  EXPECT_EQ(low.scans, 100u);
  EXPECT_NEAR(static_cast<double>(low.run.average), 2e6, 2e4);
  EXPECT_NEAR(static_cast<double>(low.run.min), 2e6, 2e4);
  EXPECT_NEAR(static_cast<double>(low.run.max), 2e6, 2e4);
  EXPECT_NEAR(static_cast<double>(low.delay.average), 4e6, 2e4);
  EXPECT_EQ(plant.task("High").delay.max, 0);
  const std::optional<vm::TaskTimes> times = plant->task_times("low");
  ASSERT_TRUE(times);
  uint64_t count = 0;
  for (const vm::TimeClass& row : times->run) count += row.count;
  EXPECT_EQ(count, 100u);
  EXPECT_FALSE(plant->task_times("nobody"));
}

// A control thread that did not run for 85 ms: the scan behind it was due 75 ms before, and seven
// releases have no scan.
TEST(Statistics, AStartDelayCanExceedAPeriod) {
  Plant plant("PROGRAM A VAR n : DINT; END_VAR n := n + 1; END_PROGRAM CONFIGURATION c RESOURCE r "
              "ON cpu TASK t (INTERVAL := T#10ms, PRIORITY := 1); PROGRAM a WITH t : A; "
              "END_RESOURCE END_CONFIGURATION");
  ASSERT_TRUE(plant.ok());
  plant.cycles(5);
  EXPECT_EQ(plant.task("t").delay.max, 0);
  plant.clock.advance(85 * kMs);
  plant.cycles(1);
  EXPECT_EQ(plant.task("t").delay.max, 75 * kMs);
  EXPECT_EQ(plant.task("t").missed, 7u);
  plant.cycles(1);
  EXPECT_EQ(plant.task("t").scans, 7u);
}

// What was measured goes on after a change, and after its undo.
TEST(Statistics, GoOnThroughAChange) {
  Plant plant("PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM");
  ASSERT_TRUE(plant.ok());
  const std::string task = plant->tasks()[0].name;
  plant.cycles(5);
  const auto count = [&] {
    uint64_t scans = 0;
    const std::optional<vm::TaskTimes> times = plant->task_times(task);
    for (const vm::TimeClass& row : times->run) scans += row.count;
    return scans;
  };
  auto next = plant->prepare(plant->verified());
  ASSERT_TRUE(next.ok());
  auto old = plant->publish(std::move(*next));
  plant.cycles(5);
  EXPECT_EQ(count(), 10u);
  plant->publish(std::move(old));
  plant.cycles(5);
  EXPECT_EQ(count(), 15u);
}

TEST(RecentLongest, LooksBackOnOneWindowToTwo) {
  vm::RecentLongest times;
  EXPECT_EQ(times.longest(), 0);
  times.add(9);
  for (uint32_t i = 1; i < 2 * vm::RecentLongest::kWindow - 1; ++i) {
    times.add(1);
    EXPECT_EQ(times.longest(), 9) << i;
  }
  times.add(2);
  EXPECT_EQ(times.longest(), 2);
  for (uint32_t i = 0; i < vm::RecentLongest::kWindow; ++i) times.add(1);
  EXPECT_EQ(times.longest(), 1);
}

}  // namespace
}  // namespace runtime_test
