// The native tier from source: what is inlined, hoisted and proven, what stays with the
// interpreter, what a change shares. That it does the same is shown by the golden files and random
// programs on all tiers.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/source_path.h"
#include "tests/unit/exec/machine.h"
#include "tests/unit/exec/source_image.h"
#include "vm/load/same_code.h"
#include "vm/native/make_function.h"
#include "vm/native/program.h"

namespace {

using sample::build;

// Of the functions' text: what stands behind the POU's name.
std::string function_of(const ir::Image& image, const std::string& pou) {
  const std::string all = "\n" + vm::native::functions_text(image);
  const size_t at = all.find("\n" + pou + "\n");
  EXPECT_NE(at, std::string::npos) << all;
  return all.substr(at, all.find("\n\n", at + 1) - at);
}

bool has(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

void expect_all_native(sample::Machine& machine) {
  ASSERT_TRUE(machine.good());
  const vm::native::Program& native = *machine.generation().native();
  for (uint32_t pou = 0; pou < machine.image().pous.size(); ++pou) {
    EXPECT_EQ(native.reason(pou), "");
  }
}

TEST(Native, AChecksThatCountedLoopsProveAreGone) {
  const std::string text = function_of(build(R"(
PROGRAM Main VAR a : ARRAY[0..9] OF INT; i : INT; s : INT; END_VAR
  FOR i := 0 TO 9 DO s := s + a[i]; END_FOR;
END_PROGRAM)"),
                                       "Main");
  EXPECT_FALSE(has(text, ">=u")) << text;         // no bound is checked in the loop,
  EXPECT_TRUE(has(text, "exitif.2 <s")) << text;  // but where it begins, what an interruption left
  const std::string other = function_of(build(R"(
PROGRAM Main VAR a : ARRAY[0..9] OF INT; i : INT; s : INT; END_VAR
  FOR i := 0 TO 10 DO s := s + a[i]; END_FOR;
END_PROGRAM)"),
                                        "Main");
  EXPECT_TRUE(has(other, ">=u")) << other;
}

TEST(Native, SmallBodiesAreInlinedAndLargeOnesCalled) {
  const char* const source = R"(
FUNCTION_BLOCK Counter VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT n : INT; END_VAR
  IF up THEN n := n + 1; END_IF;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Loops VAR i, n : INT; END_VAR
  FOR i := 1 TO 3 DO n := n + i; END_FOR;
END_FUNCTION_BLOCK
PROGRAM Main VAR c : ARRAY[1..2] OF Counter; l : Loops; END_VAR
  c[1](up := TRUE); l();
END_PROGRAM)";
  const std::string text = function_of(build(source), "Main");
  EXPECT_TRUE(has(text, "enter.0")) << text;
  EXPECT_TRUE(has(text, "call.0")) << text;
}

TEST(Native, ThePousItHasNoCodeForAreNamedWithTheReason) {
  const ir::Image image = build(R"(
PROGRAM Main VAR a, b : INT; END_VAR
  __TRY a := a / b; __CATCH b := 1; __ENDTRY
END_PROGRAM)");
  sample::Machine machine(image);
  ASSERT_TRUE(machine.good());
  const vm::native::Program* const native = machine.generation().native();
  if (native == nullptr) GTEST_SKIP() << "no native tier on this machine";
  EXPECT_EQ(native->reason(0), "it has __TRY");
  EXPECT_EQ(native->native_pous(), image.pous.size() - 1);
}

// What a caller stores into an instance is known inside of the body and need not be loaded.
TEST(Native, InputsOfInlinedBodiesAreNotLoadedAgain) {
  const std::string text = function_of(build(R"(
FUNCTION_BLOCK Both VAR_INPUT a, b : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR
  q := a AND b;
END_FUNCTION_BLOCK
PROGRAM Main VAR f : Both; x, y, z : BOOL; END_VAR
  f(a := x, b := y, q => z);
END_PROGRAM)"),
                                       "Main");
  EXPECT_TRUE(has(text, "enter.0")) << text;
  EXPECT_FALSE(has(text, "load.1 [context")) << text;
}

// Nothing lives in registers across a call, so nothing leaves a loop that has one.
TEST(Native, NothingIsMovedOutOfALoopThatCalls) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  sample::Machine machine(build(R"(
TYPE Row : STRUCT a, b, c : LINT; END_STRUCT; END_TYPE
FUNCTION Sum : INT VAR_INPUT n : INT; END_VAR VAR k : INT; END_VAR
  FOR k := 1 TO n DO Sum := Sum + k; END_FOR;
END_FUNCTION
PROGRAM Main VAR i, n : INT; row : Row; END_VAR
  FOR i := 1 TO 3 DO
    n := n + Sum(i);
    row := (a := 5, b := 6, c := 7);
  END_FOR;
END_PROGRAM)"));
  expect_all_native(machine);
}

TEST(Native, WhatOnlyAnOuterLoopReadsLivesThroughTheInnerOne) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  sample::Machine machine(build(R"(
PROGRAM Main VAR i, j, a, x, y : DINT; END_VAR
  FOR i := 1 TO 3 DO
    x := x + a * i;
    FOR j := 1 TO 3 DO y := y + j; END_FOR;
  END_FOR;
END_PROGRAM)"));
  expect_all_native(machine);
}

// Left in the middle of a body that stands in the place of a call, an execution is in machine code
// again at the loop's next turn, and in a straight line after one call of 32 that is one.
TEST(Native, AnInterruptedExecutionIsSoonInMachineCodeAgain) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const std::string block = R"(
FUNCTION_BLOCK Small VAR_INPUT a : DINT; END_VAR VAR_OUTPUT n : DINT; END_VAR n := n + a; END_FUNCTION_BLOCK
PROGRAM Main VAR f : Small; i : DINT; END_VAR
)";
  std::string line;
  for (int i = 0; i < 500; ++i) line += "f(a := 1);\n";
  const std::string bodies[] = {"FOR i := 1 TO 500 DO f(a := 1); END_FOR;", line};
  for (const std::string& body : bodies) {
    sample::Machine machine(build(block + body + "END_PROGRAM"));
    ASSERT_TRUE(machine.good());
    machine.start();
    ASSERT_EQ(machine.execution().run(20), vm::Exit::kSuspended);
    const uint64_t before = machine.execution().machine_entries();
    ASSERT_EQ(machine.execution().run(1'000'000), vm::Exit::kDone);
    EXPECT_EQ(machine.value("Main.f.n"), "500");
    EXPECT_LT(machine.execution().machine_entries() - before, 50u) << body.substr(0, 40);
  }
}

TEST(Native, AValueThatABranchAsksForAndOneWayTakesIsThere) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  sample::Machine machine(build(R"(
FUNCTION Largest : REAL VAR_INPUT a, b : REAL; END_VAR VAR best : REAL; END_VAR
  best := a;
  IF b > best THEN best := b; END_IF
  Largest := best;
END_FUNCTION
PROGRAM Main VAR r : REAL; i : INT; END_VAR
  FOR i := 1 TO 3 DO r := Largest(r, INT_TO_REAL(i)); END_FOR;
END_PROGRAM)"));
  expect_all_native(machine);
  EXPECT_EQ(machine.scan(), vm::Exit::kDone);
  EXPECT_EQ(machine.value("Main.r"), "3.0");
}

// The golden files of the native tier would pass as well if it gave their POUs up.
TEST(Native, GoldenFilesOfTheNativeTierAreNotInterpreted) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  uint32_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(tests::source_path("tests/golden/run"))) {
    if (!entry.path().filename().string().starts_with("native_")) continue;
    std::ifstream in(entry.path());
    const std::string source(std::istreambuf_iterator<char>(in), {});
    sample::Machine machine(build(source));
    ASSERT_TRUE(machine.good()) << entry.path();
    const vm::native::Program& native = *machine.generation().native();
    for (uint32_t pou = 0; pou < machine.image().pous.size(); ++pou) {
      if (native.reason(pou) == "it has __TRY") continue;
      EXPECT_EQ(native.reason(pou), "") << entry.path() << " " << machine.image().pous[pou].name;
    }
    ++files;
  }
  EXPECT_GE(files, 10u);
}

// Unchanged code stays where it is; a POU whose inlined callee changed is made anew.
TEST(Native, AChangeMakesOnlyWhatItTouches) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const auto source = [](const char* step) {
    return std::string(R"(
FUNCTION_BLOCK Small VAR_OUTPUT n : INT; END_VAR n := n + )") +
           step + R"(; END_FUNCTION_BLOCK
FUNCTION_BLOCK Other VAR i, n : INT; END_VAR FOR i := 1 TO 3 DO n := n + i; END_FOR; END_FUNCTION_BLOCK
PROGRAM Main VAR s : Small; END_VAR s(); END_PROGRAM
PROGRAM Second VAR o : Other; END_VAR o(); END_PROGRAM)";
  };
  const ir::Image first = build(source("1"));
  const ir::Image second = build(source("2"), &first);
  vm::Memory memory = *vm::Memory::reserve();
  auto slots = std::make_shared<vm::CodeSlots>(1 << 20);
  auto one =
      vm::Generation::build(*ir::verify(ir::encode(first)), 0, memory.data(), slots, nullptr);
  ASSERT_TRUE(one.ok());
  auto two =
      vm::Generation::build(*ir::verify(ir::encode(second)), 1, memory.data(), slots, one->get());
  ASSERT_TRUE(two.ok());
  EXPECT_GT((*two)->native()->code_bytes(), (*one)->native()->code_bytes());  // both memories
  for (uint32_t i = 0; i < second.pous.size(); ++i) {
    const std::string& name = second.pous[i].name;
    const bool same = (*one)->pous()[i].machine == (*two)->pous()[i].machine;
    EXPECT_EQ(same, name == "Other" || name == "Second") << name;
  }
}

// The place of a constant may be given to another one: whoever names it is made anew, and nobody
// else is looked at.
TEST(Native, AConstantThatChangesMakesWhoNamesItAnew) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const ir::Image first = build(R"(
FUNCTION_BLOCK Small VAR_OUTPUT n : LREAL; END_VAR n := n + 1.25; END_FUNCTION_BLOCK
FUNCTION_BLOCK Other VAR i : INT; n : LREAL; END_VAR
  FOR i := 1 TO 3 DO n := n + 2.75; END_FOR;
END_FUNCTION_BLOCK
PROGRAM Main VAR s : Small; END_VAR s(); END_PROGRAM
PROGRAM Second VAR o : Other; END_VAR o(); END_PROGRAM)");
  for (const double constant : {1.25, 2.75}) {
    ir::Image second = first;
    uint8_t bytes[sizeof constant];
    std::memcpy(bytes, &constant, sizeof bytes);
    const auto at =
        std::search(second.pool.begin(), second.pool.end(), bytes, bytes + sizeof bytes);
    ASSERT_NE(at, second.pool.end());
    at[6] ^= 1;
    vm::Memory memory = *vm::Memory::reserve();
    auto slots = std::make_shared<vm::CodeSlots>(1 << 20);
    const auto before = ir::verify(ir::encode(first));
    auto one = vm::Generation::build(*before, 0, memory.data(), slots, nullptr);
    ASSERT_TRUE(one.ok());
    auto two =
        vm::Generation::build(*ir::verify(ir::encode(second)), 1, memory.data(), slots, one->get());
    ASSERT_TRUE(two.ok());
    EXPECT_TRUE(vm::stand_on_the_same((*one)->image(), (*two)->image()));
    for (uint32_t i = 0; i < second.pous.size(); ++i) {
      const std::string& name = second.pous[i].name;
      const bool same = (*one)->pous()[i].machine == (*two)->pous()[i].machine;
      const bool small = name == "Small" || name == "Main";  // where it is inlined
      EXPECT_EQ(same, constant == 1.25 ? !small : name != "Other") << name << " " << constant;
    }
  }
}

TEST(Native, InstancesInsideAreReachedAsOwnVariables) {
  const std::string blocks = R"(
FUNCTION_BLOCK Small VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK Holder VAR s : Small; x : INT; END_VAR s(); x := s.n; END_FUNCTION_BLOCK
)";
  const ir::Image one = build(blocks + R"(
PROGRAM Main VAR a : ARRAY[1..9] OF Small; s : Small; h : Holder; i : INT; END_VAR
  FOR i := 1 TO 9 DO a[i](); END_FOR; s(); h(); i := s.n + a[3].n;
END_PROGRAM)");
  for (const char* pou : {"Main", "Holder"}) {
    const std::string text = function_of(one, pou);
    EXPECT_FALSE(has(text, "instance.")) << text;
  }
  // Global ones, those of a reference, and those that lie differently are looked for.
  const std::string text = function_of(build(blocks + R"(
VAR_GLOBAL g : Small; END_VAR
PROGRAM Main VAR x : INT; END_VAR g(); x := g.n; END_PROGRAM)"),
                                       "Main");
  EXPECT_TRUE(has(text, "instance.")) << text;
}

TEST(Native, AMovedInstanceIsFoundByNewCode) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const auto source = [](const char* more) {
    return std::string("FUNCTION_BLOCK Small VAR_OUTPUT n : INT; END_VAR VAR ") + more +
           R"( END_VAR n := n + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK Other VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR s : Small; x : INT; END_VAR x := s.n; END_PROGRAM
PROGRAM Second VAR o : Other; x : INT; END_VAR x := o.n; END_PROGRAM)";
  };
  const ir::Image first = build(source(""));
  const ir::Image second = build(source("more : ARRAY[1..5000] OF LINT;"), &first);
  vm::Memory memory = *vm::Memory::reserve();
  auto slots = std::make_shared<vm::CodeSlots>(1 << 20);
  auto one =
      vm::Generation::build(*ir::verify(ir::encode(first)), 0, memory.data(), slots, nullptr);
  ASSERT_TRUE(one.ok());
  auto two =
      vm::Generation::build(*ir::verify(ir::encode(second)), 1, memory.data(), slots, one->get());
  ASSERT_TRUE(two.ok());
  for (uint32_t i = 0; i < second.pous.size(); ++i) {
    const std::string& name = second.pous[i].name;
    const bool same = (*one)->pous()[i].machine == (*two)->pous()[i].machine;
    EXPECT_EQ(same, name != "Main") << name;
  }
}

// W^X: no memory can be written and executed.
TEST(Native, NothingIsWritableAndExecutable) {
  sample::Machine machine(build("PROGRAM Main VAR a : INT; END_VAR a := a + 1; END_PROGRAM"));
  ASSERT_TRUE(machine.good());
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    EXPECT_FALSE(has(line, " rwx")) << line;
  }
}

}  // namespace
