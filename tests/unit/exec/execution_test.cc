// Running: results, fuel, suspension, calls, traps, and what a scan must not do.
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/allocations.h"
#include "tests/unit/exec/machine.h"
#include "tests/unit/sanitized.h"
#include "vm/native/program.h"

namespace {

using namespace sample;
using vm::Exit;

// d0 := 1; WHILE d0 < times DO d0 := d0 + 1; word := d0
ir::Image counting_image(int32_t times) {
  ir::Image image = sample::image(op(Opcode::MOV_32, F(kD0), C(kOne32)) +              // 0: d0 := 1
                                      op(Opcode::GE_I32, F(kB0), F(kD0), C(68)) +      // 1
                                      jump(Opcode::JT, 2, F(kB0)) +                    // 2
                                      op(Opcode::ADD_32, F(kD0), F(kD0), C(kOne32)) +  // 3
                                      jump(Opcode::LOOP, -4) +                         // 4
                                      op(Opcode::MOV_32, S(kWord), F(kD0)) + op(Opcode::RET),  // 5
                                  {{1, {2}}, {5, {2}}});
  std::memcpy(&image.pool[68], &times, sizeof times);
  return image;
}

TEST(Execution, RunsABitOfEverything) {
  Machine machine(busy_image());
  ASSERT_EQ(machine.scan(), Exit::kDone) << machine.trap_text();
  EXPECT_EQ(machine.value("Main.y"), "15");  // Add(11, 4)
  EXPECT_EQ(machine.value("Main.x"), "12");  // the counter adds 1 through its in-out
  EXPECT_EQ(machine.value("Main.fb.n"), "1");
  EXPECT_EQ(machine.value("Main.numbers"), "[1, 2, 3, 4]");
  EXPECT_EQ(machine.value("Main.text"), "'hello'");
  EXPECT_EQ(machine.value("count"), "5");  // LEN
  ASSERT_EQ(machine.scan(), Exit::kDone);
  EXPECT_EQ(machine.value("Main.x"), "14");
}

TEST(Execution, OneUnitOfFuelGivesTheSameResult) {
  Machine machine(busy_image());
  ASSERT_TRUE(machine.good());
  machine.start();
  uint64_t runs = 1;
  while (machine.execution().run(1) == Exit::kSuspended) ++runs;
  // Three calls of which one is a function, three back edges, and the end.
  EXPECT_EQ(runs, 6u);
  EXPECT_EQ(machine.execution().fuel_used(), 5u);
  EXPECT_EQ(machine.value("Main.numbers"), "[1, 2, 3, 4]");
  EXPECT_EQ(machine.value("Main.x"), "12");
  EXPECT_EQ(machine.value("Main.y"), "15");
}

TEST(Execution, NoFuelIsTakenAsOne) {
  Machine machine(counting_image(3));
  ASSERT_TRUE(machine.good());
  machine.start();
  EXPECT_EQ(machine.execution().run(0), Exit::kSuspended);
  EXPECT_EQ(machine.execution().fuel_used(), 1u);
  EXPECT_EQ(machine.execution().run(0), Exit::kSuspended);
  EXPECT_EQ(machine.execution().run(0), Exit::kDone);
}

TEST(Execution, ASuspendedOneGoesOnAfterAnotherRanOnTop) {
  Machine machine(counting_image(100));
  ASSERT_TRUE(machine.good());
  machine.start();
  ASSERT_EQ(machine.execution().run(50), Exit::kSuspended);
  vm::Execution other(8);
  const uint32_t top = machine.execution().stack_top();
  EXPECT_EQ(top, ir::kStackBegin + kNext);
  other.start(machine.generation(), machine.data(), kMainInstance, top, 0);
  EXPECT_EQ(other.run(1000), Exit::kDone);
  machine.set_main<uint32_t>(kWord, 0);
  EXPECT_EQ(machine.execution().run(1000), Exit::kDone);
  EXPECT_EQ(machine.main<uint32_t>(kWord), 100u);
  EXPECT_EQ(machine.execution().fuel_used(), 99u);
}

TEST(Execution, StackTopInsideACall) {
  Machine machine(busy_image());
  ASSERT_TRUE(machine.good());
  machine.start();
  ASSERT_EQ(machine.execution().run(1), Exit::kSuspended);  // at the entry of Add
  EXPECT_EQ(machine.execution().stack_top(), ir::kStackBegin + kNext + 8);
}

// With little stack for the whole process: a handler that called the next one instead
// of jumping there would need more.
TEST(Execution, TenMillionTurnsDoNotGrowTheStack) {
  Machine machine(counting_image(10'000'000));
  ASSERT_EQ(machine.scan(20'000'000), Exit::kDone);
  EXPECT_EQ(machine.main<uint32_t>(kWord), 10'000'000u);
}

TEST(Execution, AMillionStraightInstructionsDoNotGrowTheStack) {
  constexpr int kMany = 1'000'000 / kOneOf;
  Code code;
  for (int i = 0; i < kMany; ++i) code.push_back(op(Opcode::ADD_16, S(kX), S(kX), C(kOne16))[0]);
  Machine machine(sample::image(code + op(Opcode::RET)));
  ASSERT_EQ(machine.scan(), Exit::kDone);
  EXPECT_EQ(machine.main<int16_t>(kX), static_cast<int16_t>(kMany + 10));
}

TEST(Execution, AScanAllocatesNothing) {
  Machine machine(busy_image());
  ASSERT_EQ(machine.scan(), Exit::kDone);
  const uint64_t before = tests::allocations();
  for (int i = 0; i < 100; ++i) machine.scan();
  machine.start();
  while (machine.execution().run(1) == Exit::kSuspended) {
  }
  EXPECT_EQ(tests::allocations(), before);
}

// In a process that may do nothing but end: any other system call kills it.
TEST(Execution, AScanMakesNoSystemCall) {
  Machine machine(busy_image());
  ASSERT_EQ(machine.scan(), Exit::kDone);
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) syscall(SYS_exit, 77);
    for (int i = 0; i < 10; ++i) machine.scan();
    machine.start();
    while (machine.execution().run(1) == Exit::kSuspended) {
    }
    syscall(SYS_exit, 42);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no seccomp here";
  EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 42);
}

TEST(Execution, TaskTime) {
  Machine machine(sample::image(op(Opcode::TASK_TIME, F(kQ0)) +
                                op(Opcode::MOV_64, S(kLong), F(kQ0)) + op(Opcode::RET)));
  ASSERT_EQ(machine.scan(10, 123456789), Exit::kDone);
  EXPECT_EQ(machine.main<int64_t>(kLong), 123456789);
}

TEST(Execution, InstancesInAnArrayAreCalledByTheirSlot) {
  const Types t = types_of(sample::image(op(Opcode::RET)));
  (void)t;
  Machine machine(sample::image(
      op(Opcode::MOV_16, F(kW0), C(kOne16)) +
      ext(Opcode::INDEX_PLACE_I16, F(kAddrSlot), F(kW0), S(0), 1, kFbs) +
      op(Opcode::INST_AT, F(kAddrCounter), F(kAddrSlot), F(0)) +
      op(Opcode::ST_B, F(kAddrCounter), C(kTrue), F(kRun)) +
      ext(Opcode::LEA, F(kAddrInt), S(0), {}, kY, static_cast<uint32_t>(ir::Kind::kInt)) +
      op(Opcode::ST_REF_AT, F(kAddrCounter), F(kAddrInt), F(kIo)) +
      op(Opcode::CALL_INST_AT, F(kNext / 8), F(kAddrSlot), F(0)) + op(Opcode::RET)));
  ASSERT_EQ(machine.scan(), Exit::kDone) << machine.trap_text();
  EXPECT_EQ(machine.value("Main.fbs"), "[(run := FALSE, n := 0), (run := TRUE, n := 1)]");
  EXPECT_EQ(machine.value("Main.y"), "1");
}

// --- traps ---------------------------------------------------------------------

void expect_trap(const Code& code, ir::TrapKind kind, uint32_t unit, const std::string& text) {
  Machine machine(sample::image(code + op(Opcode::RET)));
  ASSERT_TRUE(machine.good());
  ASSERT_EQ(machine.scan(), Exit::kTrap) << text;
  const vm::Trap& trap = machine.execution().trap();
  EXPECT_EQ(trap.kind, kind);
  EXPECT_EQ(trap.unit, unit);
  EXPECT_EQ(trap.pou, kMainPou);
  EXPECT_EQ(trap.instance, kMainInstance);
  EXPECT_NE(machine.trap_text().find(text), std::string::npos) << machine.trap_text();
  const vm::TrapText described = vm::describe(machine.image(), trap);
  EXPECT_EQ(described.pou, "Main");
  EXPECT_EQ(described.file, "main.st");
  EXPECT_EQ(described.line, unit < 4 ? 3u : 7u);
}

TEST(Trap, Kinds) {
  using ir::TrapKind;
  expect_trap(op(Opcode::DIV_I16, F(kW0), S(kX), C(kZero16)), TrapKind::kDivisionByZero, 0, "zero");
  expect_trap(op(Opcode::MOD_I16, F(kW0), S(kX), C(kZero16)), TrapKind::kDivisionByZero, 0, "zero");
  expect_trap(ext(Opcode::INDEX_PLACE_I16, F(kAddrInt), S(kX), S(0), 0, kNumbers), TrapKind::kIndex,
              0, "numbers[10], bounds 1..4");
  expect_trap(op(Opcode::MOV_16, F(kW0), C(kOne16)) +
                  op(Opcode::SUB_16, F(kW0), F(kW0), C(kFour16)) +
                  op(Opcode::CHECK_I16, {}, F(kW0), F(0)),
              TrapKind::kSubrange, 2, "level = -3, range 0..100");
  expect_trap(op(Opcode::CHECK_STEP_16, {}, S(kY)), TrapKind::kForStep, 0, "step zero");
  expect_trap(op(Opcode::MOV_F64, F(kLf0), C(kHuge)) + op(Opcode::ROUND_F64_I16, F(kW0), F(kLf0)),
              TrapKind::kConversion, 1, "1.0E+300");
  expect_trap(op(Opcode::MOV_16, F(kW0), C(kOne16)) + op(Opcode::MOV_16, F(kW0), C(kOne16)) +
                  op(Opcode::MOV_16, F(kW0), C(kOne16)) + op(Opcode::MOV_16, F(kW0), C(kOne16)) +
                  op(Opcode::CHECK_STEP_16, {}, S(kY)),
              TrapKind::kForStep, 4, "");
}

TEST(Trap, UnboundInOut) {
  ir::Image image = sample::image(wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
                                  op(Opcode::ST_B, F(kAddrCounter), C(kTrue), F(kRun)) +
                                  wide(Opcode::CALL_INST, F(kNext / 8), S(kFb)) + op(Opcode::RET));
  Machine machine(image);
  ASSERT_EQ(machine.scan(), Exit::kTrap);
  EXPECT_EQ(machine.execution().trap().kind, ir::TrapKind::kReference);
  EXPECT_EQ(machine.execution().trap().pou, kCounterPou);
  EXPECT_EQ(machine.execution().trap().instance, 2u);
  EXPECT_EQ(machine.execution().trap().unit, 2u);
}

TEST(Trap, AnInstanceThatMemoryNoLongerNames) {
  const ir::Image image =
      sample::image(wide(Opcode::CALL_INST, F(kNext / 8), S(kFb)) + op(Opcode::RET));
  Machine machine(image, {.tier = vm::Tier::kInterpreter});
  // What is damaged leads machine code nowhere else: it knows from the image where the instance is.
  Machine native(image, {.tier = vm::Tier::kNative});
  for (uint32_t id : {0u, 6u, 7u, 0xffffffffu}) {
    machine.set_main<uint32_t>(kFb, id);
    ASSERT_EQ(machine.scan(), Exit::kTrap) << id;
    EXPECT_EQ(machine.execution().trap().kind, ir::TrapKind::kInstance);
    native.set_main<uint32_t>(kFb, id);
    EXPECT_EQ(native.scan(), vm::native::is_available() ? Exit::kDone : Exit::kTrap) << id;
  }
}

TEST(Trap, ExplicitOne) {
  Machine machine(sample::image(op(Opcode::TRAP, F(static_cast<uint32_t>(ir::TrapKind::kAssert)))));
  ASSERT_EQ(machine.scan(), Exit::kTrap);
  EXPECT_EQ(machine.execution().trap().kind, ir::TrapKind::kAssert);
}

TEST(Execution, HasRoomForTheDeclaredDepth) {
  Machine machine(busy_image());
  ASSERT_TRUE(machine.good());
  vm::Execution shallow(0);
  shallow.start(machine.generation(), machine.data(), kMainInstance, ir::kStackBegin, 0);
  // A program's own call is not counted, so one more fits than is declared.
  EXPECT_EQ(shallow.run(1000), Exit::kDone);
}

TEST(Memory, IsReservedAndMoves) {
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  memory.data()[0xffffffffu] = 1;
  vm::Memory other = std::move(memory);
  EXPECT_EQ(other.view().size(), size_t{1} << 32);
  EXPECT_EQ(other.view()[0xffffffffu], 1);
  EXPECT_DEATH(const_cast<volatile uint8_t*>(other.data())[size_t{1} << 32] = 1, "");
}

}  // namespace
