// B3, B5: inputs stand still for a scan, outputs are never half-done.
#include "vm/runtime/process_image.h"
#include "ir/bytecode/symbols.h"
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

vm::ControllerOptions small_slices() {
  vm::ControllerOptions options;
  options.fuel_slice = 50;
  return options;
}

// The slow task is interrupted twice and then stopped by a trap: what becomes safe is its own.
TEST(ProcessImage, B5_WhatAnInterruptingTaskWroteIsNotOfTheTaskBelow) {
  Plant plant(R"(
PROGRAM Fast VAR n AT %QB0 : BYTE; END_VAR n := n + 1; END_PROGRAM
PROGRAM Slow VAR q AT %QB1 : BYTE; i, zero : DINT; END_VAR
  q := 7; FOR i := 1 TO 25000 DO ; END_FOR i := i / zero;
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 0);
  {attribute 'on_trap' := 'stop_task'} TASK Low (INTERVAL := T#100ms, PRIORITY := 1);
  PROGRAM F WITH High : Fast; PROGRAM S WITH Low : Slow;
END_RESOURCE END_CONFIGURATION)",
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  ASSERT_TRUE(plant.task("Low").stopped);
  EXPECT_EQ(plant.io.output(0), 3);
  EXPECT_EQ(plant.io.output(1), 0);
}

TEST(ProcessImage, PacksBitsBytesAndWords) {
  Plant plant(R"(
PROGRAM P
VAR i0 AT %IX0.3 : BOOL; iw AT %IW1 : INT; q0 AT %QX0.0 : BOOL; q7 AT %QX0.7 : BOOL;
    qw AT %QW1 : INT; END_VAR
  q0 := i0; q7 := NOT i0; qw := iw + 1;
END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  plant.io.set_input(0, 0x08);
  plant.io.set_input(2, 0x34);
  plant.io.set_input(3, 0x12);
  plant.cycles(2);
  EXPECT_EQ(plant.get("P.i0"), "TRUE");
  EXPECT_EQ(plant.io.output(0), 0x01);
  EXPECT_EQ(plant.io.output(2), 0x35);
  EXPECT_EQ(plant.io.output(3), 0x12);
  plant.io.set_input(0, 0xf7);
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(0), 0x80);
}

// Arrays of BOOL at a bit address are packed; structures lie as they are declared, a BOOL in a
// byte.
TEST(ProcessImage, TakesArraysAndStructures) {
  Plant plant(R"(
TYPE Inputs : STRUCT ready : BOOL; code : BYTE; level : INT; END_STRUCT END_TYPE
PROGRAM P
VAR panel AT %IB4 : Inputs; lamps AT %QX10.4 : ARRAY[1..6] OF BOOL;
    speeds AT %QW20 : ARRAY[0..2] OF INT; echo AT %QB50 : ARRAY[0..1] OF Inputs; END_VAR
  lamps[1] := panel.ready; lamps[6] := TRUE; speeds[2] := panel.level;
  echo[1].ready := panel.ready; echo[1].level := panel.level + 1;
END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  plant.io.set_input(4, 0x80);
  plant.io.set_input(6, 0x34);
  plant.io.set_input(7, 0x12);
  plant.cycles(2);
  EXPECT_EQ(plant.get("P.panel.ready"), "TRUE");
  EXPECT_EQ(plant.io.output(10), 0x10);
  EXPECT_EQ(plant.io.output(11), 0x02);
  EXPECT_EQ(plant.io.output(44), 0x34);
  EXPECT_EQ(plant.io.output(45), 0x12);
  EXPECT_EQ(plant.io.output(54), 0x01);
  EXPECT_EQ(plant.io.output(56), 0x35);
  EXPECT_EQ(plant.io.output(57), 0x12);
}

// A change that takes a member away leaves a hole in the variable, but none in the process image.
TEST(ProcessImage, DoesNotDependOnTheHistoryOfALayout) {
  auto source = [](const std::string& members) {
    return "TYPE S : STRUCT " + members +
           " END_STRUCT END_TYPE PROGRAM P VAR s AT %QB0 : S; END_VAR "
           "s.b := 5; END_PROGRAM";
  };
  auto before = build(source("a : INT; gone : INT; b : INT;"));
  ASSERT_TRUE(before);
  auto after = build(source("a : INT; b : INT;"), &before->image());
  ASSERT_TRUE(after);
  const uint32_t at = ir::find_symbol(after->image(), "P.s.b")->data;
  EXPECT_EQ(at - ir::find_symbol(after->image(), "P.s.a")->data, 4u);
  EXPECT_EQ(after->image().output_bytes, 4u);
  std::vector<uint8_t> memory(after->image().data_capacity);
  memory[at] = 5;
  std::vector<uint8_t> outputs(4);
  vm::ProcessImage(after->image()).variables_to_outputs(memory.data(), outputs);
  EXPECT_EQ(outputs, (std::vector<uint8_t>{0, 0, 5, 0}));
}

constexpr const char* kSlowAndFast = R"(
PROGRAM SlowWork
VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; first : BYTE; last : BYTE; torn : DINT; i : DINT; END_VAR
  first := inp; outp := 16#AA;
  FOR i := 1 TO 2500 DO ; END_FOR
  last := inp; outp := 16#0F;
  IF first <> last THEN torn := torn + 1; END_IF
END_PROGRAM
PROGRAM FastWork
VAR inp AT %IB0 : BYTE; seen : BYTE; outp AT %QB1 : BYTE; END_VAR
  seen := inp; outp := inp;
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#1ms, PRIORITY := 0);
  TASK Slow (INTERVAL := T#5ms, PRIORITY := 1);
  PROGRAM F WITH Fast : FastWork;
  PROGRAM S WITH Slow : SlowWork;
END_RESOURCE END_CONFIGURATION
)";

TEST(ProcessImage, B3_B5_SuspendedTaskSeesOneInputAndShowsNoHalfOutput) {
  Plant plant(kSlowAndFast, small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  for (int i = 0; i < 40; ++i) {
    plant.io.set_input(0, static_cast<uint8_t>(i + 1));
    plant.cycles(1);
    char seen[8];
    std::snprintf(seen, sizeof seen, "16#%02X", i + 1);
    EXPECT_EQ(plant.get("F.seen"), seen);
    EXPECT_NE(plant.io.output(0), 0xaa) << "cycle " << i;
    if (i == 0) continue;
    EXPECT_EQ(plant.io.output(1), i) << "the fast output waits for the slow task";
  }
  EXPECT_EQ(plant.get("S.torn"), "0");
  EXPECT_GT(plant.task("Slow").scans, 5u);
  EXPECT_EQ(plant.io.output(0), 0x0f);
}

TEST(ProcessImage, ForcedInputAndOutput) {
  Plant plant(R"(
PROGRAM P VAR i0 AT %IX0.0 : BOOL; q0 AT %QX0.0 : BOOL; q1 AT %QX0.1 : BOOL; n : INT; END_VAR
  q0 := i0; q1 := FALSE; n := n + 1;
END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  ASSERT_TRUE(plant->force("P.i0", "TRUE").ok());
  ASSERT_TRUE(plant->force("P.q1", "TRUE").ok());
  ASSERT_TRUE(plant->force("P.n", "7").ok());
  EXPECT_EQ(plant->forces().size(), 3u);
  plant.cycles(3);
  EXPECT_EQ(plant.io.output(0), 0x03);
  EXPECT_EQ(plant.get("P.n"), "7");
  ASSERT_TRUE(plant->unforce("p.I0").ok());
  ASSERT_TRUE(plant->unforce("P.q1").ok());
  EXPECT_FALSE(plant->unforce("P.q1").ok());
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(0), 0x00);
}

TEST(ProcessImage, RefusesWhatCannotBeWritten) {
  Plant plant(R"(
PROGRAM P VAR CONSTANT k : INT := 3; END_VAR VAR i AT %IB0 : BYTE; n : INT; END_VAR n := k; END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant->set("P.i", "1").error().refusal, base::Refusal::kReadOnly);
  EXPECT_EQ(plant->set("P.nothing", "1").error().refusal, base::Refusal::kNoSuchVariable);
  EXPECT_EQ(plant->set("P.n", "TRUE").error().refusal, base::Refusal::kBadValue);
  EXPECT_EQ(plant->set("P.n", "40000").error().refusal, base::Refusal::kBadValue);
  EXPECT_EQ(plant->force("P.k", "1").error().refusal, base::Refusal::kReadOnly);
  EXPECT_TRUE(plant->set("P.n", "-5").ok());
  EXPECT_EQ(plant.get("P.n"), "-5");
}

// A drive would take NaN for some number; arithmetic inside may give it.
TEST(ProcessImage, NanReachesNoOutputByHand) {
  Plant plant(R"(
PROGRAM P VAR q AT %QD0 : REAL; l AT %QL8 : LREAL; n : REAL; END_VAR n := n; END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant->set("P.q", "NaN").error().refusal, base::Refusal::kBadValue);
  EXPECT_EQ(plant->force("P.q", "NaN").error().refusal, base::Refusal::kBadValue);
  EXPECT_EQ(plant->force("P.l", "NaN").error().refusal, base::Refusal::kBadValue);
  EXPECT_TRUE(plant->force("P.l", "2.5").ok());
  EXPECT_TRUE(plant->set("P.n", "NaN").ok());
}

}  // namespace
}  // namespace runtime_test
