// X2: rules of renaming, applied to the running version's image.
#include <gtest/gtest.h>

#include "ir/bytecode/renames.h"
#include "tests/unit/online_change/hand_made.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string program(const std::string& variables, const std::string& code = "") {
  return "PROGRAM Main VAR " + variables + " END_VAR " + code + " END_PROGRAM";
}

TEST(Renames, X2_A1_the_variable_keeps_its_address) {
  Plant plant(program("a : INT; b : DINT;", "a := a + 1;"));
  plant.run(3);
  const uint32_t before = ir::find_symbol(plant.controller().image(), "Main.a")->data;
  plant.change(program("c : LREAL; b : DINT; {renamed from := 'A'} z : INT;", "z := z + 1;"));
  EXPECT_EQ(ir::find_symbol(plant.controller().image(), "Main.z")->data, before);
  EXPECT_EQ(plant.get("Main.z"), "3");
  EXPECT_EQ(plant.row("Main.z")->fate, Fate::kKept);
  EXPECT_EQ(plant.row("Main.z")->reason, "renamed from `a`");
}

TEST(Renames, X2_A9_the_instance_keeps_its_ID_and_area) {
  const std::string pump =
      "FUNCTION_BLOCK Pump VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK ";
  Plant plant(pump + program("p : ARRAY[1..3] OF Pump; q : Pump;", "p[2](); q();"));
  plant.run(2);
  const uint32_t id = plant.id_of("Main.p[2]");
  plant.change(pump +
               program("new : Pump; {renamed from := 'p'} row : ARRAY[1..4] OF Pump; q : Pump;",
                       "row[2](); q(); new();"));
  EXPECT_EQ(plant.id_of("Main.row[2]"), id);
  EXPECT_EQ(plant.get("Main.row[2].n"), "2");
  EXPECT_EQ(plant.get("Main.new.n"), "0");
  plant.undo();
  EXPECT_EQ(plant.id_of("Main.p[2]"), id);
}

TEST(Renames, X2_a_rule_is_applied_once) {
  Plant plant(program("a : INT := 1;"));
  plant.set("Main.a", "7");
  plant.change(program("{renamed from := 'a'} b : INT := 1;"));
  plant.accept();
  // Somebody declares an `a` again; the rule stands.
  plant.change(program("{renamed from := 'a'} b : INT := 1; a : INT := 5;"));
  plant.accept();
  plant.change(program("{renamed from := 'a'} b : INT := 1; a, c : INT := 5;"));
  EXPECT_EQ(plant.get("Main.b"), "7");
  EXPECT_EQ(plant.get("Main.a"), "5");
}

TEST(Renames, X2_a_rule_does_not_overwrite_a_variable_of_its_name) {
  Plant plant(program("a, b : INT;"));
  plant.set("Main.a", "1");
  plant.set("Main.b", "2");
  plant.change(program("{renamed from := 'a'} b : INT;"), true);
  EXPECT_EQ(plant.get("Main.b"), "2");
}

TEST(Renames, X2_the_rule_wins_over_a_new_variable_of_the_old_name) {
  Plant plant(program("a : INT;"));
  plant.set("Main.a", "1");
  plant.change(program("{renamed from := 'a'} b : INT; a : INT := 9;"));
  EXPECT_EQ(plant.get("Main.b"), "1");
  EXPECT_EQ(plant.get("Main.a"), "9");
  plant.undo();
  EXPECT_EQ(plant.get("Main.a"), "1");
}

TEST(Renames, X2_chains_and_circles_move_all_values_on) {
  Plant plant(program("a, b, c : INT;"));
  plant.set("Main.a", "1");
  plant.set("Main.b", "2");
  plant.set("Main.c", "3");
  plant.change(
      program("{renamed from := 'a'} b : INT; {renamed from := 'b'} c : INT; "
              "{renamed from := 'c'} d : INT;"));
  EXPECT_EQ(plant.get("Main.b") + plant.get("Main.c") + plant.get("Main.d"), "123");
  plant.accept();
  plant.change(
      program("{renamed from := 'd'} b : INT; {renamed from := 'b'} c : INT; "
              "{renamed from := 'c'} d : INT;"));
  // c keeps the rule that it had: it was applied, and b is not free then.
  EXPECT_EQ(plant.plan().counts.kept, 3u);
}

TEST(Renames, X2_a_chain_that_begins_with_nothing_applies_where_it_can) {
  Plant plant(program("b, c : INT;"));
  plant.set("Main.b", "2");
  plant.set("Main.c", "3");
  // d takes c, so c is free for b; `x` is nowhere, so b is new.
  plant.change(
      program("{renamed from := 'x'} b : INT := 9; {renamed from := 'b'} c : INT; "
              "{renamed from := 'c'} d : INT;"));
  EXPECT_EQ(plant.get("Main.b") + plant.get("Main.c") + plant.get("Main.d"), "923");
}

const std::string kLimit = "TYPE Limit : STRUCT low, high : INT; END_STRUCT END_TYPE ";

// By both strategies, also what is written after the copy; the rule is applied once.
TEST(Renames, X2_parts_of_variables_move) {
  for (Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Plant plant(kLimit + program("low : INT; high : DINT; n : INT;", "n := n + 1;"));
    plant.use(strategy);
    plant.set("Main.low", "3");
    plant.run(1);
    const std::string next = program(
        "{renamed '.low' from := 'low'} {renamed '.high' from := 'hi', 'high'} limit : Limit; "
        "n : INT;",
        "n := n + 1;");
    ASSERT_TRUE(plant.stage(plant.package(kLimit + next)).ok());
    ASSERT_TRUE(plant.driver().arm(true).ok());
    plant.run(1);
    plant.set("Main.high", "40000");
    ASSERT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get("Main.limit"), "(low := 3, high := 32767)");
    plant.set("Main.limit.low", "5");
    plant.undo();
    EXPECT_EQ(plant.get("Main.low"), "5") << "it goes on";
    EXPECT_EQ(plant.get("Main.high"), "40000") << "nobody wrote it";
    plant.change(kLimit + next, true);
    EXPECT_EQ(plant.row("Main.limit.low")->reason, "renamed from `low`, moved inside its area");
    EXPECT_EQ(plant.row("Main.limit.low")->old_path, "Main.low");
    EXPECT_EQ(plant.plan().counts.dropped, 0u);
    plant.accept();
    plant.change(kLimit + program("{renamed '.low' from := 'low'} limit : Limit; low : INT := 9; "
                                  "n : INT;",
                                  "n := n + 1;"));
    EXPECT_EQ(plant.get("Main.limit.low"), "5");
    EXPECT_EQ(plant.get("Main.low"), "9");
  }
}

// Two rules lead to one place, or a variable is renamed already: nothing is written twice.
TEST(Renames, X2_parts_that_overlap) {
  Plant plant(kLimit + program("a : Limit; b : INT := 7; c : INT := 8;"));
  plant.set("Main.a.low", "1");
  plant.change(kLimit + program("{renamed from := 'a'} {renamed '.low' from := 'b'} x : Limit; "
                                "{renamed from := 'c', 'a.low'} y : INT;"),
               true);
  EXPECT_EQ(plant.get("Main.x.low"), "1") << "it is there under the new name";
  EXPECT_EQ(plant.get("Main.y"), "8");
  plant.undo();
  EXPECT_EQ(plant.get("Main.b"), "7");
  plant.change(kLimit + "TYPE Two : STRUCT l : Limit; END_STRUCT END_TYPE " +
                   program("{renamed '.l' from := 'a'} {renamed '.l.low' from := 'b'} t : Two; "
                           "c : INT := 8;"),
               true);
  EXPECT_EQ(plant.get("Main.t.l.low"), "1");
  plant.undo();
  EXPECT_EQ(plant.get("Main.a.low"), "1");
  EXPECT_EQ(plant.get("Main.b"), "7");
}

TEST(Renames, X2_globals_of_a_list_and_anonymous_structures) {
  const auto source = [](const char* list, const char* x, const char* rule) {
    return std::string("{attribute 'list' := '") + list +
           "'} {attribute 'qualified_only'} VAR_GLOBAL " + rule + x + " : INT; " +
           "s : ARRAY[0..1] OF STRUCT " + rule + x + " : INT; y : INT; END_STRUCT; END_VAR " +
           "PROGRAM Main END_PROGRAM";
  };
  Plant plant(source("G", "a", ""));
  plant.set("G.a", "4");
  plant.set("G.s[1].a", "5");
  plant.change(source("G", "b", "{renamed from := 'a'} "));
  EXPECT_EQ(plant.get("G.b"), "4");
  EXPECT_EQ(plant.get("G.s[1].b"), "5");
}

TEST(Renames, X2_case22_the_type_becomes_another_structure_with_the_same_members) {
  const std::string types =
      "TYPE A : STRUCT x : INT; y : INT; END_STRUCT END_TYPE "
      "TYPE B : STRUCT y : INT; x : INT; END_STRUCT END_TYPE ";
  Plant plant(types + program("v : A; w : B;"));
  plant.set("Main.v.x", "1");
  plant.set("Main.v.y", "2");
  plant.change(types + program("v : B; w : B;"));
  EXPECT_EQ(plant.get("Main.v.x") + plant.get("Main.v.y"), "12");
}

TEST(Renames, X2_V17_a_rule_of_a_damaged_image_is_followed_into_no_wrong_type) {
  hand_made::Version before;
  before.program("Main", {{"a", before.elementary(ir::Kind::kReal)},
                          {"b", before.elementary(ir::Kind::kDint)}});
  before.link();
  hand_made::Version after;
  after.program("Main", {{"c", after.elementary(ir::Kind::kDint)}});
  after.link();
  for (uint32_t i = 0; i < after.image.types.size(); ++i) {
    if (after.image.types[ir::TypeId(i)].kind != ir::Kind::kProgram) continue;
    after.image.types.own().edit(ir::TypeId(i)).members[0].old_name =
        after.image.types.own().add_old_name("a");
  }
  const auto renamed = ir::under_new_names(before.image, after.image);
  ASSERT_TRUE(renamed.has_value());
  base::Result<Plan> forward = plan(before.image, after.image);
  ASSERT_TRUE(forward.ok());
  EXPECT_EQ(forward->counts.converted, 1u);
  Package package;
  package.forward = Plan{};  // says that `c` is simply kept where it lies
  package.inverse = inverse_plan(before.image, after.image).value();
  EXPECT_FALSE(check_package(package, before.image, after.image).ok());
}

}  // namespace
}  // namespace online_change
