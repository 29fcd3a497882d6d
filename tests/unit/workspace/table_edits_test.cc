// The restricted table (E-16 to E-18) and limits by version (E-20, E-22), on programs as the
// compiler makes them.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "linker/merge.h"
#include "online_change/plan/online_limits.h"
#include "online_change/plan/table_edits.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

using online_change::EditKind;
using online_change::OnlineLimits;
using online_change::TableEdit;
using online_change::TableSide;

ir::Image table_image(const std::string& text) {
  const test::Outcome built = test::build_from_nothing(test::one_file(text), {});
  EXPECT_TRUE(built.image.has_value()) << text;
  return built.image ? std::move(*ir::decode(*built.image)) : ir::Image();
}

std::string program(const std::string& globals, const std::string& variables = "") {
  return "TYPE Pair : STRUCT a, b : INT; END_STRUCT; END_TYPE\nVAR_GLOBAL " + globals +
         " END_VAR\nPROGRAM Main VAR n : INT; " + variables + " END_VAR n := n + 1; END_PROGRAM\n";
}

std::string lines(const std::vector<TableEdit>& edits) {
  std::string out;
  for (const TableEdit& edit : edits) {
    out += std::string(online_change::table_change_name(edit.change)) + " " + edit.path + ": " +
           edit.what + "\n";
  }
  return out;
}

std::string between(const std::string& before, const std::string& after,
                    TableSide side = TableSide::kBefore) {
  return lines(online_change::table_edits(table_image(before), table_image(after), side));
}

constexpr const char* kOld = "a : INT; b : INT := 5; c : REAL; d : Pair;";

TEST(TableEdits, E16_AnExtendedTableIsTaken) {
  EXPECT_EQ(between(program(kOld), program(kOld)), "");
  EXPECT_EQ(between(program(kOld), program("z : BOOL; a : INT; b : INT := 5; y : Pair; c : REAL; "
                                           "d : Pair; x : LREAL;",
                                           "more : INT;")),
            "");
}

TEST(TableEdits, E16_DeletedReorderedAndRetypedAreAllNamedTheFirstOneFirst) {
  EXPECT_EQ(between(program(kOld), program("b : INT := 5; c : REAL; d : Pair;")),
            "removed a: removed\n");
  EXPECT_EQ(between(program(kOld), program("a : INT; c : REAL; d : Pair; b : INT := 5;")),
            "order c: it stood after `b`\norder d: it stood after `b`\n");
  EXPECT_EQ(between(program(kOld), program("d : Pair; b : INT := 6; c : LREAL;")),
            "removed a: removed\ninitial b: initial value 5 -> 6\ntype c: type REAL -> LREAL\n"
            "order d: it stood after `c`\n");
}

TEST(TableEdits, E16_EverySettingCounts) {
  const std::string old_table = program("a : INT; w AT %QW4 : WORD;");
  EXPECT_EQ(between(old_table, program("a : INT; w AT %QW6 : WORD;")),
            "address w: address %QW4 -> %QW6\n");
  EXPECT_EQ(between(old_table, program("a : INT; w : WORD;")), "address w: address %QW4 -> none\n");
  EXPECT_EQ(between(program("a : INT;"), "VAR_GLOBAL RETAIN a : INT; END_VAR\n" + program("")),
            "retain a: RETAIN no -> yes\n");
  EXPECT_EQ(between(program("a : INT := 3;"),
                    "VAR_GLOBAL CONSTANT a : INT := 3; END_VAR\n" + program("")),
            "constant a: CONSTANT no -> yes\n");
  EXPECT_EQ(between(program("a : INT;"), program("a : INT := 0;")), "") << "it says the same";
  EXPECT_EQ(between(program("s : STRING := 'x';"), program("s : STRING := 'y';")),
            "initial s: another initial value\n");
  EXPECT_EQ(between(program("d : Pair;"), program("d : Pair := (a := 1);")),
            "initial d: another initial value\n");
}

// The text is the same, and what it means is not.
TEST(TableEdits, E16_ATypeIsWhatIsInIt) {
  const auto with = [](const char* type) {
    return std::string("TYPE T : ") + type + "; END_TYPE\n" + program("t : T;");
  };
  const std::pair<const char*, const char*> pairs[] = {
      {"STRUCT x : INT; END_STRUCT", "STRUCT x : INT; y : INT; END_STRUCT"},
      {"(Red, Green)", "(Red, Blue, Green)"},
      {"INT (0..10)", "INT (0..11)"},
      {"ARRAY[0..3] OF INT", "ARRAY[0..4] OF INT"}};
  for (const auto& [before, after] : pairs) {
    EXPECT_EQ(between(with(before), with(before)), "");
    EXPECT_TRUE(between(with(before), with(after)).starts_with("type t: ")) << after;
  }
  // A block is a unit, and no part of the table.
  const auto block = [](const char* variables) {
    return std::string("FUNCTION_BLOCK B VAR ") + variables + " END_VAR END_FUNCTION_BLOCK\n" +
           program("b : B;");
  };
  EXPECT_EQ(between(block("x : INT;"), block("y : LREAL;")), "");
}

TEST(TableEdits, E16_VariablesOfProgramsAreInTheTable) {
  EXPECT_EQ(between(program("", "x : INT; y : INT;"), program("", "y : DINT;")),
            "removed Main.x: removed\ntype Main.y: type INT -> DINT\n");
  const std::string two = program("") + "PROGRAM Aux VAR k : INT; END_VAR END_PROGRAM\n";
  EXPECT_EQ(between(two, program("")), "removed Aux: removed, with its variables\n");
  EXPECT_EQ(between(program(""), two), "");
}

TEST(TableEdits, E16_AProgramThatOthersReadIsNoVariable) {
  const std::string watch = "PROGRAM Watch VAR seen : INT; END_VAR seen := Main.n; END_PROGRAM\n";
  const std::string read = program("a : INT;") + watch;
  EXPECT_EQ(between(read, read), "");
  EXPECT_EQ(between(read, program("a : INT;", "more : INT;") + watch), "");
  EXPECT_EQ(between(program("a : INT;"), read), "");
  EXPECT_EQ(between(read, program("a : INT;", "more : REAL;")), "removed Watch: removed, with its "
                                                                "variables\n");
  EXPECT_EQ(between(read, program("a : INT;") + watch, TableSide::kOwn), "");
}

TEST(TableEdits, E16_AddressesOfVarConfigAreInTheTable) {
  const auto at = [](const char* address) {
    return std::string(
               "PROGRAM Main VAR x AT %I* : BOOL; y : BOOL; END_VAR y := x; END_PROGRAM\n"
               "CONFIGURATION c TASK t (INTERVAL := T#10ms, PRIORITY := 1); "
               "PROGRAM p WITH t : Main; VAR_CONFIG p.x AT ") +
           address + " : BOOL; END_VAR END_CONFIGURATION\n";
  };
  EXPECT_EQ(between(at("%IX0.0"), at("%IX0.0")), "");
  EXPECT_EQ(between(at("%IX0.0"), at("%IX0.1")), "address p.x: address %IX0.0 -> %IX0.1\n");
}

// Overlapping addresses make one variable of several inside; the table has them as written.
TEST(TableEdits, E16_OverlappingAddressesAreVariablesOfTheirOwn) {
  const std::string plain = program("w AT %MW4 : WORD; x AT %MX20.3 : BOOL;");
  EXPECT_EQ(between(plain, program("w AT %MW4 : WORD; low AT %MB8 : BYTE; x AT %MX20.3 : BOOL; "
                                   "v AT %MB20 : BYTE;")),
            "");
  const std::string on = program("x AT %MX20.3 : BOOL := TRUE;");
  EXPECT_EQ(between(on, program("x AT %MX20.3 : BOOL := TRUE; v AT %MB20 : BYTE;")), "");
  EXPECT_EQ(between(program("w AT %MW4 : WORD; low AT %MB8 : BYTE;"), program("w AT %MW4 : WORD;")),
            "removed low: removed\n");
}

// E-18, and the controller's own table against the new one.
TEST(TableEdits, E18_WhatAControllerAloneHasStays) {
  const std::string own = program("mine : LREAL; a : INT; his : INT;", "x : INT;");
  EXPECT_EQ(between(own, program("a : INT; more : INT;"), TableSide::kOwn), "");
  EXPECT_EQ(between(program("mine : INT; b : INT; a : INT;"), program("a : INT; b : INT;"),
                    TableSide::kOwn),
            "order a: it stood after `b`\n");
  EXPECT_EQ(between(program("a : DINT;"), program("a : INT;"), TableSide::kOwn),
            "type a: type DINT -> INT\n");
  // After the edit it has both, its own where they were.
  const ir::Image original = table_image(program("a : INT;"));
  const ir::Image edited = table_image(program("a : INT; more : INT;"));
  const ir::Image target = table_image(own);
  const base::Result<ir::Image> merged = linker::merge({original, edited, target}, {});
  ASSERT_TRUE(merged.ok()) << merged.error().text;
  EXPECT_EQ(lines(online_change::table_edits(target, *merged, TableSide::kBefore)), "");
  EXPECT_GE(merged->types->find_member(merged->globals, "more"), 0);
  EXPECT_GE(merged->types->find_member(merged->globals, "mine"), 0);
}

TEST(TableEdits, E16_TheTextNamesTheFirstAndCountsWhatIsTooMuch) {
  std::string many;
  for (int i = 0; i < 230; ++i) many += "v" + std::to_string(i) + " : INT; ";
  const auto edits = online_change::table_edits(table_image(program(many)),
                                                table_image(program("")), TableSide::kBefore);
  ASSERT_EQ(edits.size(), 230u);
  const base::Status refused = online_change::check_table(edits, "x");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTableEdit);
  EXPECT_TRUE(refused.error().text.starts_with("x: `v0`: removed; `v1`: removed"));
  EXPECT_TRUE(refused.error().text.ends_with("; and 30 more")) << refused.error().text;
}

// --- limits -----------------------------------------------------------------------

constexpr uint32_t bit(EditKind kind) { return 1u << static_cast<uint32_t>(kind); }
constexpr OnlineLimits kRows[] = {
    {"1.0", 7, 9, bit(EditKind::kUnitAdded) | bit(EditKind::kVariableRemoved)},
    {"1.1", 7, 12, bit(EditKind::kUnitAdded) | bit(EditKind::kTask)},
    {"2.0", 8, 16, bit(EditKind::kSchedule)}};

TEST(OnlineLimits, E20_AnUnknownVersionHasTheStrictestOfAllRows) {
  for (const std::vector<std::string>& targets :
       {std::vector<std::string>{}, {"3.7"}, {"2.0", ""}}) {
    const online_change::ChosenLimits chosen = online_change::chosen_limits(kRows, targets);
    EXPECT_EQ(chosen.limits.first_format, 8u);
    EXPECT_EQ(chosen.limits.last_format, 9u);
    EXPECT_EQ(chosen.limits.refused, kRows[0].refused | kRows[1].refused | kRows[2].refused);
    EXPECT_TRUE(chosen.text.starts_with("the strictest of all versions")) << chosen.text;
  }
  EXPECT_EQ(online_change::chosen_limits(kRows, {"3.7"}).text,
            "the strictest of all versions: stvm 3.7 has no row");
}

TEST(OnlineLimits, E20_SeveralTargetsHaveTheStrictestOfTheirs) {
  const auto one = online_change::chosen_limits(kRows, {"1.1", "1.1"});
  EXPECT_EQ(one.limits.refused, kRows[1].refused);
  EXPECT_EQ(one.text, "those of stvm 1.1");
  const auto two = online_change::chosen_limits(kRows, {"2.0", "1.1"});
  EXPECT_EQ(two.limits.refused, kRows[1].refused | kRows[2].refused);
  EXPECT_EQ(two.limits.last_format, 12u);
  EXPECT_EQ(two.text, "the strictest of stvm 2.0, 1.1");
}

std::string kinds(const std::string& before, const std::string& after) {
  std::string out;
  for (const auto& edit : online_change::online_edits(table_image(before), table_image(after))) {
    out += std::string(online_change::edit_kind_name(edit.kind)) + " " + edit.name + "\n";
  }
  return out;
}

TEST(OnlineLimits, E19_EveryKindOfEditIsTold) {
  const std::string f = "FUNCTION F : INT VAR_INPUT x : INT; END_VAR F := x; END_FUNCTION\n";
  const std::string g = "FUNCTION F : INT VAR_INPUT x : DINT; END_VAR F := 1; END_FUNCTION\n";
  const std::string b = "FUNCTION_BLOCK B VAR k : INT; END_VAR END_FUNCTION_BLOCK\n";
  const std::string c = "FUNCTION_BLOCK B VAR k : LREAL; END_VAR END_FUNCTION_BLOCK\n";
  EXPECT_EQ(kinds(program("a : INT;"), f + program("a : INT;")), "unit.added F\n");
  EXPECT_EQ(kinds(f + program("a : INT;"), program("a : INT;")), "unit.removed F\n");
  EXPECT_EQ(kinds(f + program("a : INT;"), g + program("a : INT;")), "unit.interface F\n");
  EXPECT_EQ(kinds(b + program("a : INT;"), c + program("a : INT;")), "block.variables B\n");
  EXPECT_EQ(kinds(program("a, b : INT;"), program("b : REAL; c : INT;")),
            "table.removed a\ntable.type b\ntable.added c\n");
  EXPECT_EQ(kinds("TYPE E : (Red); END_TYPE\n" + program(""),
                  "TYPE E : (Red, Blue); END_TYPE\n" + program("")),
            "type E\n");
}

TEST(OnlineLimits, E22_TheControllerNamesEveryEditThatItDoesNotTake) {
  const ir::Image before = table_image(program("a : INT; b : INT;"));
  const ir::Image after =
      table_image("FUNCTION F : INT F := 1; END_FUNCTION\n" + program("b : INT;"));
  const base::Status refused = online_change::check_limits(kRows[0], before, after);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kNotOnline);
  EXPECT_EQ(refused.error().text,
            "stvm 1.0 takes no such edit: `F`: unit.added; `a`: table.removed (removed)");
  EXPECT_TRUE(online_change::check_limits(kRows[2], before, after).ok());
}

}  // namespace
