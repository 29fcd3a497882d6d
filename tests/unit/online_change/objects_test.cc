// Blocks that extend others across a change: methods and overrides come and go, bases grow and
// appear, and every variable keeps its value.
#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

struct Parts {
  std::string base = "  member local n : DINT\n";    // of Base, and first of Derived
  std::string own = "  member local extra : INT\n";  // of Derived
  std::string derived_add;                           // POU Derived.add; "": inherited
  std::string globals;
  std::string tasks;  // and instances
  std::string types;
};

// Main adds 1 by a virtual call on `derived` through a reference that the first scan keeps, and 1
// to `extra`.
std::string source(const Parts& parts) {
  const std::string target = parts.derived_add.empty() ? "Base.add" : "Derived.add";
  return "program P\ntype G = globals\n" + parts.globals + "type Base = function_block\n" +
         parts.base + "type Derived = function_block extends Base\n" + parts.base + parts.own +
         "type Main = program\n  member local base : Base\n  member local derived : Derived\n"
         "  member local ref : ULINT\n" +
         parts.types + "globals G\ntask T period 1000000 priority 0\n" + parts.tasks +
         "instance Main : Main task 0\n" + "override Base : 'Base.add' = 'Base.add'\n" +
         "override Derived : 'Base.add' = '" + target + "'\n" + R"(pou function_block Base self Base
  b0:
    return
pou method 'Base.add' self Base
  local input x : DINT
  b0:
    v0 = load i32 self.n
    v1 = load i32 local.x
    v2 = add i32 v0, v1
    store i32 self.n, v2
    return
pou function_block Derived self Derived
  b0:
    v0 = load i16 self.extra
    v1 = const i16 1
    v2 = add i16 v0, v1
    store i16 self.extra, v2
    return
)" + parts.derived_add +
         R"(pou program Main self Main
  b0:
    v0 = load u64 self.ref
    v1 = const u64 0
    v2 = eq u64 v0, v1
    branch v2, b1, b2
  b1:
    v3 = handle u64 self.derived
    store u64 self.ref, v3
    jump b2
  b2:
    v4 = load u64 self.ref
    v5 = const i32 1
    store i32 arg('Base.add').x, v5
    call_virtual 'Base.add', v4
    call_instance self.derived
    return
)";
}

constexpr std::string_view kTenfold = R"(pou method 'Derived.add' self Derived
  local input x : DINT
  b0:
    v0 = load i32 local.x
    v1 = const i32 10
    v2 = mul i32 v0, v1
    store i32 arg('Base.add').x, v2
    call_method 'Base.add'
    return
)";

TEST(Objects, A12_ANewOverrideIsWhatReferencesFindFromTheSwitchOn) {
  Plant plant(source({}));
  plant.run(3);
  EXPECT_EQ(plant.get("Main.derived.n"), "3");
  Parts next;
  next.derived_add = kTenfold;
  plant.change(source(next));
  EXPECT_TRUE(plant.plan().fates.empty());
  plant.run(2);
  EXPECT_EQ(plant.get("Main.derived.n"), "23");
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "24");
  plant.change(source(next), false, true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "34");
  plant.accept();
  plant.change(source({}), false, true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "35");
  EXPECT_EQ(plant.get("Main.derived.extra"), "8");
}

TEST(Objects, A5_ABaseGrowsInItsSlackAndNothingMoves) {
  Plant plant(source({}));
  plant.run(3);
  Parts next;
  next.base = "  member local n : DINT\n  member local m : DINT init #0\n";
  const std::string text = source(next);
  const size_t at = text.find("globals G");
  plant.change(text.substr(0, at) + "const #0 = 7\n" + text.substr(at));
  EXPECT_EQ(plant.plan().counts.moved, 0u);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "4");
  EXPECT_EQ(plant.get("Main.derived.extra"), "4");
  EXPECT_EQ(plant.get("Main.derived.m"), "7");
  EXPECT_EQ(plant.get("Main.base.m"), "7");
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "5");
  EXPECT_EQ(plant.get("Main.derived.extra"), "5");
}

// Then what was added to it moves behind it, with its values.
TEST(Objects, A5_ABaseOutgrowsItsSlack) {
  Plant plant(source({}));
  plant.run(3);
  Parts next;
  for (int i = 0; i < 12; ++i) next.base += "  member local m" + std::to_string(i) + " : LINT\n";
  for (const bool move_all : {false, true}) {
    plant.change(source(next), false, move_all);
    plant.run(1);
    plant.undo();
  }
  plant.change(source(next));
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "6");
  EXPECT_EQ(plant.get("Main.derived.extra"), "6");
  EXPECT_EQ(plant.get("Main.derived.m11"), "0");
}

// Both ways: `n` goes from the block into a base that is new, and back.
TEST(Objects, A1_AVariableThatMovesIntoABaseKeepsItsValue) {
  const auto text = [](bool with_base) {
    const std::string members =
        "  member local n : INT\n  member local a : LINT\n  member local b : BOOL\n";
    const std::string other =
        "  member local a : LINT\n  member local n : INT\n"
        "  member local b : BOOL\n";
    return "program P\ntype G = globals\n" +
           std::string(with_base ? "type Base = function_block\n  member local a : LINT\n"
                                   "type Block = function_block extends Base\n" +
                                       other
                                 : "type Block = function_block\n" + members) +
           "type Main = program\n  member local block : Block\nglobals G\n"
           "task T period 1000000 priority 0\ninstance Main : Main task 0\n" +
           (with_base ? "pou function_block Base self Base\n  b0:\n    return\n" : "") +
           R"(pou function_block Block self Block
  b0:
    v0 = load i16 self.n
    v1 = const i16 1
    v2 = add i16 v0, v1
    store i16 self.n, v2
    v3 = load i64 self.a
    v4 = const i64 100
    v5 = add i64 v3, v4
    store i64 self.a, v5
    v6 = const bool TRUE
    store bool self.b, v6
    return
pou program Main self Main
  b0:
    call_instance self.block
    return
)";
  };
  Plant plant(text(false));
  plant.run(3);
  for (const bool move_all : {false, true}) {
    plant.change(text(true), false, move_all);
    plant.run(1);
    plant.undo();
  }
  EXPECT_EQ(plant.get("Main.block.n"), "5");
  EXPECT_EQ(plant.get("Main.block.a"), "500");
  plant.change(text(true));
  plant.accept();
  EXPECT_EQ(plant.plan().counts.initialised, 0u);
  EXPECT_EQ(plant.plan().counts.dropped, 0u);
  plant.change(text(false));
  plant.run(1);
  EXPECT_EQ(plant.get("Main.block.n"), "6");
  EXPECT_EQ(plant.get("Main.block.a"), "600");
  EXPECT_EQ(plant.get("Main.block.b"), "TRUE");
}

// Start code runs at cold start and after changes of variables, not behind those of code alone.
TEST(Objects, StartTasksRunBehindChangesOfVariables) {
  const auto text = [](const char* amount) {
    Parts parts;
    parts.globals = "  member global started : INT\n";
    parts.types = "type Init = program\n";
    parts.tasks = "task Start once priority 0\ninstance Init : Init task 1\n";
    parts.derived_add =
        std::string(
            "pou program Init self Init\n  b0:\n    v0 = load i16 "
            "global.started\n    v1 = const i16 ") +
        amount + "\n    v2 = add i16 v0, v1\n    store i16 global.started, v2\n    return\n" +
        std::string(kTenfold);
    return source(parts);
  };
  Plant plant(text("5"));
  EXPECT_EQ(plant.get("started"), "5");
  plant.run(2);
  plant.change(text("6"));
  plant.run(2);
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("started"), "5");
  Plant later(source({}));
  later.run(1);
  later.change(text("5"));
  EXPECT_EQ(later.get("started"), "5") << "in the switch";
  later.run(1);
  EXPECT_EQ(later.get("started"), "5");
  later.run(1);
  EXPECT_EQ(later.get("started"), "5");
}

// One that traps stops the controller before the first scan, as any task does.
TEST(Objects, AStartTaskThatTraps) {
  Parts parts;
  parts.types = "type Init = program\n";
  parts.tasks = "task Start once priority 0\ninstance Init : Init task 1\n";
  parts.derived_add =
      "pou program Init self Init\n  b0:\n    trap assert\n" + std::string(kTenfold);
  Plant plant(source(parts));
  EXPECT_TRUE(plant.controller().faulted());
  ASSERT_EQ(plant.controller().traps().size(), 1u);
  EXPECT_EQ(plant.controller().traps()[0]->task, "Start");
}

// A global of program type comes with a change: it names the instance that runs.
TEST(Objects, A4_ProgramsBecomeReachableByAChange) {
  Plant plant(source({}));
  plant.run(2);
  Parts next;
  next.globals = "  member global Main : Main\n  member global seen : INT\n";
  next.derived_add = R"(pou method 'Derived.add' self Derived
  local input x : DINT
  b0:
    v0 = handle u64 global.Main!.derived
    v1 = this u64
    v2 = eq u64 v0, v1
    branch v2, b1, b2
  b1:
    v3 = const i16 1
    store i16 global.seen, v3
    jump b2
  b2:
    return
)";
  plant.change(source(next));
  plant.run(1);
  EXPECT_EQ(plant.get("seen"), "1");
  EXPECT_EQ(plant.get("Main.derived.n"), "2");
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("Main.derived.n"), "3");
}

}  // namespace
}  // namespace online_change
