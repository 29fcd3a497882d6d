// What a change does to code, and the restricted mode.
#include "online_change/plan/pou_edits.h"

#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::vector<PouEdit> edits_between(const std::string& before, const std::string& after) {
  Plant plant(before);
  auto package = decode(plant.package(after));
  base::check(package.ok(), "a package of a plant");
  return pou_edits(plant.controller().image(), *ir::decode(package->image));
}

// "Motor body 3; Gone removed 0"
std::string text(const std::vector<PouEdit>& edits) {
  std::string out;
  for (const PouEdit& edit : edits) {
    if (!out.empty()) out += "; ";
    out += edit.pou + " " + pou_change_name(edit.change) + " " + std::to_string(edit.instances);
    if (!edit.what.empty()) out += " " + edit.what;
  }
  return out;
}

std::string pid(const char* gain, const char* interface) {
  return std::string("FUNCTION_BLOCK Pid ") + interface + " VAR i : REAL; END_VAR i := i + 0.1 * " +
         gain +
         "; END_FUNCTION_BLOCK\nPROGRAM Main VAR p : ARRAY[1..3] OF Pid; END_VAR p[1](); "
         "END_PROGRAM";
}

TEST(PouEdits, X1_case41_a_gain_changes_under_a_live_integrator) {
  EXPECT_EQ(text(edits_between(pid("2.0", ""), pid("3.0", ""))), "Pid body 3");
  Plant plant(pid("2.0", ""));
  plant.run(10);
  const std::string before = plant.get("Main.p[1].i");
  plant.change(pid("3.0", ""));
  EXPECT_EQ(plant.get("Main.p[1].i"), before) << "the integrator is kept";
}

TEST(PouEdits, case53_a_comment_edits_no_pou) {
  EXPECT_EQ(text(edits_between(pid("2.0", ""), "(* a\n comment *)\n\n" + pid("2.0", ""))), "");
}

// What inlines another POU: cli/follows.sh.
TEST(PouEdits, E02_who_uses_another_constant_follows) {
  const auto program = [](const char* limit, const char* step) {
    return std::string("VAR_GLOBAL CONSTANT limit : INT := ") + limit +
           "; END_VAR\nFUNCTION Aside : INT Aside := limit; END_FUNCTION\n"
           "PROGRAM Main VAR n : INT; END_VAR n := " + step + " + Aside(); END_PROGRAM";
  };
  EXPECT_EQ(text(edits_between(program("7", "1"), program("8", "1"))), "Aside follows 0");
  EXPECT_EQ(text(edits_between(program("7", "1"), program("8", "2"))),
            "Main body 1; Aside follows 0");
}

TEST(PouEdits, AddedAndRemoved) {
  const std::string f = "FUNCTION F : INT F := 1; END_FUNCTION\n";
  const std::string main = "PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM";
  EXPECT_EQ(text(edits_between(main, f + main)), "F added 0");
  EXPECT_EQ(text(edits_between(f + main, main)), "F removed 0");
}

struct InterfaceCase {
  const char* before;
  const char* after;
  const char* what;
};

TEST(PouEdits, D7_every_kind_of_interface_edit_is_seen) {
  const InterfaceCase cases[] = {
      {"VAR_INPUT a : INT; END_VAR", "VAR_INPUT a : DINT; END_VAR", "input `a` INT -> DINT"},
      {"VAR_INPUT a : INT; END_VAR", "VAR_INPUT a, b : INT; END_VAR", "input `b` added"},
      {"VAR_INPUT a, b : INT; END_VAR", "VAR_INPUT a : INT; END_VAR", "input `b` removed"},
      {"VAR_INPUT a, b : INT; END_VAR", "VAR_INPUT b, a : INT; END_VAR",
       "input `b` in the place of input `a`"},
      {"VAR_INPUT a : INT; END_VAR", "VAR_OUTPUT a : INT; END_VAR",
       "output `a` in the place of input `a`"},
      {"VAR_OUTPUT q : BOOL; END_VAR", "VAR_OUTPUT q : INT; END_VAR", "output `q` BOOL -> INT"},
  };
  for (const InterfaceCase& one : cases) {
    auto edits = edits_between(pid("1.0", one.before), pid("1.0", one.after));
    ASSERT_FALSE(edits.empty()) << one.what;
    const PouEdit& last = edits.back();
    EXPECT_EQ(last.pou, "Pid");
    EXPECT_EQ(last.what, one.what);
    base::Status restricted = check_restricted(edits);
    ASSERT_FALSE(restricted.ok()) << one.what;
    EXPECT_EQ(restricted.error().refusal, base::Refusal::kInterfaceEdit);
  }
}

TEST(PouEdits, D7_structures_results_and_methods_belong_to_the_interface) {
  auto program = [](const char* member, const char* result, const char* argument) {
    return std::string("TYPE P : STRUCT a : INT; ") + member +
           " END_STRUCT; END_TYPE\nFUNCTION F : " + result +
           " VAR_INPUT p : P; END_VAR F := 1; END_FUNCTION\n"
           "FUNCTION_BLOCK B METHOD M : INT VAR_INPUT x : " +
           argument +
           "; END_VAR M := 1; END_METHOD END_FUNCTION_BLOCK\n"
           "PROGRAM Main VAR p : P; b : B; n : DINT; END_VAR n := F(p) + b.M(1); END_PROGRAM";
  };
  const std::string first = program("b : INT;", "INT", "INT");
  EXPECT_EQ(edits_between(first, program("b : DINT;", "INT", "INT"))[0].what,
            "input `p`: P has another content");
  EXPECT_EQ(edits_between(first, program("b : INT;", "SINT", "INT"))[0].change,
            PouChange::kInterface);
  EXPECT_EQ(edits_between(first, program("b : INT;", "INT", "SINT"))[0].pou, "B.M");
}

TEST(PouEdits, D7_an_interface_is_seen_behind_other_edits) {
  const auto program = [](const char* step, const char* type) {
    return std::string("FUNCTION Aside : INT Aside := ") + step + "; END_FUNCTION\n" +
           "FUNCTION Scale : INT VAR_INPUT x : " + type + "; END_VAR Scale := 2; END_FUNCTION\n" +
           "PROGRAM Main VAR n : INT; END_VAR n := Aside() + Scale(1); END_PROGRAM";
  };
  const auto edits = edits_between(program("1", "INT"), program("2", "SINT"));
  ASSERT_GT(edits.size(), 1u);
  EXPECT_EQ(edits.front().pou, "Aside");
  const base::Status restricted = check_restricted(edits);
  ASSERT_FALSE(restricted.ok());
  EXPECT_EQ(restricted.error().text, "`Scale`: input `x` INT -> SINT");
}

TEST(PouEdits, D7_bodies_and_locals_are_free) {
  auto edits = edits_between(pid("1.0", "VAR_INPUT a : INT; END_VAR"),
                             pid("1.5", "VAR_INPUT a : INT; END_VAR VAR more : LREAL; END_VAR"));
  EXPECT_EQ(text(edits), "Pid body 3");
  EXPECT_TRUE(check_restricted(edits).ok());
}

}  // namespace
}  // namespace online_change
