// what comes too often is counted, not told; in virtual time.
#include "tools/stvm/event_limits.h"

#include <gtest/gtest.h>

namespace stvm {
namespace {

using online_change::Event;

constexpr int64_t kTenSeconds = EventLimits::kPeriodNs;

// How many of `count` pass, one each `step_ns`.
uint64_t passed(EventLimits& limits, Event event, uint64_t count, int64_t& now_ns, int64_t step_ns,
                const std::string& source = "device press") {
  uint64_t out = 0;
  for (uint64_t i = 0; i < count; ++i, now_ns += step_ns) out += limits.pass(event, source, now_ns);
  return out;
}

TEST(EventLimits, R10_SomeAtOnceAndThenACountInEachPeriod) {
  EventLimits limits;
  int64_t now = 7 * kTenSeconds;
  EXPECT_EQ(passed(limits, Event::kDeviceLost, 417, now, 1'000'000), EventLimits::kOfPlant);
  EXPECT_TRUE(limits.take_left_out(now).empty()) << "the period is not over";
  now = 8 * kTenSeconds;
  auto rows = limits.take_left_out(now);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].event, Event::kDeviceLost);
  EXPECT_EQ(rows[0].source, "device press");
  EXPECT_EQ(rows[0].count, 412u);
  EXPECT_EQ(rows[0].span_ns, kTenSeconds);
  // As long as it floods, one and a count.
  EXPECT_EQ(passed(limits, Event::kDeviceLost, 10'000, now, 1'000'000), EventLimits::kWhileFlooded);
  rows = limits.take_left_out(now);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].count, 9'999u);
  // Behind a quiet period it is as at first.
  now += kTenSeconds;
  EXPECT_TRUE(limits.take_left_out(now).empty());
  EXPECT_EQ(passed(limits, Event::kDeviceLost, 6, now, 0), EventLimits::kOfPlant);
}

TEST(EventLimits, R10_KindsAndSourcesCountByThemselves) {
  EventLimits limits;
  int64_t now = 0;
  passed(limits, Event::kOverrun, 100, now, 0, "task Fast");
  EXPECT_EQ(passed(limits, Event::kOverrun, 9, now, 0, "task Slow"), EventLimits::kOfPlant);
  EXPECT_EQ(passed(limits, Event::kTrap, 9, now, 0, "task Fast"), EventLimits::kOfPlant);
  EXPECT_EQ(passed(limits, Event::kForced, 90, now, 0, ""), EventLimits::kOfPeople);
  EXPECT_EQ(passed(limits, Event::kSwitched, 900, now, 0, ""), 900u) << "never left out";
  EXPECT_EQ(limits.take_left_out(now, true).size(), 4u);
}

// What found no room in the ring of the control thread.
TEST(EventLimits, R10_WhatWasLostElsewhereCountsToo) {
  EventLimits limits;
  limits.count(Event::kTrap, 0, 0);
  EXPECT_TRUE(limits.take_left_out(0, true).empty());
  limits.count(Event::kTrap, 999'744, 0);
  const auto rows = limits.take_left_out(kTenSeconds);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].count, 999'744u);
}

TEST(EventLimits, R10_SourcesAreBounded) {
  EventLimits limits;
  uint64_t told = 0;
  constexpr uint64_t kMany = 10 * EventLimits::kMostSources;
  for (uint64_t i = 0; i < kMany; ++i) {
    told += limits.pass(Event::kPeerWrote, "device " + std::to_string(i), 0);
  }
  EXPECT_EQ(told, EventLimits::kMostSources + EventLimits::kOfPlant);
  const auto rows = limits.take_left_out(0, true);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].source, "");
  EXPECT_EQ(rows[0].count, kMany - told);
}

}  // namespace
}  // namespace stvm
