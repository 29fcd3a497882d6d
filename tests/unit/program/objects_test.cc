// Methods, bases, virtual calls and caught traps in the IR: text, verification, evaluation.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "ir/program/evaluate.h"
#include "tests/unit/program/objects_sample.h"
#include "tests/unit/program/sample.h"

namespace ir {
namespace {

constexpr uint64_t kBudget = 10'000;

Program objects(std::string_view globals, std::string_view body, std::string_view more = "") {
  return verified(object_program(globals, body, kObjectOverrides, more));
}

std::string state_after_scan(const Program& program) {
  Evaluator evaluator(program);
  const std::vector<EvalTrap> traps = evaluator.scan(0, kBudget);
  std::string text = evaluator.state();
  for (const EvalTrap& trap : traps) text += std::string("trap ") + trap_name(trap.kind) + "\n";
  return text;
}

void expect_state(const Program& program, std::initializer_list<std::string_view> lines) {
  const std::string state = "\n" + state_after_scan(program);
  for (const std::string_view line : lines) {
    EXPECT_NE(state.find("\n" + std::string(line) + "\n"), std::string::npos)
        << line << " is not in\n"
        << state;
  }
}

std::string refusal(std::string_view text) {
  const base::Result<Program> program = parse_program(text);
  if (!program.ok()) return program.error().text;
  const base::Status status = verify(*program);
  return status.ok() ? "verified" : status.error().text;
}

void expect_refused(const std::string& text, std::string_view reason) {
  EXPECT_NE(refusal(text).find(reason), std::string::npos) << refusal(text) << "\nnot " << reason;
}

constexpr std::string_view kAllCalls = R"(b0:
    v0 = const i32 2
    store i32 self.leaf!.step, v0
    call_instance self.leaf
    store i32 arg('Base.twice').x, v0
    call_method 'Base.twice', self.leaf
    v1 = load i32 arg('Base.twice').r
    store i32 global.seen, v1
    store i32 arg('Base.add').x, v0
    call_method 'Base.add', self.base
    call_method 'Main.Reset'
    return
)";
constexpr std::string_view kResetAction = R"(pou method 'Main.Reset' self Main
  b0:
    v0 = const i32 3
    store i32 self.middle!.total, v0
    return
)";

TEST(IrObjects, TextSurvivesPrintAndParse) {
  const Program program = objects("  member global seen : DINT\n", kAllCalls, kResetAction);
  const std::string text = print(program);
  EXPECT_EQ(print(parse_ok(text)), text);
  EXPECT_NE(text.find("type Leaf = function_block extends Middle implements Adder, Wide"),
            std::string::npos);
  EXPECT_NE(text.find("override Leaf : 'Base.add' = 'Middle.add'"), std::string::npos);
}

TEST(IrObjects, FindsOverridesByNameAndChain) {
  const Program program = objects("  member global ref : ULINT\n", R"(b0:
    v0 = load u64 global.ref
    v1 = const i32 1
    store i32 arg('Adder.add').x, v1
    call_virtual 'Adder.add', v0
    return
)");
  EXPECT_EQ(find_overrides(program), program.overrides);
}

// leaf: 1 (Base body) + 2 (step) = 3; twice(2) adds Middle's 10 * 2 two times.
TEST(IrObjects, CallsBasesOverridesAndActions) {
  expect_state(objects("  member global seen : DINT\n", kAllCalls, kResetAction),
               {"seen=40", "Main.leaf.total=43", "Main.leaf.extra=7", "Main.base.total=2",
                "Main.middle.total=3"});
}

constexpr std::string_view kReferences =
    "  member global seen : DINT\n"
    "  member global ref : ULINT\n"
    "  member global leaf : BOOL\n"
    "  member global adder : BOOL\n"
    "  member global other : BOOL\n"
    "  member global null : BOOL\n";
constexpr std::string_view kGiveReference = R"(pou method 'Leaf.me' self Leaf
  local return r : ULINT
  b0:
    v0 = this u64
    store u64 local.r, v0
    return
)";

TEST(IrObjects, ReferencesAreTestedAndCalled) {
  expect_state(objects(kReferences, R"(b0:
    call_method 'Leaf.me', self.leaves[2]
    v0 = load u64 arg('Leaf.me').r
    store u64 global.ref, v0
    v1 = is_type bool v0, Leaf
    store bool global.leaf, v1
    v2 = is_type bool v0, Adder
    store bool global.adder, v2
    v3 = is_type bool v0, Other
    store bool global.other, v3
    v4 = const u64 0
    v5 = is_type bool v4, Leaf
    store bool global.null, v5
    call_reference v0, Base
    v6 = const i32 4
    store i32 arg('Adder.add').x, v6
    call_virtual 'Adder.add', v0
    v7 = load i32 arg('Adder.add').r
    store i32 global.seen, v7
    store i32 arg('Base.add').x, v6
    call_method 'Base.add', v0
    return
)",
                       kGiveReference),
               // IDs: Main 1, base, middle, leaf, leaves[1..3]; segment 1 + 6.
               {"ref=30064771072", "leaf=TRUE", "adder=TRUE", "other=FALSE", "null=FALSE",
                "seen=40", "Main.leaves[2].total=45", "Main.leaves[2].extra=7"});
}

TEST(IrObjects, ReferencesToNothingTrap) {
  for (const char* call :
       {"call_reference v0, Base", "store i32 arg('Base.add').x, v1\n call_virtual 'Base.add', v0",
        "store i32 arg('Base.add').x, v1\n call_method 'Base.add', v0"}) {
    for (const char* reference : {"0", "4294967296", "8589934593", "429496729600"}) {
      expect_state(objects(kReferences, "b0:\n v0 = const u64 " + std::string(reference) +
                                            "\n v1 = const i32 1\n " + call + "\n return\n"),
                   {"trap reference"});
    }
  }
}

TEST(IrObjects, ProgramsAreReachedThroughTheGlobals) {
  const Program program = verified(R"(program P
type G = globals
  member global Second : Second
  member global seen : INT
type Main = program
type Second = program
  member local runs : INT
globals G
task T period 1000000 priority 0
instance Main : Main task 0
instance Second : Second task 0
pou program Main self Main
  b0:
    call_instance global.Second
    v0 = load i16 global.Second!.runs
    store i16 global.seen, v0
    return
pou program Second self Second
  b0:
    v0 = load i16 self.runs
    v1 = const i16 1
    v2 = add i16 v0, v1
    store i16 self.runs, v2
    return
)");
  EXPECT_EQ(state_after_scan(program), "seen=1\nSecond.runs=2\n");
}

TEST(IrObjects, StartTasksRunOnceBeforeTheFirstScan) {
  const Program program = verified(R"(program P
type G = globals
  member global n : INT
type Init = program
type Main = program
globals G
task Start once priority 0
task T period 1000000 priority 0
instance __START : Init task 0
instance Main : Main task 1
pou program Init self Init
  b0:
    v0 = const i16 100
    store i16 global.n, v0
    trap assert
pou program Main self Main
  b0:
    v0 = load i16 global.n
    v1 = const i16 1
    v2 = add i16 v0, v1
    store i16 global.n, v2
    return
)");
  EXPECT_EQ(print(parse_ok(print(program))), print(program));
  Evaluator evaluator(program);
  EXPECT_EQ(evaluator.state(), "n=100\n");
  EXPECT_EQ(evaluator.scan(0, kBudget).size(), 1u);
  EXPECT_EQ(evaluator.scan(1000000, kBudget).size(), 0u);
  EXPECT_EQ(evaluator.state(), "n=102\n");
}

// --- caught traps ----------------------------------------------------------------

constexpr std::string_view kTryGlobals =
    "  member global n : DINT\n  member global kind : UDINT\n"
    "  member global zero : DINT\n";

TEST(IrTry, HandlerSeesEveryStoreBeforeTheTrap) {
  expect_state(objects(kTryGlobals, R"(b0:
    try b1, b3
  b1 handler b3:
    v0 = const i32 5
    store i32 global.n, v0
    v1 = load i32 global.zero
    v2 = div i32 v0, v1
    store i32 global.n, v2
    jump b2
  b2 handler b3:
    end_try b4
  b3:
    v3 = trap_kind u32
    store u32 global.kind, v3
    jump b4
  b4:
    return
)"),
               {"n=5", "kind=0"});
}

TEST(IrTry, NestedTriesAndTrapsOfCallees) {
  const std::string deep = R"(pou function Deep
  local input x : DINT
  local return r : DINT
  b0:
    init local.r
    v0 = load i32 local.x
    store i32 global.n, v0
    trap assert
)";
  expect_state(objects(kTryGlobals, R"(b0:
    try b1, b5
  b1 handler b5:
    try b2, b3
  b2 handler b3:
    v0 = const i32 9
    store i32 arg(Deep).x, v0
    call Deep
    end_try b4
  b3 handler b5:
    v1 = trap_kind u32
    store u32 global.kind, v1
    trap index
  b4 handler b5:
    end_try b6
  b5:
    v2 = trap_kind u32
    v3 = load u32 global.kind
    v4 = const u32 100
    v5 = mul u32 v3, v4
    v6 = add u32 v5, v2
    store u32 global.kind, v6
    jump b6
  b6:
    return
)",
                       deep),
               {"n=9", "kind=1101"});
}

TEST(IrTry, FuelIsNeverCaught) {
  expect_state(objects(kTryGlobals, R"(b0:
    try b1, b2
  b1 handler b2:
    jump b1
  b2:
    v0 = const i32 1
    store i32 global.n, v0
    return
)"),
               {"n=0", "trap fuel"});
}

TEST(IrTry, TriesMustNest) {
  const auto refused = [](std::string_view body, std::string_view reason) {
    expect_refused(object_program(kTryGlobals, body), reason);
  };
  refused("b0:\n try b1, b2\nb1 handler b2:\n return\nb2:\n return\n", "a try is open");
  refused("b0:\n try b1, b2\nb1 handler b2:\n jump b2\nb2:\n return\n", "leads into a try, or out");
  refused("b0:\n jump b1\nb1 handler b2:\n end_try b2\nb2:\n return\n", "leads into a try");
  refused("b0:\n end_try b1\nb1:\n return\n", "no try is open");
  refused("b0:\n try b1, b2\nb1:\n return\nb2:\n return\n", "another handler");
  refused("b0:\n try b1, b1\nb1 handler b1:\n end_try b1\n", "circle");
  refused("b0 handler b1:\n end_try b1\nb1:\n return\n", "entry block has a handler");
  refused("b0:\n try b1, b9\nb1 handler b9:\n end_try b1\n", "does not exist");
  refused(
      "b0:\n v0 = const i32 1\n try b1, b2(v0)\nb1 handler b2:\n end_try b3\n"
      "b2(v1:i32):\n jump b3\nb3:\n return\n",
      "a handler has parameters");
  // A value of the body may not exist when the trap comes.
  refused(
      "b0:\n try b1, b2\nb1 handler b2:\n v0 = load i32 global.n\n end_try b3\n"
      "b2:\n store i32 global.n, v0\n jump b3\nb3:\n return\n",
      "may not be defined");
}

std::string nested_tries(uint32_t depth) {
  std::string body = "b0:\n try b1, b" + std::to_string(depth + 1) + "\n";
  const auto handler = [depth](uint32_t level) { return "b" + std::to_string(depth + level); };
  for (uint32_t i = 1; i <= depth; ++i) {
    const std::string end = i < depth ? "try b" + std::to_string(i + 1) + ", " + handler(i + 1)
                                      : std::string("trap assert");
    body += "b" + std::to_string(i) + " handler " + handler(i) + ":\n " + end + "\n";
  }
  for (uint32_t i = 1; i <= depth; ++i) {
    body +=
        handler(i) + (i == 1 ? ":\n return\n" : " handler " + handler(i - 1) + ":\n trap index\n");
  }
  return body;
}

TEST(IrTry, kMaxTryDepthIsTheLimit) {
  EXPECT_EQ(refusal(object_program(kTryGlobals, nested_tries(base::kMaxTryDepth))), "verified");
  expect_refused(object_program(kTryGlobals, nested_tries(base::kMaxTryDepth + 1)), "too deeply");
}

// --- what is refused ---------------------------------------------------------------

TEST(IrObjects, TypesMustInheritWhatTheirBaseHas) {
  const auto with_types = [](std::string_view types) {
    return "program P\ntype G = globals\n" + std::string(types) +
           "type Main = program\nglobals G\ntask T period 1 priority 0\n";
  };
  const auto refused = [&](std::string_view types, std::string_view reason) {
    expect_refused(with_types(types), reason);
  };
  refused("type A = function_block\n member local x : INT\ntype B = function_block extends A\n",
          "members of the base are missing");
  refused(
      "type A = function_block\n member local x : INT\n"
      "type B = function_block extends A\n member local x : DINT\n",
      "not those of its base");
  refused("type A = function_block extends A\n", "extends itself");
  refused("type A = struct\ntype B = function_block extends A\n", "no function block");
  refused("type A = struct\ntype B = function_block implements A\n", "no interface");
  refused(
      "type I = interface\ntype J = interface implements I\n"
      "type B = function_block implements J\n",
      "leave out an inherited one");
  refused("type I = interface implements I\n", "leave out an inherited one");
  refused("type I = interface\ntype S = struct\n member local i : I\n", "cannot be a member");
}

TEST(IrObjects, OverridesMustFit) {
  const auto refused = [](std::string_view overrides, std::string_view reason) {
    expect_refused(object_program("", "b0:\n return\n", overrides), reason);
  };
  refused("override Other : 'Base.add' = 'Base.add'\n", "has not both methods");
  refused("override Base : 'Base.add' = 'Middle.add'\n", "has not both methods");
  refused("override Leaf : 'Adder.add' = 'Adder.add'\n", "has not both methods");
  refused("override Leaf : Base = 'Base.add'\n", "no method");
  refused("override Adder : 'Adder.add' = 'Adder.add'\n", "no block");
  refused("override Leaf : 'Base.add' = 'Base.add'\noverride Leaf : 'Base.add' = 'Middle.add'\n",
          "out of order");
  expect_refused(object_program("", "b0:\n return\n", "override Leaf : 'Base.add' = 'Leaf.add'\n",
                                "pou method 'Leaf.add' self Leaf\n local input x : INT\n"
                                " local return r : DINT\n b0:\n init local.r\n return\n"),
                 "their parameters differ");
}

TEST(IrObjects, CallsMustFit) {
  const auto refused = [](std::string_view body, std::string_view reason) {
    expect_refused(object_program("", "b0:\n" + std::string(body) + " return\n"), reason);
  };
  refused(" call_method 'Base.add'\n", "own instance has no such method");
  refused(" call_method 'Base.add', self.other\n", "no such method");
  refused(" call_method 'Adder.add', self.leaf\n", "called as virtual ones");
  refused(" call_method Base, self.base\n", "no method");
  refused(" call_body Base\n", "no base of this one");
  refused(" call_method 'Base.add', self.base\n", "not written");
  refused(" v0 = const i32 1\n call_reference v0, Base\n", "a reference is u64");
  refused(" v0 = const u64 1\n call_reference v0, Adder\n", "no block");
  refused(" v0 = const u64 1\n v1 = is_type bool v0, INT\n", "no block and no interface");
}

TEST(IrObjects, AGlobalProgramNeedsItsInstance) {
  expect_refused(
      "program P\ntype G = globals\n  member global Other : Main\ntype Main = program\n"
      "globals G\ntask T period 1 priority 0\ninstance Main : Main task 0\n"
      "pou program Main self Main\nb0:\n return\n",
      "names no program instance");
}

}  // namespace
}  // namespace ir
