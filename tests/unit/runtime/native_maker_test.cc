// Machine code of the first version is made beside its first scans.
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "tests/unit/runtime/plant.h"
#include "vm/native/program.h"

// Stands in front of the C library's, which locks the heaps of all threads for milliseconds.
static uint64_t trims = 0;
extern "C" int malloc_trim(size_t) noexcept {
  ++trims;
  return 0;
}

// Likewise: the first thing that a thread in the background asks for. While the gate is shut it
// makes nothing, and then it works at normal priority, whatever else the machine does.
static std::atomic<bool> gate_is_shut{false};
extern "C" int sched_setscheduler(pid_t id, int policy, const sched_param* parameter) noexcept {
  if (policy != SCHED_BATCH) {
    return static_cast<int>(::syscall(SYS_sched_setscheduler, id, policy, parameter));
  }
  gate_is_shut.wait(true);
  return 0;
}
extern "C" int setpriority(__priority_which_t, id_t, int) noexcept { return 0; }

namespace runtime_test {
namespace {

// No machine code is made until it is opened; what waits for the end of the thread would not end.
class Gate {
 public:
  Gate() { gate_is_shut = true; }
  ~Gate() { open(); }
  void open() {
    gate_is_shut = false;
    gate_is_shut.notify_all();
  }
};

constexpr uint32_t kBlocks = 300;

// A program that calls blocks of many types, and one in a slow task, which takes several cycles.
std::string many_blocks() {
  std::string out;
  std::string variables;
  std::string calls;
  for (uint32_t i = 0; i < kBlocks; ++i) {
    const std::string number = std::to_string(i);
    out += "FUNCTION_BLOCK B" + number +
           " VAR k, n : DINT; END_VAR FOR k := 1 TO 3 DO n := n + k; END_FOR; END_FUNCTION_BLOCK\n";
    variables += " b" + number + " : B" + number + ";";
    calls += " b" + number + "();";
  }
  return out + "PROGRAM P VAR scans : DINT;" + variables + " END_VAR scans := scans + 1;" + calls +
         R"( END_PROGRAM
PROGRAM S VAR k, n : DINT; END_VAR FOR k := 1 TO 400 DO n := n + 1; END_FOR; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 0);
  TASK Slow (INTERVAL := T#100ms, PRIORITY := 1);
  PROGRAM A WITH Fast : P;
  PROGRAM B WITH Slow : S;
END_RESOURCE END_CONFIGURATION)";
}

vm::ControllerOptions beside(uint64_t take_at = 0) {
  vm::ControllerOptions out;
  out.tier.making = vm::Making::kBeside;
  out.tier.take_at = take_at;
  return out;
}

TEST(NativeMaker, ScansDoNotWaitForMachineCodeAndGoOnWithIt) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  Plant plant(many_blocks(), beside());
  ASSERT_TRUE(plant.ok());
  int cycles = 0;
  do {
    plant.cycles(1);
    ++cycles;
  } while (plant->pous_to_make() != 0);
  plant.cycles(2);
  EXPECT_EQ(trims, 0u) << "a thread of low priority holds what a command waits for";
  ASSERT_NE(plant->generation().native(), nullptr);
  EXPECT_EQ(plant->generation().native()->native_pous(), plant->image().pous.size());
  EXPECT_EQ(plant.get("A.scans"), std::to_string(cycles + 2));
  EXPECT_EQ(plant.get("A.b7.n"), std::to_string(6 * (cycles + 2)));
}

void wait_for_machine_code(Plant& plant) {
  while (plant->pous_to_make() != 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Does all of what runs have machine code?
void expect_machine_code(Plant& plant) {
  ASSERT_NE(plant->generation().native(), nullptr);
  EXPECT_EQ(plant->generation().native()->native_pous(), plant->image().pous.size());
  EXPECT_EQ(plant->code().native.get(), plant->generation().native());
}

// What is prepared is interpreted, and its machine code is made after the switch; also when
// somebody takes the switch back before it is, or behind it.
TEST(NativeMaker, AChangeMeanwhileDoesNotWaitForIt) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  for (const bool waits_for_first : {false, true}) {
    Gate gate;
    Plant plant(many_blocks(), beside());
    ASSERT_TRUE(plant.ok());
    plant.cycles(1);
    auto next = plant->prepare(plant->verified());
    ASSERT_TRUE(next.ok());
    EXPECT_EQ(plant->generation().native(), nullptr);
    EXPECT_EQ((*next)->native(), nullptr);
    gate.open();
    if (waits_for_first) wait_for_machine_code(plant);
    auto old = plant->publish(std::move(*next));
    plant.cycles(1);
    plant->make_native();
    wait_for_machine_code(plant);
    plant.cycles(1);
    expect_machine_code(plant);
    auto newer = plant->publish(std::move(old));
    plant->make_native();
    plant.cycles(1);
    wait_for_machine_code(plant);
    plant.cycles(1);
    expect_machine_code(plant);
    EXPECT_EQ(plant.get("A.scans"), "5");
    EXPECT_EQ(plant.get("A.b7.n"), std::to_string(6 * 5));
  }
}

// Neither what it was made for nor those who asked for it need live as long.
TEST(NativeMaker, VersionsMayEndMeanwhile) {
  Plant plant(many_blocks(), beside());
  ASSERT_TRUE(plant.ok());
  for (int i = 0; i < 5; ++i) {
    auto next = plant->prepare(plant->verified());
    ASSERT_TRUE(next.ok());
    plant->publish(std::move(*next)).reset();
    if (i % 2 == 0) plant->make_native();
    plant.cycles(1);
  }
  EXPECT_EQ(plant.get("A.b7.n"), std::to_string(6 * 5));
}

// The limit of threads does not hold for root.
void have_no_more_threads() {
  constexpr uid_t kNobody = 65534;
  const rlimit none{0, 0};
  const bool dropped = ::geteuid() != 0 || ::setuid(kNobody) == 0;
  if (!dropped || ::setrlimit(RLIMIT_NPROC, &none) != 0) ::_exit(2);
}

TEST(NativeMaker, WithoutAThreadAChangeIsInterpreted) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  const pid_t child = ::fork();
  if (child == 0) {
    have_no_more_threads();
    Plant plant(many_blocks(), beside());
    if (!plant.ok()) ::_exit(3);
    for (int i = 0; i < 2; ++i) {
      plant.cycles(1);
      if (plant->pous_to_make() != 0 || plant->generation().native() != nullptr) ::_exit(4);
      auto next = plant->prepare(plant->verified());
      if (!next.ok()) ::_exit(5);
      const auto old = plant->publish(std::move(*next));
      plant->make_native();
    }
    plant.cycles(1);
    ::_exit(plant.get("A.scans") == "3" ? 0 : 6);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "it ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(NativeMaker, AChangePreparedBehindItSharesItsCode) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  Plant plant(many_blocks(), beside());
  ASSERT_TRUE(plant.ok());
  wait_for_machine_code(plant);
  auto next = plant->prepare(plant->verified());
  ASSERT_TRUE(next.ok());
  for (uint32_t pou = 0; pou < plant->image().pous.size(); ++pou) {
    EXPECT_NE((*next)->pous()[pou].machine, nullptr);
    EXPECT_EQ((*next)->pous()[pou].machine, plant->generation().pous()[pou].machine);
  }
  plant.cycles(1);
  auto old = plant->publish(std::move(*next));
  plant.cycles(1);
  auto newer = plant->publish(std::move(old));
  plant.cycles(1);
  EXPECT_EQ(plant.get("A.scans"), "3");
}

// Its code is interpreted as everything is, and is machine code when that is there.
TEST(NativeMaker, AForceMeanwhileDoesNotWaitForIt) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  Gate gate;
  Plant plant(many_blocks(), beside());
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  ASSERT_TRUE(plant->force("A.scans", "70").ok());
  EXPECT_NE(plant->pous_to_make(), 0u);
  EXPECT_EQ(plant->renew_forces(), nullptr);
  plant.cycles(2);
  EXPECT_EQ(plant.get("A.scans"), "70");
  EXPECT_EQ(plant->code().native, nullptr);
  auto next = plant->prepare(plant->verified());
  ASSERT_TRUE(next.ok());
  EXPECT_NE(plant->pous_to_make(), 0u);
  gate.open();
  auto old = plant->publish(std::move(*next));
  plant->make_native();
  plant.cycles(1);
  wait_for_machine_code(plant);
  plant.cycles(1);
  EXPECT_EQ(plant->code().native, nullptr);
  const auto renewed = plant->renew_forces();
  ASSERT_NE(renewed, nullptr);
  plant->use(*renewed);
  EXPECT_EQ(plant->renew_forces(), nullptr);
  ASSERT_NE(plant->code().native, nullptr);
  EXPECT_NE(plant->code().native, plant->generation().code()->native);
  EXPECT_EQ(plant->code().native->native_pous(), plant->image().pous.size());
  plant.cycles(2);
  EXPECT_EQ(plant.get("A.scans"), "70");
  ASSERT_TRUE(plant->unforce("A.scans").ok());
  plant.cycles(2);
  expect_machine_code(plant);
  EXPECT_EQ(plant.get("A.scans"), "72");
  EXPECT_EQ(plant.get("A.b7.n"), std::to_string(6 * 9));
}

TEST(NativeMaker, AForceMeanwhileIsAVersionOfMachineCodeAndEndsWithIt) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier for this machine";
  Plant plant(many_blocks(), beside(3));
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  ASSERT_TRUE(plant->force("A.scans", "70").ok());
  plant.cycles(4);
  EXPECT_EQ(plant.get("A.scans"), "70");
  ASSERT_TRUE(plant->unforce("A.scans").ok());
  plant.cycles(2);
  EXPECT_EQ(plant.get("A.scans"), "72");
  EXPECT_EQ(plant.get("A.b7.n"), std::to_string(6 * 7));
  ASSERT_NE(plant->generation().native(), nullptr);
}

// Whoever was interrupted ends with what it began with; whoever begins finds machine code.
TEST(NativeMaker, B1ATaskInTheMiddleGoesOnWhenMachineCodeComes) {
  constexpr int64_t kNsPerSafePoint = 20'000;
  Plant there(many_blocks(), {}, kNsPerSafePoint);
  Plant comes(many_blocks(), beside(2), kNsPerSafePoint);
  ASSERT_TRUE(there.ok() && comes.ok());
  for (int i = 0; i < 30; ++i) {
    there.cycles(1);
    comes.cycles(1);
    for (const char* path : {"A.scans", "B.n", "B.k", "A.b299.n"}) {
      EXPECT_EQ(there.get(path), comes.get(path)) << path << " in cycle " << i;
    }
    EXPECT_EQ(there.clock.now_ns(), comes.clock.now_ns());
  }
  EXPECT_GT(there.task("Slow").scans, 1u);
}

TEST(NativeMaker, AControllerMayEndMeanwhile) {
  for (int i = 0; i < 3; ++i) {
    Plant plant(many_blocks(), beside());
    ASSERT_TRUE(plant.ok());
    plant.cycles(i);
  }
}

}  // namespace
}  // namespace runtime_test
