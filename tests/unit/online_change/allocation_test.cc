// Memory that runs out at every single allocation of a change: the old program runs on, nothing is
// leaked, and the same change goes through when there is memory again (case 51).
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "base/memory_limit.h"
#include "tests/unit/online_change/heap_use.h"
#include "tests/unit/online_change/plant.h"

namespace {

// Of this thread; the tests have no other.
bool counting = false;
int64_t until_failure = -1;  // allocations that still succeed; -1: all
int64_t allocations = 0;
uint64_t bytes = 0;
int64_t live = 0;

void* allocate(size_t size) {
  if (counting) {
    ++allocations;
    bytes += size;
    if (until_failure == 0) return nullptr;
    if (until_failure > 0) --until_failure;
  }
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory != nullptr) ++live;
  return memory;
}

// Not inlined, or the compiler takes malloc and delete for a mismatched pair.
[[gnu::noinline]] void release(void* memory) {
  if (memory != nullptr) --live;
  std::free(memory);
}

}  // namespace

void* operator new(size_t size) {
  void* memory = allocate(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](size_t size) { return operator new(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, size_t) noexcept { release(memory); }
void operator delete[](void* memory, size_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }

namespace tests {

HeapUse heap_use_of(const std::function<void()>& job) {
  until_failure = -1;
  allocations = 0;
  bytes = 0;
  counting = true;
  job();
  counting = false;
  return {allocations, bytes};
}

}  // namespace tests

namespace online_change {
namespace {

using plant::Plant;

constexpr const char* kOld =
    "FUNCTION_BLOCK Box VAR n : INT := 3; t : TON; END_VAR n := n + 1; "
    "t(IN := TRUE, PT := T#1s); END_FUNCTION_BLOCK\n"
    "VAR_GLOBAL g : INT := 1; END_VAR\n"
    "PROGRAM Main VAR b : ARRAY[1..3] OF Box; p : POINTER TO INT := ADR(g); s : STRING[20] := "
    "'twelve chars'; c : DINT := 70000; gone : INT := 9; END_VAR b[1](); p^ := p^ + 1; "
    "END_PROGRAM";
constexpr const char* kNew =
    "FUNCTION_BLOCK Box VAR more : ARRAY[1..40] OF LREAL; n : INT := 3; t : TON; END_VAR n := n + "
    "1; t(IN := TRUE, PT := T#1s); END_FUNCTION_BLOCK\n"
    "VAR_GLOBAL h : LINT; g : DINT := 1; END_VAR\n"
    "PROGRAM Main VAR b : ARRAY[0..3] OF Box; p : POINTER TO INT; s : STRING[5]; c : INT; END_VAR "
    "b[1](); END_PROGRAM";

// Memory for `successes` allocations inside `work`.
template <class Work>
auto with_allocations(int64_t successes, Work work) {
  until_failure = successes;
  counting = true;
  auto result = work();
  counting = false;
  until_failure = -1;
  return result;
}

base::Status whole_change(Change& driver, base::ByteSpan package, Strategy strategy) {
  base::Status done = driver.stage(package, strategy);
  if (!done.ok()) return done;
  done = base::within_memory(
      [&] {
        (void)driver.live_losses();
        return base::Status(base::Ok{});
      },
      [] {
        return base::Status(base::Error{base::Refusal::kNoMemory, {}});
      });
  if (!done.ok()) return done;
  done = driver.arm(true, true);
  if (!done.ok()) return done;
  auto report = driver.switch_now();
  counting = false;  // the copy of its text is the test's
  if (!report.ok()) return report.error();
  return base::Ok{};
}

// X5, case 51: memory that runs out while FB_Init of what is new traps.
TEST(Allocation, case51_WhileFbInitTraps) {
  constexpr const char* kTraps =
      "FUNCTION_BLOCK Box VAR n, z : INT; END_VAR METHOD FB_Init : BOOL VAR_INPUT "
      "bInitRetains, bInCopyCode : BOOL; END_VAR all := 7; n := 1 / z; END_METHOD "
      "END_FUNCTION_BLOCK\n"
      "VAR_GLOBAL all : INT; END_VAR PROGRAM Main VAR c : INT; b : Box; END_VAR c := c + 1; "
      "END_PROGRAM";
  for (const Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Plant plant(
        "VAR_GLOBAL all : INT; END_VAR PROGRAM Main VAR c : INT; END_VAR c := c + 1; END_PROGRAM");
    plant.run(3);
    const base::Bytes package = plant.package(kTraps);
    Change& driver = plant.driver();
    const base::Digest before = plant.hash();
    for (int64_t successes = 0;; ++successes) {
      base::Status done =
          with_allocations(successes, [&] { return whole_change(driver, package, strategy); });
      ASSERT_FALSE(done.ok());
      driver.cancel();
      ASSERT_EQ(driver.state(), State::kIdle) << successes;
      ASSERT_EQ(plant.hash(), before) << successes;
      if (done.error().refusal == base::Refusal::kInitFailed) break;
      ASSERT_EQ(done.error().refusal, base::Refusal::kNoMemory) << successes;
    }
    plant.controller().cycle();
    EXPECT_EQ(plant.get("Main.c"), "4");
  }
}

void try_every_allocation(Strategy strategy) {
  Plant plant(kOld);
  plant.run(3);
  const base::Bytes package = plant.package(kNew);
  Change& driver = plant.driver();
  const base::Digest before = plant.hash();
  int64_t failed = 0;
  int64_t live_before = -1;
  for (int64_t successes = 0;; ++successes) {
    base::Status done =
        with_allocations(successes, [&] { return whole_change(driver, package, strategy); });
    if (done.ok()) break;
    ++failed;
    ASSERT_EQ(done.error().refusal, base::Refusal::kNoMemory) << successes;
    driver.cancel();
    ASSERT_EQ(driver.state(), State::kIdle) << successes;
    ASSERT_EQ(plant.hash(), before) << successes;
    ASSERT_EQ(plant.get("Main.gone"), "9");
    // A generation that was prepared is kept until the next one.
    if (successes % 100 == 99) {
      const int64_t limit = live_before < 0 ? live : live_before + 200;
      ASSERT_LE(live, limit) << successes;
      live_before = live;
    }
  }
  EXPECT_GT(failed, 500);
  EXPECT_EQ(driver.state(), State::kTrial);
  plant.run(2);
  EXPECT_EQ(plant.get("Main.b[1].n"), "8");

  const base::Digest trial = plant.hash();
  for (int64_t successes = 0;; ++successes) {
    auto undone = with_allocations(successes, [&] { return driver.undo(); });
    if (undone.ok()) break;
    ASSERT_EQ(undone.error().refusal, base::Refusal::kNoMemory) << successes;
    ASSERT_EQ(driver.state(), State::kTrial);
    ASSERT_EQ(plant.hash(), trial) << successes;
  }
  EXPECT_EQ(plant.get("Main.gone"), "9");
  EXPECT_EQ(plant.get("Main.c"), "70000");
  EXPECT_EQ(plant.get("Main.s"), "'twelve chars'");
  plant.run(2);
}

TEST(Allocation, C1_case51_every_allocation_fails_in_place) {
  try_every_allocation(Strategy::kInPlace);
}

TEST(Allocation, C1_case51_every_allocation_fails_by_standby) {
  try_every_allocation(Strategy::kStandby);
}

// A member of each of many structures is one step.
TEST(Allocation, V17_checking_a_package_takes_no_memory_for_each_value) {
  const std::string numbers = "TYPE Pair : STRUCT a : ";
  const std::string rest =
      " k : LINT; END_STRUCT; END_TYPE\n"
      "PROGRAM Main VAR list : ARRAY[1..200000] OF Pair; END_VAR END_PROGRAM";
  linker::Slack room;
  room.free_bytes = 16 << 20;
  Plant plant(numbers + "INT; b : INT;" + rest, room);
  const base::Result<Package> package = decode(plant.package(numbers + "DINT; b : DINT;" + rest));
  ASSERT_TRUE(package.ok());
  const base::Result<ir::VerifiedImage> next = ir::verify(package->image);
  ASSERT_TRUE(next.ok());
  bytes = 0;
  const base::Status sound = with_allocations(
      -1, [&] { return check_package(*package, plant.controller().image(), next->image()); });
  EXPECT_TRUE(sound.ok());
  EXPECT_LT(bytes, 200'000u);
}

// FB_Exit has run when memory runs out: the instance is made again before the old program goes on.
TEST(Allocation, case34_case51_what_has_left_is_made_again) {
  const std::string pump =
      "VAR_GLOBAL inits, exits : INT; END_VAR\n"
      "FUNCTION_BLOCK Pump VAR n : INT; END_VAR\n"
      "METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR inits := inits + "
      "1; END_METHOD\n"
      "METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR exits := exits + 1; END_METHOD\n"
      "END_FUNCTION_BLOCK\n";
  const std::string with =
      pump + "PROGRAM Main VAR a, b : Pump; v : INT := 300; END_VAR END_PROGRAM";
  Plant plant(with);
  plant.run(2);
  const base::Bytes package =
      plant.package(pump + "PROGRAM Main VAR b : Pump; v : SINT; END_VAR END_PROGRAM");
  Change& driver = plant.driver();
  int behind_exit = 0;
  for (int64_t successes = 0;; ++successes) {
    // Leave for what the report showed, which is not all any more: a refusal that has a text.
    plant.set("Main.v", "5");
    ASSERT_TRUE(driver.stage(package).ok());
    (void)driver.live_losses();
    ASSERT_TRUE(driver.arm(true, true).ok());
    plant.set("Main.v", "300");
    auto report = with_allocations(successes, [&] { return driver.switch_now(); });
    ASSERT_FALSE(report.ok());
    const bool memory = report.error().refusal == base::Refusal::kNoMemory;
    if (plant.get("exits") != plant.get("inits")) behind_exit += memory;
    plant.run(2);
    // Both were made once at the start; whoever left was made again.
    ASSERT_EQ(std::stoi(plant.get("inits")), 2 + std::stoi(plant.get("exits"))) << successes;
    if (!memory) break;
  }
  EXPECT_GT(behind_exit, 0);
}

// Nothing is taken between the first look at the boundary and the store that publishes.
TEST(Allocation, invariant2_the_switch_and_undo_allocate_nothing) {
  for (Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Plant plant(kOld);
    plant.run(3);
    const base::Bytes package = plant.package(kNew);
    ASSERT_TRUE(plant.driver().stage(package, strategy).ok());
    ASSERT_TRUE(plant.driver().arm(true, true).ok());
    allocations = 0;
    EXPECT_TRUE(with_allocations(-1, [&] { return plant.driver().switch_now(); }).ok());
    EXPECT_EQ(allocations, 0);
    plant.run(2);
    allocations = 0;
    EXPECT_TRUE(with_allocations(-1, [&] { return plant.driver().undo(); }).ok());
    EXPECT_EQ(allocations, 0);
  }
}

// Each change and undo gives back what it took.
TEST(Allocation, case51_nothing_is_leaked) {
  Plant plant(kOld);
  plant.run(3);
  const base::Bytes package = plant.package(kNew);
  int64_t settled = 0;
  for (int i = 0; i < 50; ++i) {
    const Strategy strategy = i % 2 == 0 ? Strategy::kInPlace : Strategy::kStandby;
    ASSERT_TRUE(whole_change(plant.driver(), package, strategy).ok());
    plant.run(1);
    ASSERT_TRUE(plant.driver().undo().ok());
    plant.driver().collect();
    plant.run(1);
    if (i == 9) settled = live;
  }
  EXPECT_EQ(live, settled);
}

}  // namespace
}  // namespace online_change
