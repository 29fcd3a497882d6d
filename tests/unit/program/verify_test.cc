#include "ir/program/verify.h"

#include <gtest/gtest.h>

#include "base/limits.h"
#include "tests/unit/program/sample.h"

namespace ir {
namespace {

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(kSample);
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string verdict(const Program& program) {
  const base::Status status = verify(program);
  return status.ok() ? "ok" : status.error().text;
}

struct Wrong {
  std::string_view from;
  std::string_view to;
  std::string_view reason;  // part of the error
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.to; }

class WrongProgram : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongProgram, IsRefusedWithItsReason) {
  const std::string text = verdict(parse_ok(replaced(GetParam().from, GetParam().to)));
  EXPECT_NE(text.find(GetParam().reason), std::string::npos) << text;
}

const Wrong kWrongTypes[] = {
    {"subrange INT 0..100", "subrange INT 5..4", "empty range"},
    {"subrange INT 0..100", "subrange REAL 0..1", "no integer type"},
    {"const #0", "type Odd = array INT [1..0]\nconst #0", "empty dimension"},
    {"array INT [1..3, 0..1]", "array INT [0..9223372036854775807, 0..1]", "too many elements"},
    {"local speed : INT", "local speed : Motor", "contains itself"},
    {"const #0", "type Odd = function_block\nmember local a : Odd\nconst #0", "contains itself"},
    {"local speed : INT", "in_out speed : INT", "in-out outside of an instance"},
    {"local x : INT retain", "local x : Globals", "a program cannot be a member"},
    {"const #5 = {0 = #4}", "const #5 = {0 = #6}", "refers to a later constant"},
    {"const #1 = {0 = #0, 2 * 3", "const #1 = {0 = #0, 4 * 3", "element outside"},
    {"name : %25 init #3", "name : %25 init #5", "has elements"},
    {"name : %25 init #3", "name : %25 init #9", "does not exist"},
    {"type Percent = subrange INT 0..100", "type Percent = globals", "exactly one globals type"},
    {"period 3000000", "period 0", "has no period"},
    {"instance Main : Main task 0", "instance Main : Main task 2", "task that does not exist"},
    {"instance Main : Main task 0", "instance Main : Motor task 0", "no program type"},
    {"instance Main", "type Odd = program\ninstance Odd : Odd task 0\ninstance Main",
     "has no code"},
    {"pou function_block Counter", "pou program Counter", "of another kind"},
    {"local temp '' : DINT", "local temp '' : Counter", "is or holds an instance"},
    {"  local temp i : INT", "  local input i : INT", "parameter outside of a function"},
};
INSTANTIATE_TEST_SUITE_P(Types, WrongProgram, ::testing::ValuesIn(kWrongTypes));

const Wrong kWrongInstructions[] = {
    {"v2 = lt i16 v1, v0\n", "v2 = lt i16 v1\n", "number of operands"},
    {"v2 = lt i16 v1, v0", "v2 = lt i32 v1, v0", "operand of another type"},
    {"v2 = lt i16 v1, v0", "v2 = sqrt i16 v0", "not defined for its type"},
    {"branch v2, b1(v0), b2(v1)", "branch v2, b1(v0), b2", "number of block arguments"},
    {"branch v2, b1(v0), b2(v1)", "branch v2, b1(v0), b9(v1)", "block that does not exist"},
    {"branch v2, b1(v0), b2(v1)", "branch v2, b1(v0), b2(v2)", "another type than the parameter"},
    {"branch v2, b1(v0), b2(v1)", "branch v1, b1(v0), b2(v1)", "a branch takes a bool"},
    {"branch v2, b1(v0), b2(v1)", "branch v2, b1(v0)", "number of targets"},
    {"    jump b2(v3)", "    jump b2(v3)\n    return", "exactly one terminator"},
    {"    trap division-by-zero @50\n", "", "is empty"},
    {"    init local.clipped @8\n    v0", "    v1", "defined twice"},
    {"v0 = load i16 local.low", "v0 = load i32 local.low", "load of another type"},
    {"store i16 local.Limit, v8", "store i16 local.clipped, v8", "store of another type"},
    {"load i32 local.hits^", "load i32 local.hits", "without following it"},
    {"string str local.s", "string wstr local.s", "no string of that kind"},
    {"call_instance self.many[v0]", "call_instance self.x", "no function block instance"},
    {"copy self.first!.motor.name, local.s", "copy self.text, local.s", "different types"},
    {"init local.s, #3", "init self.first", "instances are not initialised"},
    {"init local.s, #3", "init local.s, #5", "has elements"},
    {"init local.s, #3", "init const(#3 : %25)", "a constant is written"},
    {"CONCAT/v:SSS v6, v7, v7", "CONCAT/v:SSS v7, v7, v7", "written into a constant"},
    {"CONCAT/v:SSS v6, v7, v7", "CONCAT/v:SSS v6, v7", "number of arguments"},
    {"CONCAT/v:SSS v6, v7, v7", "CONCAT/v:SSS v6, v7, v4", "argument of another type"},
    {"CONCAT/v:SSS v6", "#9999 v6", "no such native function"},
    {"pointee(v16 : INT)", "pointee(v16 : UINT)", "than the place says"},
    {"store addr self.many[v0]!.total, v1\n",
     "store addr self.many[v0]!.total, v1\n"
     "    v30 = address addr self.x\n    store addr self.many[v0]!.total, v30\n",
     "bound to a place of another type"},
    {"self.many[v0]!.up", "self.many[v10]!.up", "an index is no integer value"},
    {"v14 = wrap i16 v9", "v14 = round i16 v9", "no such conversion"},
    {"v15 = task_time i64", "v15 = task_time i32", "time is i64"},
};
INSTANTIATE_TEST_SUITE_P(Instructions, WrongProgram, ::testing::ValuesIn(kWrongInstructions));

const Wrong kWrongFlow[] = {
    {"    jump b2(v3)", "    jump b2(v8)", "may not be defined"},
    {"    store i16 local.Limit, v8", "    store i16 local.Limit, v3", "may not be defined"},
    {"    v6 = const i32 1\n    v7 = add i32 v5, v6", "    v7 = add i32 v5, v7",
     "may not be defined"},
    {"self.many[v0]!.total", "self.many[v3]!.total", "may not be defined"},
};
INSTANTIATE_TEST_SUITE_P(Dominance, WrongProgram, ::testing::ValuesIn(kWrongFlow));

const Wrong kWrongCalls[] = {
    {"    store i16 arg(Limit).value, v3\n", "", "argument value of Limit is not written"},
    {"    store addr arg(Limit).hits, v21\n", "", "argument hits of Limit is not written"},
    {"    call Limit\n", "    call_instance self.many[v0]\n    call Limit\n",
     "another call between"},
    {"    trap division", "    store i16 arg(Limit).low, v4\n    trap division",
     "does not follow in this block"},
    {"v5 = load i16 arg(Limit).Limit",
     "call_instance self.many[v0]\n    v5 = load i16 "
     "arg(Limit).Limit",
     "its call is not the last one"},
    {"v5 = load i16 arg(Limit).Limit", "v5 = load i16 arg(Limit).low", "no result is read"},
    {"v3 = load i16 self.many[1]!.count", "v3 = load i16 arg(Limit).Limit",
     "its call is not the last one"},
    {"store i16 arg(Limit).low, v4", "store i16 arg(Limit).Limit, v4", "written by the caller"},
    {"v17 = load", "v22 = address addr arg(Limit).low\n    v17 = load", "no lasting address"},
};
INSTANTIATE_TEST_SUITE_P(Calls, WrongProgram, ::testing::ValuesIn(kWrongCalls));

TEST(Verify, RefusesPlacesWhoseTypeIsWrong) {
  Program program = parse_ok(kSample);
  program.pous[0].places[1].type = TypeId(0);
  EXPECT_NE(verdict(program).find("but says BOOL"), std::string::npos);
  program = parse_ok(kSample);
  program.pous[0].blocks[0].insts[1].place = PlaceId(999);
  EXPECT_NE(verdict(program).find("needs a place"), std::string::npos);
  program = parse_ok(kSample);
  program.pous[0].values[0].scalar = Scalar::kI8;
  EXPECT_NE(verdict(program).find("result has another type"), std::string::npos);
}

TEST(Verify, RefusesConstantIndexOutOfBounds) {
  Program program = parse_ok(kSample);
  for (Place& place : program.pous[1].places) {
    for (Step& step : place.steps) {
      if (step.kind == StepKind::kIndex) step.constant_index += 7;
    }
  }
  EXPECT_NE(verdict(program).find("is outside ARRAY[1..3,0..1] OF INT"), std::string::npos);
}

TEST(Verify, ReadsResultsInLaterBlocks) {
  const std::string function = "pou function F\n local return r : INT\n b0:\n return\n";
  EXPECT_EQ(verdict(parse_ok(small_program("", R"(b0:
    call F
    v0 = const bool TRUE
    branch v0, b1, b2
  b1:
    v1 = load i16 arg(F).r
    return
  b2:
    jump b1
)",
                                           function))),
            "ok");
  const std::string text = verdict(parse_ok(small_program("", R"(b0:
    v0 = const bool TRUE
    branch v0, b1, b2
  b1:
    call F
    jump b2
  b2:
    v1 = load i16 arg(F).r
    return
)",
                                                          function)));
  EXPECT_NE(text.find("its call is not the last one"), std::string::npos) << text;
}

std::string verdict_on_type(const std::string& definition) {
  return verdict(parse_ok(small_program("type Odd = " + definition + "\n", "b0:\n return\n")));
}

TEST(Verify, KeepsTheLimitsOfTypes) {
  std::string dims = "[0..0";
  for (uint32_t i = 1; i < base::kMaxDimensions; ++i) {
    dims += ", 0..0";
  }
  EXPECT_EQ(verdict_on_type("array INT " + dims + "]"), "ok");
  EXPECT_NE(verdict_on_type("array INT " + dims + ", 0..0]"), "ok");
  const std::string elements = std::to_string(base::kMaxTypeBytes);
  EXPECT_EQ(verdict_on_type("array BOOL [1.." + elements + "]"), "ok");
  EXPECT_NE(verdict_on_type("array BOOL [0.." + elements + "]"), "ok");
  const std::string capacity = std::to_string(base::kMaxStringCapacity);
  EXPECT_EQ(verdict_on_type("string " + capacity), "ok");
  Program program = parse_ok(small_program("", "b0:\n return\n"));
  program.types.string(base::kMaxStringCapacity + 1);
  EXPECT_NE(verdict(program), "ok");
}

TEST(Verify, ASwitchHasATargetForEachNumber) {
  const auto verdict_of = [](const std::string& type, const std::string& rest) {
    return verdict(
        parse_ok(small_program("", "b0:\n v0 = const " + type + " 3\n switch " + type + " v0, " +
                                       rest + "\n b1:\n return\n b2:\n jump b1\n")));
  };
  EXPECT_EQ(verdict_of("i16", "-1..1, b1, b2, b1, b2"), "ok");
  EXPECT_EQ(verdict_of("u64", "2147483646..2147483647, b1, b2, b2"), "ok");
  EXPECT_NE(verdict_of("i16", "-1..1, b1, b2, b1").find("number of targets"), std::string::npos);
  const char* const why = "empty, or beyond its type or i32";
  EXPECT_NE(verdict_of("i16", "4..3, b1").find(why), std::string::npos);
  EXPECT_NE(verdict_of("u16", "-1..0, b1, b2, b1").find(why), std::string::npos);
  EXPECT_NE(verdict_of("i8", "127..128, b1, b2, b1").find(why), std::string::npos);
  EXPECT_NE(verdict_of("i64", "2147483647..2147483648, b1, b2, b1").find(why), std::string::npos);
}

TEST(Verify, FollowsLoops) {
  EXPECT_EQ(verdict(parse_ok(small_program("", R"(b0:
    v0 = const i16 0
    jump b1(v0)
  b1(v1:i16):
    v2 = add i16 v1, v0
    v3 = lt i16 v2, v1
    branch v3, b1(v2), b2
  b2:
    v4 = add i16 v2, v1
    return
)"))),
            "ok");
}

}  // namespace
}  // namespace ir
