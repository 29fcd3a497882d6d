// Loops that do several turns at once: wherever fuel ends or a check fails, memory and fuel are as
// the interpreter has them.
#include <gtest/gtest.h>

#include "tests/unit/exec/source_image.h"
#include "tests/unit/exec/stops.h"
#include "vm/native/make_function.h"
#include "vm/native/program.h"

namespace {

using sample::build;
using sample::Optimised;
using sample::stops;

void compare(const std::string& source) {
  for (const Optimised optimised : {Optimised::kNo, Optimised::kYes}) {
    const ir::Image image = build(source, nullptr, optimised);
    for (const uint64_t slice :
         {1, 2, 3, 4, 5, 7, 8, 9, 12, 15, 16, 17, 18, 31, 33, 100, 100'000}) {
      EXPECT_EQ(stops(image, {.tier = vm::Tier::kInterpreter}, slice),
                stops(image, {.tier = vm::Tier::kNative}, slice))
          << slice << source;
    }
  }
}

bool takes_turns(const std::string& source) {
  const std::string text = vm::native::functions_text(build(source, nullptr, Optimised::kYes));
  return text.find("take fuel") != std::string::npos;
}

constexpr const char* kSum = R"(
PROGRAM Main VAR a : ARRAY[0..99] OF DINT; i, s : DINT; END_VAR
  FOR i := 0 TO 99 DO a[i] := a[i] + i; s := s * 3 + a[i]; END_FOR;
END_PROGRAM)";

TEST(NativeTurns, SmallCountedLoopsTakeSeveralTurns) {
  EXPECT_TRUE(takes_turns(kSum));
  EXPECT_FALSE(takes_turns(R"(
PROGRAM Main VAR i, s : DINT; END_VAR FOR i := 0 TO 2 DO s := s * 3 + i; END_FOR; END_PROGRAM)"))
      << "few turns are not worth it";
  EXPECT_FALSE(takes_turns(R"(
PROGRAM Main VAR s : DINT; END_VAR WHILE s < 100 DO s := s * 3 + 1; END_WHILE; END_PROGRAM)"))
      << "nobody knows how many turns there are";
  EXPECT_FALSE(takes_turns(R"(
PROGRAM Main VAR a : ARRAY[0..99] OF DINT; i, s : DINT; END_VAR
  FOR i := 0 TO 99 DO IF a[i] > 7 THEN EXIT; END_IF; s := s * 3 + i; END_FOR; END_PROGRAM)"))
      << "it may end in the middle";
}

TEST(NativeTurns, MemoryAndFuelAreRightWhereverFuelEnds) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  compare(kSum);
  compare(R"(
PROGRAM Main VAR a : ARRAY[-50..49] OF INT; i : SINT; s : LREAL; END_VAR
  FOR i := 49 TO -50 BY -3 DO a[i] := a[i] + i; s := s * 0.5 + INT_TO_LREAL(a[i]); END_FOR;
END_PROGRAM)");
  compare(R"(
PROGRAM Main VAR a, b : ARRAY[0..7, 0..15] OF INT; i, j, s, n : INT; END_VAR
  n := (n + 5) MOD 16;
  FOR i := 0 TO 7 DO
    FOR j := 0 TO n DO a[i, j] := b[i, n] + j; b[i, j] := a[i, n] * 3; s := s + a[i, j]; END_FOR;
  END_FOR;
END_PROGRAM)");
  compare(R"(
PROGRAM Main VAR a : ARRAY[1..40] OF DINT; i : INT; s, low : DINT; END_VAR
  low := low - 3;
  FOR i := 1 TO 40 DO
    a[i] := a[i] + i - 20;
    IF a[i] < low THEN s := s + low; ELSIF a[i] > 9 THEN s := s + 9; ELSE s := s + a[i]; END_IF;
    s := s * 3 + i;
  END_FOR;
END_PROGRAM)");
  compare(R"(
PROGRAM Main VAR i, k : LINT; s : LINT; END_VAR
  FOR i := 9223372036854775700 TO 9223372036854775800 BY 7 DO k := k + i; END_FOR;
  FOR i := -9223372036854775700 TO -9223372036854775800 BY -7 DO s := s + i; END_FOR;
END_PROGRAM)");
  compare(R"(
PROGRAM Main VAR i, s, last : SINT; END_VAR
  last := last + 60;
  FOR i := -128 TO last DO s := s * 5 + i; END_FOR;
  FOR i := 120 TO 126 DO s := s * 5 + i; END_FOR;
END_PROGRAM)");
  compare(R"(
TYPE Pair : STRUCT a : INT; b : LINT; END_STRUCT END_TYPE
VAR_GLOBAL p : ARRAY[1..40] OF Pair; END_VAR
FUNCTION Sum : LINT VAR i : INT; END_VAR
  FOR i := 1 TO 40 DO p[i].b := p[i].b + i; Sum := Sum * 3 + p[i].b + p[i].a; END_FOR;
END_FUNCTION
PROGRAM Main VAR s : LINT; END_VAR s := s + Sum(); END_PROGRAM)");
}

TEST(NativeTurns, AnInterruptedLoopFindsAllOfAValueThatAVariableHasAPartOf) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  compare(R"(
FUNCTION Parts : UDINT VAR_INPUT n : UDINT; END_VAR
VAR a : ARRAY[0..19] OF BYTE; i : INT; s : UDINT; part : UINT; END_VAR
  s := 16#A13BC790 + n;
  part := UDINT_TO_UINT(s);
  FOR i := 0 TO 9 DO a[i] := UINT_TO_BYTE(part); END_FOR;
  Parts := s + part + a[3];
END_FUNCTION
PROGRAM Main VAR r, n : UDINT; END_VAR n := n + 1; r := r + Parts(n); END_PROGRAM)");
}

TEST(NativeTurns, ACheckThatFailsInOneOfThemGivesBackTheOthersFuel) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const auto divides = [](int zero) {
    return "PROGRAM Main VAR a : ARRAY[0..63] OF DINT; i, s, n : DINT; zero : DINT := " +
           std::to_string(zero) + R"(; END_VAR
  n := n + 1;
  FOR i := 0 TO 63 DO a[i] := n + i; s := s + 1000 / (i - zero); END_FOR;
END_PROGRAM)";
  };
  EXPECT_TRUE(takes_turns(divides(9)));
  for (int zero = 0; zero < 20; ++zero) compare(divides(zero));
  compare(R"(
PROGRAM Main VAR a : ARRAY[0..63] OF DINT; i, s, n : DINT; END_VAR
  n := n + 11;
  FOR i := 0 TO 50 DO a[i + n] := s; s := s + a[i * 2 MOD 64] + i; END_FOR;
END_PROGRAM)");
}

}  // namespace
