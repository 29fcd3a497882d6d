// Programs from source through every phase: what the compiler makes, the verifier accepts
// and the interpreter runs. The language itself is tested by the golden files.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/unit/exec/machine.h"
#include "tests/unit/exec/source_image.h"

namespace {

using sample::build;

using sample::Machine;
using vm::Exit;

TEST(Source, StructuresArraysInOutsStrings) {
  Machine machine(build(R"(
TYPE Item : STRUCT name : STRING[12]; weights : ARRAY[1..3] OF INT; END_STRUCT; END_TYPE
FUNCTION Sum : DINT VAR_INPUT item : Item; END_VAR VAR i : INT; END_VAR
  FOR i := 1 TO 3 DO Sum := Sum + item.weights[i]; END_FOR;
END_FUNCTION
FUNCTION Heavier : Item VAR_INPUT item : Item; more : INT; END_VAR VAR i : INT; END_VAR
  Heavier := item;
  FOR i := 1 TO 3 DO Heavier.weights[i] := Heavier.weights[i] + more; END_FOR;
END_FUNCTION
FUNCTION_BLOCK Tagger VAR_IN_OUT item : Item; END_VAR VAR_INPUT tag : STRING[4]; END_VAR
  item.name := CONCAT(item.name, tag);
END_FUNCTION_BLOCK
PROGRAM Main VAR items : ARRAY[0..2] OF Item; tags : ARRAY[0..2] OF Tagger; i : INT; total : DINT; heavy : Item; END_VAR
  FOR i := 0 TO 2 DO
    items[i].weights[i + 1] := i * 10 + 1;
    tags[i](item := items[i], tag := 'x');
  END_FOR;
  heavy := Heavier(items[2], 5);
  total := Sum(items[1]) + Sum(heavy);
END_PROGRAM)"));
  ASSERT_TRUE(machine.good());
  ASSERT_EQ(machine.scan(), Exit::kDone) << machine.trap_text();
  ASSERT_EQ(machine.scan(), Exit::kDone) << machine.trap_text();
  EXPECT_EQ(machine.value("Main.items[1].name"), "'xx'");
  EXPECT_EQ(machine.value("Main.heavy.weights"), "[5, 5, 26]");
  EXPECT_EQ(machine.value("Main.total"), "47");
}

TEST(Source, EveryFuelGivesTheSameState) {
  const ir::Image image = build(R"(
FUNCTION Fib : DINT VAR_INPUT n : INT; END_VAR VAR a, b, t : DINT; i : INT; END_VAR
  b := 1; FOR i := 1 TO n DO t := a + b; a := b; b := t; END_FOR; Fib := a;
END_FUNCTION
FUNCTION_BLOCK Ramp VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT q : INT; END_VAR
  WHILE q MOD 7 <> 6 DO q := q + 1; END_WHILE; IF up THEN q := q + 1; END_IF;
END_FUNCTION_BLOCK
PROGRAM Main VAR r : ARRAY[1..5] OF Ramp; f : DINT; i : INT; END_VAR
  FOR i := 1 TO 5 DO r[i](up := i MOD 2 = 0); f := f + Fib(r[i].q); END_FOR;
END_PROGRAM)");
  std::vector<std::string> states;
  for (uint64_t fuel : {1u, 2u, 3u, 7u, 1000000u}) {
    Machine machine(image);
    ASSERT_TRUE(machine.good());
    for (int scan = 0; scan < 5; ++scan) {
      machine.start();
      Exit exit = Exit::kSuspended;
      while ((exit = machine.execution().run(fuel)) == Exit::kSuspended) {
      }
      ASSERT_EQ(exit, Exit::kDone) << machine.trap_text();
    }
    std::string state;
    for (const char* path : {"Main.f", "Main.r", "Main.i"}) state += machine.value(path) + " ";
    states.push_back(state);
  }
  for (const std::string& state : states) EXPECT_EQ(state, states.front());
}

TEST(Source, ATrapNamesVariableValuesFileAndLine) {
  Machine machine(
      build("PROGRAM Main VAR Speeds : ARRAY[0..9] OF INT; i : INT := 12; END_VAR\n"
            "  i := i + 0;\n"
            "  Speeds[i] := 1;\n"
            "END_PROGRAM\n"));
  ASSERT_TRUE(machine.good());
  ASSERT_EQ(machine.scan(), Exit::kTrap);
  const vm::TrapText text = vm::describe(machine.image(), machine.execution().trap());
  EXPECT_EQ(text.text, "array index outside its bounds: Speeds[12], bounds 0..9");
  EXPECT_EQ(text.file, "test.st");
  EXPECT_EQ(text.line, 3u);
}

// Twice the code takes about twice the time, not four times.
TEST(Source, VerificationIsLinear) {
  const auto time_of = [](int statements) {
    std::string body;
    for (int i = 0; i < statements; ++i) {
      body += "IF a[" + std::to_string(i % 100) +
              "] > b THEN b := b + a[c]; ELSE c := b MOD 100; END_IF;\n";
    }
    const base::Bytes bytes = ir::encode(build(
        "PROGRAM Main VAR a : ARRAY[0..99] OF INT; b, c : INT; END_VAR\n" + body + "END_PROGRAM"));
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(ir::verify(bytes).ok());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::printf("%d statements, %zu bytes: %.1f ms\n", statements, bytes.size(),
                took.count() * 1e3);
    return took.count();
  };
  time_of(500);
  const double once = time_of(4000);
  EXPECT_LT(time_of(16000), once * 4 * 5 + 0.05);
}

}  // namespace
