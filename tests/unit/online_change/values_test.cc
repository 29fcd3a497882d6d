// Change cases 1 to 24 on running plants: what becomes of scalars, strings, arrays
// and structures (A13, A14, A15).
#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;

std::string main_with(const std::string& vars, const std::string& body = "") {
  return "PROGRAM Main VAR " + vars + " END_VAR " + body + " END_PROGRAM";
}

// One variable v: what it becomes, and whether that is a loss.
struct Retype {
  const char* old_type;
  const char* live;
  const char* new_type;
  const char* expected;
  bool loss;
};

TEST(Values, A14_scalars_on_a_running_plant) {
  const Retype kCases[] = {
      {"INT", "100", "SINT", "100", false},  // case 1
      {"INT", "300", "SINT", "127", true},
      {"DINT", "16777217", "REAL", "16777216.0", true},  // case 3
      {"DINT", "-7", "REAL", "-7.0", false},
      {"INT", "5", "REAL", "5.0", false},
      {"REAL", "0.5", "LREAL", "0.5", false},
      {"TIME", "T#3s", "LTIME", "LT#3s", false},
      {"REAL", "1.0E+30", "INT", "32767", true},  // case 4
      {"REAL", "2.5", "INT", "2", true},
      {"UINT", "40000", "INT", "32767", true},  // case 5
      {"INT", "-1", "UINT", "0", true},
      {"STRING[80]", "'forty characters are too many for it'", "STRING[10]", "'forty char'", true},
      {"STRING[10]", "'abc'", "STRING[80]", "'abc'", false},  // case 7
      {"STRING[10]", "'abc'", "WSTRING[10]", "\"abc\"", false},
      {"WSTRING[10]", "\"abc\"", "STRING[10]", "'abc'", false},
      {"BOOL", "TRUE", "INT", "1", false},  // case 8
      {"INT", "2", "BOOL", "TRUE", true},
      {"INT", "0", "BOOL", "FALSE", false},
      {"INT (0..100)", "80", "INT (0..50)", "50", true},  // case 9
      {"INT (0..100)", "30", "INT (0..50)", "30", false},
      {"WORD", "16#1FF", "BYTE", "16#FF", true},
  };
  for (const Retype& c : kCases) {
    std::string what = std::string(c.old_type) + " " + c.live + " -> " + c.new_type;
    Plant plant(main_with("v : " + std::string(c.old_type) + ";"));
    plant.set("Main.v", c.live);
    base::Digest before = plant.hash();
    std::string next = main_with("v : " + std::string(c.new_type) + ";");
    if (c.loss) {
      EXPECT_EQ(plant.refused(next), Refusal::kWouldLose) << what;
      EXPECT_EQ(plant.hash(), before) << what;
    }
    plant.change(next, c.loss);
    EXPECT_EQ(plant.get("Main.v"), c.expected) << what;
    EXPECT_EQ(plant.row("Main.v")->fate, Fate::kConverted) << what;
    EXPECT_TRUE(plant.row("Main.v")->may_lose || !c.loss) << what;
    plant.undo();
    EXPECT_EQ(plant.hash(), before) << what;
  }
}

TEST(Values, case4_nan_is_initialised_as_loss) {
  Plant plant(main_with("v, zero : REAL;", "v := zero / zero;"));
  plant.run(1);
  std::string next = main_with("v : INT := 9; zero : REAL;");
  EXPECT_EQ(plant.refused(next), Refusal::kWouldLose);
  plant.change(next, true);
  EXPECT_EQ(plant.get("Main.v"), "9");
}

TEST(Values, X4_case6_undo_brings_the_original_bits_back) {
  Plant plant(main_with("v, w : LREAL := 0.1;"));
  plant.change(main_with("v, w : REAL;"), true);
  plant.set("Main.w", "0.75");
  plant.undo();
  EXPECT_EQ(plant.get("Main.v"), "0.1");
  EXPECT_EQ(plant.get("Main.w"), "0.75");
}

// Back every value fits, so nothing need be converted: it comes back all the same.
TEST(Values, X4_case6_undo_brings_back_what_a_subrange_cut) {
  Plant plant(main_with("v, w : INT := 500;"));
  plant.change(main_with("v, w : INT(0..100);"), true);
  EXPECT_EQ(plant.get("Main.v"), "100");
  plant.set("Main.w", "7");
  plant.undo();
  EXPECT_EQ(plant.get("Main.v"), "500");
  EXPECT_EQ(plant.get("Main.w"), "7");
}

TEST(Values, case10_enumeration_by_name_and_as_integer) {
  auto source = [](const char* literals, const char* type) {
    return "TYPE Mode : (" + std::string(literals) + "); END_TYPE " +
           main_with("v : " + std::string(type) + "; w : ARRAY[0..2] OF Mode;",
                     "w[1] := Mode#Run;");
  };
  Plant plant(source("Stop, Run, Hold", "Mode"));
  plant.set("Main.v", "Run");
  plant.run(1);
  plant.change(source("Stop, Warm, Run, Hold", "Mode"));
  EXPECT_EQ(plant.get("Main.v"), "Run");
  EXPECT_EQ(plant.get("Main.w"), "[Stop, Run, Stop]");
  plant.accept();
  plant.change(source("Stop, Warm, Run, Hold", "INT"));
  EXPECT_EQ(plant.get("Main.v"), "2");
  plant.accept();
  // The literal that is live goes: a loss, and the initial value.
  EXPECT_EQ(plant.refused(
                source("Stop, Run2, Hold", "INT")
                    .replace(source("Stop, Run2, Hold", "INT").find("Mode#Run;"), 9, "Mode#Run2;")),
            Refusal::kWouldLose);
}

TEST(Values, case11_new_initial_value_is_not_applied) {
  Plant plant(main_with("v : INT := 1; s : STRING[10] := 'old';"));
  plant.set("Main.v", "55");
  plant.change(main_with("v : INT := 2; s : STRING[10] := 'new';"));
  EXPECT_EQ(plant.get("Main.v"), "55");
  EXPECT_EQ(plant.get("Main.s"), "'old'");
  EXPECT_EQ(plant.row("Main.v")->fate, Fate::kKept);
  EXPECT_NE(plant.row("Main.v")->reason.find("initial value 1 -> 2"), std::string::npos);
  EXPECT_TRUE(plant.plan().steps.empty());
}

TEST(Values, case12_constants_follow_the_source) {
  auto source = [](const char* limit) {
    return "PROGRAM Main VAR CONSTANT limit : INT := " + std::string(limit) +
           "; END_VAR VAR a : ARRAY[1..limit] OF INT; n : INT; END_VAR n := n + limit; "
           "a[limit] := n; END_PROGRAM";
  };
  Plant plant(source("3"));
  plant.run(1);
  plant.change(source("5"));
  plant.run(1);
  EXPECT_EQ(plant.get("Main.n"), "8");
  EXPECT_EQ(plant.get("Main.a"), "[0, 0, 3, 0, 8]");
  EXPECT_EQ(plant.get("Main.limit"), "5");
}

TEST(Values, A1_case13_order_in_the_source_means_nothing) {
  Plant plant(main_with("a : INT := 1; b : INT := 2; c : LREAL := 3;"));
  plant.set("Main.a", "10");
  plant.set("Main.b", "20");
  plant.change(main_with("c : LREAL := 3; b : INT := 2; a : INT := 1;"));
  EXPECT_EQ(plant.get("Main.a"), "10");
  EXPECT_EQ(plant.get("Main.b"), "20");
  EXPECT_EQ(plant.plan().counts.kept, 3u);
  EXPECT_TRUE(plant.plan().steps.empty());
}

TEST(Values, A2_A3_case14_renamed_without_a_rule) {
  Plant plant("VAR_GLOBAL old_name : INT := 4; other : DINT := 5; END_VAR " +
              main_with("k : INT;", "k := k + 1;"));
  plant.set("old_name", "44");
  plant.set("other", "55");
  base::Digest before = plant.hash();
  plant.change("VAR_GLOBAL new_name : INT := 6; other : DINT := 5; END_VAR " +
                   main_with("k : INT;", "k := k + 1;"),
               true);
  EXPECT_EQ(plant.get("new_name"), "6");
  EXPECT_EQ(plant.get("other"), "55");
  EXPECT_EQ(plant.row("old_name")->fate, Fate::kDropped);
  EXPECT_EQ(plant.row("new_name")->fate, Fate::kInitialised);
  plant.undo();
  EXPECT_EQ(plant.hash(), before);
}

TEST(Values, A15_without_initial_value_the_types_default) {
  std::string types =
      "TYPE Level : INT := 7; Rec : STRUCT a : INT := 3; b : Level; END_STRUCT; END_TYPE ";
  Plant plant(types + main_with("x : INT;"));
  plant.change(types + main_with("x : INT; l : Level; r : Rec; t : TIME; s : STRING[4];"));
  EXPECT_EQ(plant.get("Main.l"), "7");
  EXPECT_EQ(plant.get("Main.r"), "(a := 3, b := 7)");
  EXPECT_EQ(plant.get("Main.t"), "T#0s");
  EXPECT_EQ(plant.get("Main.s"), "''");
}

TEST(Values, case17_middle_dimension_grows) {
  const char* kBody =
      "FOR i := 1 TO 3 DO FOR j := 1 TO 4 DO FOR k := 1 TO 5 DO v[i,j,k] := 100*i + 10*j + k; "
      "END_FOR END_FOR END_FOR";
  Plant plant(main_with("v : ARRAY[1..3,1..4,1..5] OF INT; i, j, k : INT;", kBody));
  plant.run(1);
  plant.change(main_with("v : ARRAY[1..3,1..6,1..5] OF INT; i, j, k : INT;"));
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 6; ++j) {
      for (int k = 1; k <= 5; ++k) {
        std::string path =
            "Main.v[" + std::to_string(i) + "," + std::to_string(j) + "," + std::to_string(k) + "]";
        EXPECT_EQ(plant.get(path), std::to_string(j > 4 ? 0 : 100 * i + 10 * j + k)) << path;
      }
    }
  }
}

TEST(Values, case18_shifted_bounds_other_dimensions) {
  Plant plant(
      main_with("v : ARRAY[0..4] OF INT := [10, 11, 12, 13, 14]; w : ARRAY[1..10] OF INT;"));
  std::string next = main_with("v : ARRAY[1..5] OF INT := [5(99)]; w : ARRAY[1..2,1..5] OF INT;");
  EXPECT_EQ(plant.refused(next), Refusal::kWouldLose);  // w has no rule
  plant.change(next, true);
  EXPECT_EQ(plant.get("Main.v"), "[11, 12, 13, 14, 99]");
  EXPECT_EQ(plant.row("Main.w")->fate, Fate::kInitialised);
  EXPECT_TRUE(plant.row("Main.w")->may_lose);
}

TEST(Values, case19_index_that_became_invalid_is_kept) {
  Plant plant(main_with("v : ARRAY[0..9] OF INT; i : INT := 8;"));
  plant.change(main_with("v : ARRAY[0..4] OF INT; i : INT := 8;"), true);
  EXPECT_EQ(plant.get("Main.i"), "8");
  EXPECT_EQ(plant.plan().counts.dropped, 5u);
}

TEST(Values, case20_element_type_and_bounds) {
  Plant plant(main_with("v : ARRAY[0..4] OF INT := [1, 2, 3, 4, 5];"));
  base::Digest before = plant.hash();
  plant.change(main_with("v : ARRAY[2..6] OF LREAL;"), true);
  EXPECT_EQ(plant.get("Main.v"), "[3.0, 4.0, 5.0, 0.0, 0.0]");
  plant.undo();
  EXPECT_EQ(plant.hash(), before);
}

TEST(Values, case21_case22_structures_by_name) {
  auto source = [](const char* rec) {
    return "TYPE Rec : STRUCT " + std::string(rec) +
           " END_STRUCT; END_TYPE "
           "FUNCTION_BLOCK Box VAR r : ARRAY[1..2] OF Rec; END_VAR r[2].a := r[2].a + 1; "
           "END_FUNCTION_BLOCK " +
           main_with("b : ARRAY[1..2] OF Box;", "b[1](); b[2]();");
  };
  Plant plant(source("a : INT; b : REAL := 1.5;"));
  plant.run(3);
  plant.change(source("first : BOOL := TRUE; a : DINT; renamed : REAL := 2.5;"), true);
  EXPECT_EQ(plant.get("Main.b[2].r[2].a"), "3");
  EXPECT_EQ(plant.get("Main.b[1].r[1].first"), "TRUE");
  EXPECT_EQ(plant.get("Main.b[1].r[1].renamed"), "2.5");
  EXPECT_EQ(plant.plan().counts.dropped, 4u);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.b[2].r[2].a"), "4");
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("Main.b[2].r[2].a"), "5");
}

TEST(Values, case24_many_elements_many_instances) {
  auto source = [](const char* bound, const char* var) {
    return "FUNCTION_BLOCK Cell VAR n : INT; " + std::string(var) +
           " END_VAR n := n + 1; END_FUNCTION_BLOCK " +
           main_with("v : ARRAY[1.." + std::string(bound) +
                         "] OF DINT; c : ARRAY[1..200] OF Cell; i : INT;",
                     "v[7] := 77; FOR i := 1 TO 200 DO c[i](); END_FOR");
  };
  linker::Slack slack;
  slack.free_bytes = 1u << 20;
  Plant plant(source("10000", ""), slack);
  plant.run(2);
  plant.change(source("10001", "extra : INT := 3;"));
  EXPECT_EQ(plant.get("Main.v[7]"), "77");
  EXPECT_EQ(plant.get("Main.c[200].n"), "2");
  EXPECT_EQ(plant.get("Main.c[200].extra"), "3");
  EXPECT_LE(plant.plan().fates.size(), 3u);
  EXPECT_EQ(plant.plan().counts.initialised, 201u);
}

TEST(Values, A16_case52_pause_follows_the_change_not_the_program) {
  auto steps = [](int size) {
    std::string n = std::to_string(size);
    Plant plant(main_with("x : INT; v : ARRAY[1.." + n + "] OF INT;"));
    plant.change(main_with("x : DINT; v : ARRAY[1.." + n + "] OF INT;"));
    return plant.plan();
  };
  Plan small = steps(1000);
  Plan large = steps(1000000);
  EXPECT_EQ(small.steps.size(), large.steps.size());
  EXPECT_EQ(small.boundary_bytes, large.boundary_bytes);
  EXPECT_EQ(small.predicted_pause_ns, large.predicted_pause_ns);
}

}  // namespace
}  // namespace online_change
