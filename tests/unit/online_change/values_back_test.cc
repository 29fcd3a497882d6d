// An edit that is taken out from below later ones (D3, case 77): what it had converted has its
// value from before, unless somebody has written it since (X4). By both strategies
// (tests/CMakeLists.txt).
#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

// `more`: what the later edit has, and stays.
std::string machine(const std::string& variables, const std::string& more = "",
                    const std::string& types = "") {
  return types + " PROGRAM Main VAR n : DINT; " + variables + " " + more +
         " END_VAR n := n + 1; END_PROGRAM";
}

// Edit 0 is taken out from below edit 1.
struct TwoEdits {
  TwoEdits(const std::string& before, const std::vector<std::pair<std::string, std::string>>& set,
           const std::string& edit, const std::string& later)
      : plant(before) {
    plant.run(1);
    for (const auto& [path, value] : set) plant.set(path, value);
    plant.change(edit, true);
    plant.change(later, true);
    plant.run(1);
  }
  // With the losses that the report shows.
  std::vector<LiveLoss> take_out(const std::string& back) {
    base::Status staged = plant.stage(plant.package(back), 0);
    EXPECT_TRUE(staged.ok());
    plan = plant.driver().plan();
    const std::vector<LiveLoss> losses = plant.driver().live_losses();
    EXPECT_TRUE(plant.driver().arm(true).ok());
    EXPECT_TRUE(plant.driver().switch_now().ok());
    return losses;
  }
  const FateRow* row(const std::string& path) const {
    for (const FateRow& row : plan.fates) {
      if (row.path == path) return &row;
    }
    return nullptr;
  }
  Plant plant;
  Plan plan;
};

TEST(ValuesBack, X4_case77_WhatAnEditNarrowedIsWhatItWasUnlessWritten) {
  const std::string wide = "a, b, c : INT; text : STRING[20]; r : REAL;";
  const std::string narrow = "a, b, c : SINT; text : STRING[4]; r : INT;";
  const std::string more = "later : DINT := 5;";
  TwoEdits edits(machine(wide),
                 {{"Main.a", "300"},
                  {"Main.b", "300"},
                  {"Main.c", "5"},
                  {"Main.text", "'a long text'"},
                  {"Main.r", "2.25"}},
                 machine(narrow), machine(narrow, more));
  Plant& plant = edits.plant;
  EXPECT_EQ(plant.get("Main.a"), "127");
  EXPECT_EQ(plant.get("Main.text"), "'a lo'");
  plant.set("Main.b", "-7");
  const std::vector<LiveLoss> losses = edits.take_out(machine(wide, more));
  EXPECT_TRUE(losses.empty());
  EXPECT_EQ(plant.get("Main.a"), "300");
  EXPECT_EQ(plant.get("Main.b"), "-7");
  EXPECT_EQ(plant.get("Main.c"), "5");
  EXPECT_EQ(plant.get("Main.text"), "'a long text'");
  EXPECT_EQ(plant.get("Main.r"), "2.25");
  EXPECT_EQ(plant.get("Main.later"), "5");
  ASSERT_NE(edits.row("Main.a"), nullptr);
  EXPECT_EQ(edits.row("Main.a")->reason,
            "retyped, as before the edit that is taken out, unless written since");

  plant.run(1);
  plant.undo();  // the edit is there again, as it was
  EXPECT_EQ(plant.get("Main.a"), "127");
  EXPECT_EQ(plant.get("Main.b"), "-7");
  EXPECT_EQ(plant.get("Main.text"), "'a lo'");
  EXPECT_EQ(plant.get("Main.r"), "2");
}

TEST(ValuesBack, X4_case77_WhatWasWrittenSinceIsConvertedWithItsLoss) {
  const std::string narrow = "a, b : INT; x : LREAL := 0.1;";
  const std::string wide = "a, b : DINT; x : REAL;";
  TwoEdits edits(machine(narrow), {{"Main.a", "300"}, {"Main.b", "300"}}, machine(wide),
                 machine(wide, "later : INT;"));
  Plant& plant = edits.plant;
  plant.set("Main.b", "70000");
  const std::vector<LiveLoss> losses = edits.take_out(machine(narrow, "later : INT;"));
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(losses[0].path, "Main.b");
  EXPECT_EQ(losses[0].old_value, "70000");
  EXPECT_EQ(losses[0].new_value, "32767");
  EXPECT_STREQ(losses[0].what.c_str(), "saturates");
  EXPECT_EQ(plant.get("Main.a"), "300");
  EXPECT_EQ(plant.get("Main.b"), "32767");
  EXPECT_EQ(plant.get("Main.x"), "0.1");
  plant.undo();
  EXPECT_EQ(plant.get("Main.b"), "70000");
}

// Every value of the narrow type is one of the wide one, so that without the edit that is taken out
// nothing would have to be done.
TEST(ValuesBack, X4_case77_WhatASubrangeHadCutComesBack) {
  const std::string part = "TYPE Part : STRUCT x, y, z : INT; END_STRUCT; END_TYPE";
  const std::string cut =
      "TYPE Part : STRUCT x : INT; y : INT(0..100); z : INT; END_STRUCT; END_TYPE";
  const auto with = [](const std::string& types, const std::string& type, const std::string& more) {
    return machine("v, w : " + type + "; p : ARRAY[1..3] OF Part;", more, types);
  };
  TwoEdits edits(with(part, "INT", ""),
                 {{"Main.v", "500"},
                  {"Main.w", "501"},
                  {"Main.p[1].y", "400"},
                  {"Main.p[2].y", "401"},
                  {"Main.p[3].x", "1000"},
                  {"Main.p[3].y", "402"}},
                 with(cut, "INT(0..100)", ""), with(cut, "INT(0..100)", "later : DINT;"));
  Plant& plant = edits.plant;
  EXPECT_EQ(plant.get("Main.p[2].y"), "100");
  plant.set("Main.w", "7");
  plant.set("Main.p[2].y", "8");
  EXPECT_TRUE(edits.take_out(with(part, "INT", "later : DINT;")).empty());
  EXPECT_EQ(plant.get("Main.v"), "500");
  EXPECT_EQ(plant.get("Main.w"), "7");
  EXPECT_EQ(
      plant.get("Main.p"),
      "[(x := 0, y := 400, z := 0), (x := 0, y := 8, z := 0), (x := 1000, y := 402, z := 0)]");
  ASSERT_NE(edits.row("Main.v"), nullptr);
  EXPECT_EQ(edits.row("Main.v")->fate, Fate::kConverted);
  EXPECT_EQ(edits.row("Main.v")->reason,
            "as before the edit that is taken out, unless written since; and 4 more like it");
  EXPECT_EQ(edits.plan.counts.converted, 5u);
  plant.undo();
  EXPECT_EQ(plant.get("Main.v"), "100");
  EXPECT_EQ(plant.get("Main.w"), "7");
  EXPECT_EQ(plant.get("Main.p[3].x"), "1000");
}

// A variable at a fixed address, too.
TEST(ValuesBack, X4_case77_WhatASubrangeHadCutAtAFixedAddressComesBack) {
  const auto with = [](const std::string& type, const std::string& more) {
    return "VAR_GLOBAL v AT %MW10 : " + type + "; w AT %MW11 : " + type + "; END_VAR " +
           machine("", more);
  };
  TwoEdits edits(with("INT", ""), {{"v", "500"}, {"w", "501"}}, with("INT(0..100)", ""),
                 with("INT(0..100)", "later : DINT;"));
  Plant& plant = edits.plant;
  EXPECT_EQ(plant.get("v"), "100");
  plant.set("w", "7");
  EXPECT_TRUE(edits.take_out(with("INT", "later : DINT;")).empty());
  EXPECT_EQ(plant.get("v"), "500");
  EXPECT_EQ(plant.get("w"), "7");
  plant.undo();
  EXPECT_EQ(plant.get("v"), "100");
  EXPECT_EQ(plant.get("w"), "7");
}

// Their area moves, so that they lie in the middle of what is copied.
TEST(ValuesBack, X4_case77_WhatASubrangeHadCutComesBackAtAnotherPlace) {
  const auto with = [](const std::string& type, const std::string& fields,
                       const std::string& more) {
    return "FUNCTION_BLOCK Pump VAR " + fields + " before : DINT := 1; a, b : " + type +
           "; behind : DINT := 2; END_VAR END_FUNCTION_BLOCK " +
           machine("p : Pump; q : Pump;", more);
  };
  TwoEdits edits(with("INT", "", ""), {{"Main.p.a", "500"}, {"Main.q.b", "600"}},
                 with("INT(0..100)", "", ""), with("INT(0..100)", "", "later : DINT;"));
  Plant& plant = edits.plant;
  plant.set("Main.q.behind", "77");
  plant.set("Main.p.b", "9");
  EXPECT_TRUE(
      edits.take_out(with("INT", "grows : ARRAY[0..999] OF DINT;", "later : DINT;")).empty());
  EXPECT_EQ(plant.get("Main.p.a"), "500");
  EXPECT_EQ(plant.get("Main.p.b"), "9");
  EXPECT_EQ(plant.get("Main.p.before"), "1");
  EXPECT_EQ(plant.get("Main.q.a"), "0");
  EXPECT_EQ(plant.get("Main.q.b"), "600");
  EXPECT_EQ(plant.get("Main.q.behind"), "77");
  plant.undo();
  EXPECT_EQ(plant.get("Main.p.a"), "100");
  EXPECT_EQ(plant.get("Main.q.behind"), "77");
}

TEST(ValuesBack, X4_case77_WhatALaterEditRetypedIsConvertedFromWhatItIs) {
  TwoEdits edits(machine("v : DINT;"), {{"Main.v", "70000"}}, machine("v : INT;"),
                 machine("v : LREAL;"));
  EXPECT_EQ(edits.plant.get("Main.v"), "32767.0");
  edits.take_out(machine("v : DINT;"));
  EXPECT_EQ(edits.plant.get("Main.v"), "32767");
}

// A unit that went and came again under its name is another one, whatever its values are.
TEST(ValuesBack, X4_case77_WhatALaterEditDroppedAndAddedAgainIsAnother) {
  Plant plant(machine("v : DINT;"));
  plant.set("Main.v", "70000");
  plant.change(machine("v : INT := 32767;"), true);
  plant.change(machine(""), true);
  plant.change(machine("v : INT := 32767;"), true);
  ASSERT_TRUE(plant.stage(plant.package(machine("v : DINT;")), 0).ok());
  ASSERT_TRUE(plant.driver().arm(true).ok());
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("Main.v"), "32767");
}

// The parts in which long steps are carried out end inside of a value.
TEST(ValuesBack, X4_case77_ManyValuesOfAnyLengthComeBack) {
  const std::string gone = "names : ARRAY[0..999] OF STRING[12]; n2 : ARRAY[0..999] OF INT;";
  const std::string kept = "n2 : ARRAY[0..999] OF SINT;";
  Plant plant(machine(gone));
  const auto name = [](int i) { return "'name " + std::to_string(i) + "'"; };
  for (int i = 0; i < 1000; ++i) {
    plant.set("Main.names[" + std::to_string(i) + "]", name(i));
    plant.set("Main.n2[" + std::to_string(i) + "]", std::to_string(1000 + i));
  }
  plant.change(machine(kept), true);
  plant.change(machine(kept, "later : INT;"), true);
  plant.set("Main.n2[17]", "3");
  ASSERT_TRUE(plant.stage(plant.package(machine(gone, "later : INT;")), 0).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  ASSERT_TRUE(plant.driver().switch_now().ok());
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(plant.get("Main.names[" + std::to_string(i) + "]"), name(i));
    const int expected = i == 17 ? 3 : 1000 + i;
    EXPECT_EQ(plant.get("Main.n2[" + std::to_string(i) + "]"), std::to_string(expected));
  }
}

}  // namespace
}  // namespace online_change
