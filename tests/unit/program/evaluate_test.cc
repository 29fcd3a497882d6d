#include "ir/program/evaluate.h"

#include <gtest/gtest.h>

#include "base/limits.h"
#include "tests/unit/program/sample.h"

namespace ir {
namespace {

constexpr uint64_t kBudget = 10'000;

uint64_t bits(const Evaluator& evaluator, std::string_view path) {
  const base::Result<uint64_t> value = evaluator.bits(path);
  EXPECT_TRUE(value.ok()) << path;
  return value.ok() ? *value : 0xdead;
}

void expect_no_trap(const std::vector<EvalTrap>& traps) {
  EXPECT_TRUE(traps.empty()) << trap_name(traps[0].kind) << " in " << traps[0].pou << " line "
                             << traps[0].line << ": " << traps[0].text;
}

std::string only_trap(const std::vector<EvalTrap>& traps) {
  EXPECT_EQ(traps.size(), 1u);
  return traps.empty() ? ""
                       : std::string(trap_name(traps[0].kind)) + " in " + traps[0].pou + " line " +
                             std::to_string(traps[0].line) + ": " + traps[0].text;
}

TEST(Evaluate, StartsWithInitialValues) {
  const Program program = verified(kSample);
  const Evaluator evaluator(program);
  const std::string state = evaluator.state();
  EXPECT_TRUE(
      state.starts_with("total=0\nlimit=-7\n%IX0.1=FALSE\nMain.first.up=FALSE\n"
                        "Main.first.count=-7\nMain.first.motor.speed=-7\n"
                        "Main.first.motor.name='a$'b'\nMain.first.motor.table[1,0]=5\n"
                        "Main.first.motor.table[1,1]=0\nMain.first.motor.table[2,0]=5\n"))
      << state;
  EXPECT_TRUE(
      state.ends_with("Main.many[1].motor.table[3,1]=0\nMain.text=\"a\xc3\xa4\"\nMain.x=0\n"
                      "Main.colour=Green\n"))
      << state;
  EXPECT_EQ(state.find("in_out"), std::string::npos);
}

// What a constant does not name takes the type's default, not that of the member
// whose initial value the constant replaces.
TEST(Evaluate, InitialValuesReplaceEachOther) {
  const Program program = verified(small_program(R"(  member global plain : Outer
  member global named : Outer init #4
  member global list : Filled init #6
  member global colour : Colour
type Inner = struct
  member local x : INT init #0
  member local y : INT init #0
type Outer = struct
  member local inner : Inner init #2
  member local z : INT
type Filled = array INT [0..3] init #5
type Colour = enum INT (Red = 3, Green = 4)
const #0 = 7
const #1 = 9
const #2 = {1 = #1}
const #3 = {0 = #1}
const #4 = {0 = #3}
const #5 = {0 * 3 = #0}
const #6 = {1 = #1}
)",
                                                 "b0:\n return\n"));
  EXPECT_EQ(Evaluator(program).state(),
            "plain.inner.x=7\nplain.inner.y=9\nplain.z=0\nnamed.inner.x=9\nnamed.inner.y=7\n"
            "named.z=0\nlist[0]=7\nlist[1]=9\nlist[2]=7\nlist[3]=0\ncolour=Red\n");
}

TEST(Evaluate, RunsTheSample) {
  const Program program = verified(kSample);
  Evaluator evaluator(program);
  // The last condition compares x with the length of s; both are 6.
  EXPECT_EQ(only_trap(evaluator.scan(0, kBudget)), "division-by-zero in Main line 50: ");
  EXPECT_EQ(bits(evaluator, "total"), 2u);  // the counter, and Limit clipped
  EXPECT_EQ(bits(evaluator, "MAIN.X"), 6u);
  EXPECT_EQ(bits(evaluator, "Main.many[1].count"), 5u);
  EXPECT_EQ(*evaluator.string("main.First.motor.name"), "a'ba'b");
}

TEST(Evaluate, AddressesVariablesByPath) {
  const Program program = verified(kSample);
  Evaluator evaluator(program);
  ASSERT_TRUE(evaluator.set_bits("Main.many[1].motor.table[3,1]", 0x12345).ok());
  EXPECT_EQ(bits(evaluator, "main.MANY[1].motor.table[3,1]"), 0x2345u);
  for (const char* path : {"", ".", "Main", "Main.", "Main.many", "Main.many[2].count",
                           "Main.many[", "Main.many[1", "Main.many[]", "Main.many[0,0].count",
                           "Main.x[0]", "Main.first.total", "Main.first.motor.table[1]", "Main.x.y",
                           "nothing", "Main.x ", "Main.many[1]count", "Main.first.motor.name"}) {
    EXPECT_FALSE(evaluator.bits(path).ok()) << path;
    EXPECT_FALSE(evaluator.set_bits(path, 1).ok()) << path;
  }
  EXPECT_FALSE(evaluator.string("Main.x").ok());
}

struct Trapping {
  std::string_view body;
  std::string_view trap;
};
void PrintTo(const Trapping& trapping, std::ostream* out) { *out << trapping.trap; }

class EvaluateTraps : public ::testing::TestWithParam<Trapping> {};

constexpr std::string_view kTrapGlobals =
    "  member global a : %26\n  member global fb : Fb\n  member global n : ULINT\n"
    "  member global after : INT\ntype %26 = array INT [-1..1]\n"
    "type Fb = function_block\n  member in_out io : INT\n";

// Precise: what stands before the trap has happened, nothing behind it.
TEST_P(EvaluateTraps, StopTheTask) {
  const std::string body = "b0:\n v90 = const i16 1\n store i16 global.after, v90\n" +
                           std::string(GetParam().body) +
                           " v91 = const i16 2\n store i16 global.after, v91\n return\n";
  const Program program =
      verified(small_program(kTrapGlobals, body, "pou function_block Fb self Fb\nb0:\n return\n"));
  Evaluator evaluator(program);
  EXPECT_EQ(only_trap(evaluator.scan(0, kBudget)), GetParam().trap);
  EXPECT_EQ(bits(evaluator, "after"), 1u);
}

const Trapping kTraps[] = {
    {" v0 = const i16 0\n v1 = div i16 v90, v0 @7\n", "division-by-zero in Main line 7: 1 / 0"},
    {" v0 = const i64 2\n v1 = load i16 global.a[v0] @3\n",
     "index in Main line 3: index 2 of ARRAY[-1..1] OF INT"},
    {" v0 = const i8 -2\n store i16 global.a[v0], v90\n",
     "index in Main line 0: index -2 of ARRAY[-1..1] OF INT"},
    {" v0 = const u64 18446744073709551615\n store i16 global.a[v0], v90\n",
     "index in Main line 0: index 18446744073709551615 of ARRAY[-1..1] OF INT"},
    {" v0 = check_range i16 v90, 2..3\n", "subrange in Main line 0: 1 outside 2..3"},
    {" v0 = const f64 1.0E+30\n v1 = round i32 v0\n",
     "conversion in Main line 0: 1000000000000000019884624838656.000000 as i32"},
    {" v0 = const i32 0\n v1 = check_step i32 v0\n", "for-step in Main line 0: BY 0"},
    {" v0 = load i16 global.fb!.io^\n", "reference in Main line 0: "},
};
INSTANTIATE_TEST_SUITE_P(All, EvaluateTraps, ::testing::ValuesIn(kTraps));

TEST(Evaluate, FuelEndsAnEndlessLoop) {
  const Program program = verified(small_program("  member global n : DINT\n", R"(b0:
    jump b1
  b1:
    v0 = load i32 global.n
    v1 = const i32 1
    v2 = add i32 v0, v1
    store i32 global.n, v2
    jump b1 @9
)"));
  Evaluator evaluator(program);
  EXPECT_EQ(only_trap(evaluator.scan(0, 101)), "fuel in Main line 0: ");
  EXPECT_EQ(bits(evaluator, "n"), 20u);
}

// What is held is read so right behind the store, until it is released.
TEST(Evaluate, HeldValuesArePutBack) {
  const Program program =
      verified(small_program("  member global n : DINT\n  member global seen : DINT\n", R"(b0:
    v0 = load i32 global.n
    v1 = const i32 1
    v2 = add i32 v0, v1
    store i32 global.n, v2
    v3 = load i32 global.n
    store i32 global.seen, v3
    return
)"));
  Evaluator evaluator(program);
  EXPECT_FALSE(evaluator.hold("missing", {}).ok());
  const uint8_t seven[] = {7, 0, 0, 0};
  ASSERT_TRUE(evaluator.hold("n", seven).ok());
  expect_no_trap(evaluator.scan(0, kBudget));
  EXPECT_EQ(bits(evaluator, "n"), 7u);
  EXPECT_EQ(bits(evaluator, "seen"), 7u);
  evaluator.release("n");
  expect_no_trap(evaluator.scan(1'000'000, kBudget));
  EXPECT_EQ(bits(evaluator, "seen"), 8u);
}

// F calls itself as often as `n` says.
TEST(Evaluate, RecursionEndsAtTheCallDepth) {
  const Program program =
      verified(small_program("  member global n : UDINT\n", "b0:\n call F\n return\n",
                             R"(pou function F
  b0:
    v0 = load u32 global.n
    v1 = const u32 1
    v2 = sub u32 v0, v1
    store u32 global.n, v2
    v3 = eq u32 v2, v1
    branch v3, b2, b1
  b1:
    call F @4
    return
  b2:
    return
)"));
  Evaluator evaluator(program);
  ASSERT_TRUE(evaluator.set_bits("n", base::kMaxCallDepth).ok());
  expect_no_trap(evaluator.scan(0, kBudget));
  ASSERT_TRUE(evaluator.set_bits("n", base::kMaxCallDepth + 1).ok());
  EXPECT_EQ(only_trap(evaluator.scan(0, kBudget)), "stack in F line 4: F");
}

TEST(Evaluate, BlockParametersChangeAtOnce) {
  const Program program = verified(small_program(
      "  member global a : INT\n  member global b : INT\n  member global n : INT\n", R"(b0:
    v0 = const i16 1
    v1 = const i16 2
    v2 = const i16 0
    jump b1(v0, v1, v2)
  b1(v3:i16, v4:i16, v5:i16):
    v6 = add i16 v5, v0
    v7 = const i16 3
    v8 = lt i16 v6, v7
    branch v8, b1(v4, v3, v6), b2
  b2:
    store i16 global.a, v3
    store i16 global.b, v4
    store i16 global.n, v6
    return
)"));
  Evaluator evaluator(program);
  expect_no_trap(evaluator.scan(0, kBudget));
  EXPECT_EQ(evaluator.state(), "a=1\nb=2\nn=3\n");
}

TEST(Evaluate, EachCallHasFreshLocals) {
  const Program program =
      verified(small_program("  member global a : INT\n  member global b : INT\n", R"(b0:
    v0 = const i16 20
    store i16 arg(F).x, v0
    call F
    v1 = load i16 arg(F).r
    store i16 global.a, v1
    store i16 arg(F).x, v0
    call F
    v2 = load i16 arg(F).r
    store i16 global.b, v2
    return
)",
                             R"(pou function F
  local input x : INT
  local return r : INT
  local temp t : INT
  b0:
    v0 = load i16 local.x
    v1 = load i16 local.t
    v2 = add i16 v0, v1
    store i16 local.t, v2
    v3 = load i16 local.r
    v4 = add i16 v2, v3
    store i16 local.r, v4
    return
)"));
  Evaluator evaluator(program);
  expect_no_trap(evaluator.scan(0, kBudget));
  EXPECT_EQ(evaluator.state(), "a=20\nb=20\n");
}

// An in-out that was bound to a variable of a frame is unbound when the frame has ended.
TEST(Evaluate, AddressOfAnEndedFrameTraps) {
  const Program program = verified(R"(program P
type G = globals
  member global fb : Fb
type Fb = function_block
  member in_out io : INT
type Main = program
globals G
task T period 1 priority 0
instance Main : Main task 0
pou function F
  local temp t : INT
  b0:
    v0 = address addr local.t
    store addr global.fb!.io, v0
    v1 = load i16 global.fb!.io^
    return
pou function_block Fb self Fb
  b0:
    return
pou program Main self Main
  b0:
    call F
    v0 = load i16 global.fb!.io^ @5
    return
)");
  Evaluator evaluator(program);
  EXPECT_EQ(only_trap(evaluator.scan(0, kBudget)), "reference in Main line 5: ");
}

TEST(Evaluate, ConstantsKeepTheirValues) {
  const Program program = verified(small_program("  member global a : INT\nconst #0 = 5\n", R"(b0:
    v0 = address addr const(#0 : INT)
    v1 = const i16 9
    store i16 pointee(v0 : INT), v1
    v2 = load i16 const(#0 : INT)
    store i16 global.a, v2
    return
)"));
  Evaluator evaluator(program);
  expect_no_trap(evaluator.scan(0, kBudget));
  EXPECT_EQ(bits(evaluator, "a"), 5u);
}

TEST(Evaluate, StringsAreCutToTheirCapacity) {
  const Program program = verified(small_program(R"(  member global s : %26 init #0
  member global t : %27 init #0
type %26 = string 3
type %27 = string 8
const #0 = 'abcdef'
)",
                                                 R"(b0:
    v0 = string str global.s
    v1 = string str global.t
    v2 = string str const(#0 : %27)
    native bool CONCAT/v:SSS v1, v2, v2
    copy global.s, global.t
    return
)"));
  Evaluator evaluator(program);
  EXPECT_EQ(evaluator.state(), "s='abc'\nt='abcdef'\n");
  expect_no_trap(evaluator.scan(0, kBudget));
  EXPECT_EQ(evaluator.state(), "s='abc'\nt='abcdefab'\n");
}

constexpr std::string_view kTasks = R"(program P
type G = globals
  member global trail : UDINT
  member global time : LTIME
type A = program
type B = program
type C = program
globals G
task Slow period 20 priority 5
task First period 10 priority 1
task Second period 10 priority 1
instance c : C task 0
instance b : B task 2
instance a1 : A task 1
instance a2 : A task 1
pou program A self A
  b0:
    v0 = load u32 global.trail
    v1 = const u32 10
    v2 = mul u32 v0, v1
    v3 = const u32 1
    v4 = add u32 v2, v3
    store u32 global.trail, v4
    v5 = task_time i64
    store i64 global.time, v5
    return
pou program B self B
  b0:
    v0 = load u32 global.trail
    v1 = const u32 10
    v2 = mul u32 v0, v1
    v3 = const u32 2
    v4 = add u32 v2, v3
    store u32 global.trail, v4
    return
pou program C self C
  b0:
    v0 = load u32 global.trail
    v1 = const u32 10
    v2 = mul u32 v0, v1
    v3 = const u32 3
    v4 = add u32 v2, v3
    store u32 global.trail, v4
    trap assert
)";

TEST(Evaluate, RunsTasksByPriorityThenDeclaration) {
  const Program program = verified(kTasks);
  Evaluator evaluator(program);
  EXPECT_EQ(only_trap(evaluator.scan(0, kBudget)), "assert in C line 0: ");
  EXPECT_EQ(bits(evaluator, "trail"), 1123u);
  expect_no_trap(evaluator.scan(10, kBudget));
  EXPECT_EQ(bits(evaluator, "trail"), 1123112u);
  EXPECT_EQ(bits(evaluator, "time"), 10u);
  expect_no_trap(evaluator.scan(15, kBudget));
  EXPECT_EQ(bits(evaluator, "trail"), 1123112u);
}

}  // namespace
}  // namespace ir
