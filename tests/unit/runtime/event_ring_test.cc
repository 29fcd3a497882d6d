// R-10: what the control thread tells of its scans, through a ring that never makes it wait.
#include "vm/runtime/event_ring.h"

#include <thread>

#include "tests/unit/allocations.h"
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

using vm::EventRing;
using vm::ScanEvent;
using vm::ScanEventKind;

void put(EventRing& ring, int64_t number, ScanEventKind kind = ScanEventKind::kOverrun) {
  ScanEvent* const event = ring.begin(kind);
  if (event == nullptr) return;
  event->cycle = static_cast<uint64_t>(number);
  event->source.add("task ").add(number % 10);
  event->text.add(number);
  ring.end();
}

TEST(EventRing, R10_GivesInOrderAndCountsWhatHasNoRoom) {
  EventRing ring;
  for (int i = 0; i < 300; ++i) put(ring, i);
  put(ring, 300, ScanEventKind::kTrap);
  ScanEvent event;
  for (uint64_t i = 0; i < EventRing::kRecords; ++i) {
    ASSERT_TRUE(ring.take(event));
    EXPECT_EQ(event.cycle, i);
    EXPECT_EQ(event.text.view(), std::to_string(i));
  }
  EXPECT_FALSE(ring.take(event));
  EXPECT_EQ(ring.take_lost(ScanEventKind::kOverrun), 300 - EventRing::kRecords);
  EXPECT_EQ(ring.take_lost(ScanEventKind::kOverrun), 0u) << "counted once";
  EXPECT_EQ(ring.take_lost(ScanEventKind::kTrap), 1u);
  put(ring, 301);
  ASSERT_TRUE(ring.take(event));
  EXPECT_EQ(event.source.view(), "task 1") << "nothing of the record before";
}

TEST(EventRing, R10_CutsTextsBetweenCharacters) {
  vm::FixedText text;
  const std::string nearly(vm::FixedText::kBytes - 1, 'a');
  text.add(nearly).add("\xc3\xa4");
  EXPECT_EQ(text.view(), nearly);
  text.add("b").add("c").add(int64_t{7});
  EXPECT_EQ(text.view(), nearly + "b");
  text.clear();
  text.add(int64_t{-12345});
  EXPECT_EQ(text.view(), "-12345");
}

// Under ThreadSanitizer too.
TEST(EventRing, R10_OneThreadPutsAndAnotherTakes) {
  constexpr int kPut = 200'000;
  EventRing ring;
  std::atomic<bool> done{false};
  std::thread control([&] {
    for (int i = 0; i < kPut; ++i) put(ring, i);
    done = true;
  });
  uint64_t taken = 0;
  int64_t before = -1;
  ScanEvent event;
  for (bool last = false; !last;) {
    last = done;
    while (ring.take(event)) {
      ++taken;
      ASSERT_GT(static_cast<int64_t>(event.cycle), before);
      ASSERT_EQ(event.text.view(), std::to_string(event.cycle));
      before = static_cast<int64_t>(event.cycle);
    }
  }
  control.join();
  EXPECT_EQ(taken + ring.take_lost(ScanEventKind::kOverrun), uint64_t{kPut});
}

std::vector<ScanEvent> all_of(EventRing& ring) {
  std::vector<ScanEvent> out;
  for (ScanEvent event; ring.take(event);) out.push_back(event);
  return out;
}

// A round of its loop takes a microsecond.
constexpr const char* kLate = R"(
PROGRAM Work VAR i, n : DINT; limit : DINT := 100; zero : DINT; END_VAR
  FOR i := 1 TO limit DO n := n + 1; END_FOR
  IF limit = 7 THEN n := n / zero; END_IF
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'on_trap' := 'go_on'} {attribute 'watchdog' := 'T#50ms'}
  TASK Slow (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM W WITH Slow : Work;
END_RESOURCE END_CONFIGURATION
)";

vm::ControllerOptions telling(EventRing& ring) {
  vm::ControllerOptions options;
  options.fuel_slice = 100;
  options.events = &ring;
  return options;
}

// At the next boundary.
void set_limit(Plant& plant, const char* value) {
  while (!plant->at_boundary()) plant.cycles(1);
  ASSERT_TRUE(plant->set("W.limit", value).ok());
}

TEST(ScanEvents, R10_OverrunsTrapsAndTheWatchdogAreTold) {
  EventRing ring;
  Plant plant(kLate, telling(ring), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  EXPECT_TRUE(all_of(ring).empty());

  set_limit(plant, "7");
  plant.cycles(1);
  std::vector<ScanEvent> events = all_of(ring);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, ScanEventKind::kTrap);
  EXPECT_EQ(events[0].source.view(), "task Slow");
  EXPECT_NE(events[0].text.view().find(":4 (Work): division"), std::string_view::npos)
      << events[0].text.view();
  EXPECT_EQ(events[0].version, plant->verified().digest());
  EXPECT_EQ(events[0].cycle, plant->traps().back()->cycle);

  set_limit(plant, "25000");
  plant.cycles(4);
  events = all_of(ring);
  ASSERT_FALSE(events.empty());
  for (const ScanEvent& event : events) {
    EXPECT_EQ(event.kind, ScanEventKind::kOverrun);
    EXPECT_EQ(event.source.view(), "task Slow");
  }
  EXPECT_EQ(events.size(), plant.task("Slow").overruns);

  set_limit(plant, "2000000");
  plant.cycles(12);
  events = all_of(ring);
  const auto watchdogs = std::count_if(events.begin(), events.end(), [](const ScanEvent& event) {
    return event.kind == ScanEventKind::kWatchdog;
  });
  EXPECT_GT(watchdogs, 0);
}

// Whether there is room or not.
TEST(ScanEvents, R10_AnOverrunAllocatesNothing) {
  EventRing ring;
  Plant plant(kLate, telling(ring), 1000);
  ASSERT_TRUE(plant.ok());
  set_limit(plant, "15000");
  plant.cycles(10);
  const uint64_t overruns = plant.task("Slow").overruns;
  const uint64_t before = tests::allocations();
  plant.cycles(600);
  const uint64_t allocated = tests::allocations() - before;
  EXPECT_EQ(allocated, 0u);
  EXPECT_GT(plant.task("Slow").overruns, overruns + EventRing::kRecords);
  EXPECT_GT(ring.take_lost(ScanEventKind::kOverrun), 0u);
}

}  // namespace
}  // namespace runtime_test
