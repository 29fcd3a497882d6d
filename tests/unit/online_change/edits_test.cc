// Several edits on trial at once, one made on top of the other, each with its own way back (D3,
// case 77). By both strategies (tests/CMakeLists.txt).
#include <gtest/gtest.h>

#include "base/tool_limits.h"
#include "ir/bytecode/symbols.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;

std::string station(const std::string& variables, const std::string& body = "") {
  return "FUNCTION_BLOCK Pump VAR turns : DINT; END_VAR turns := turns + 1; END_FUNCTION_BLOCK\n"
         "PROGRAM Main VAR keep : DINT := 4; n : DINT; " +
         variables + " END_VAR n := n + 1; " + body + " END_PROGRAM";
}

// The first retypes and drops, the second narrows and adds a block, the third uses its place again.
const std::string kStation1 =
    station("level : INT := 7; gone : STRING[20] := 'here'; wide : DINT;");
const std::string kStation2 = station("level : LREAL; wide : DINT;", "level := level;");
const std::string kStation3 = station("level : LREAL; wide : INT; p : Pump;", "p();");
const std::string kStation4 =
    station("level : LREAL; wide : INT; p : ARRAY[1..2] OF Pump; more : ARRAY[0..3] OF DINT;",
            "p[2](); more[3] := more[3] + 1;");

uint32_t station_address(Plant& plant, const std::string& path) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(plant.controller().image(), path);
  return symbol.ok() ? symbol->data : 0;
}

struct ThreeEdits {
  ThreeEdits() : plant(kStation1) {
    plant.run(2);
    plant.set("Main.level", "300");
    plant.set("Main.gone", "'a text'");
    plant.set("Main.wide", "70000");
    plant.set("Main.keep", "42");
    keep = station_address(plant, "Main.keep");
    for (const std::string& next : {kStation2, kStation3, kStation4}) {
      plant.change(next, true);
      plant.run(2);
    }
  }
  Plant plant;
  uint32_t keep = 0;
};

// The first edit is taken out from below the others: what it dropped has its value again, and a
// variable of another type under that name begins anew.
TEST(Edits, X4_case77_WhatAnEditTookAwayComesBackFromBelowOthers) {
  const std::string more = "level : LREAL; wide : INT; p : ARRAY[1..2] OF Pump; "
                           "more : ARRAY[0..3] OF DINT; gone : STRING[";
  for (const bool same_type : {true, false}) {
    ThreeEdits edits;
    Plant& plant = edits.plant;
    const std::string back =
        station(more + (same_type ? "20" : "30") + "] := 'here';", "p[2](); n := n;");
    ASSERT_TRUE(plant.stage(plant.package(back), 0).ok());
    ASSERT_TRUE(plant.driver().arm(true).ok());
    ASSERT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get("Main.gone"), same_type ? "'a text'" : "'here'");
    EXPECT_EQ(plant.get("Main.p[2].turns"), "2");
    plant.undo();
    EXPECT_EQ(plant.get("Main.wide"), "32767");
    for (int i = 0; i < 3; ++i) plant.undo();
    EXPECT_EQ(plant.get("Main.gone"), "'a text'");
  }
}

TEST(Edits, D3_case77_ThreeEditsThereAndBack) {
  ThreeEdits edits;
  Plant& plant = edits.plant;
  EXPECT_EQ(plant.driver().on_trial(), 3u);
  EXPECT_EQ(plant.get("Main.level"), "300.0");
  EXPECT_EQ(plant.get("Main.wide"), "32767");
  EXPECT_EQ(plant.get("Main.p[2].turns"), "2");
  EXPECT_EQ(plant.get("Main.n"), "8");
  EXPECT_EQ(station_address(plant, "Main.keep"), edits.keep);

  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.driver().on_trial(), 2u);
  EXPECT_EQ(plant.get("Main.p.turns"), "3");  // two scans of the third version, one after undo
  EXPECT_EQ(plant.get("Main.wide"), "32767");
  EXPECT_EQ(station_address(plant, "Main.keep"), edits.keep);

  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.driver().on_trial(), 1u);
  EXPECT_EQ(plant.get("Main.wide"), "70000");  // nobody wrote it since it was narrowed
  EXPECT_EQ(plant.get("Main.level"), "300.0");
  plant.set("Main.level", "301.0");

  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.driver().on_trial(), 0u);
  EXPECT_EQ(plant.driver().state(), State::kIdle);
  EXPECT_EQ(plant.get("Main.level"), "301");
  EXPECT_EQ(plant.get("Main.gone"), "'a text'");  // dropped three edits ago
  EXPECT_EQ(plant.get("Main.wide"), "70000");
  EXPECT_EQ(plant.get("Main.keep"), "42");
  EXPECT_EQ(station_address(plant, "Main.keep"), edits.keep);
  EXPECT_EQ(plant.get("Main.n"), "11");
  ASSERT_TRUE(plant.driver().prime().ok());
  EXPECT_EQ(plant.driver().undo().error().refusal, Refusal::kNothingToUndo);
}

TEST(Edits, D3_TheWayBackIsMadeReadyAgainBeforeUndo) {
  ThreeEdits edits;
  ASSERT_TRUE(edits.plant.driver().undo().ok());  // that of the newest edit was
  EXPECT_EQ(edits.plant.driver().undo().error().refusal, Refusal::kBusy);
  EXPECT_EQ(edits.plant.driver().on_trial(), 2u);
  ASSERT_TRUE(edits.plant.driver().prime().ok());
  ASSERT_TRUE(edits.plant.driver().undo().ok());
  edits.plant.driver().collect();  // makes it ready too
  ASSERT_TRUE(edits.plant.driver().undo().ok());
}

TEST(Edits, D3_AnEditThatIsNotMadeLeavesTheTrialAndItsWayBack) {
  Plant plant(kStation1);
  plant.run(2);
  plant.set("Main.gone", "'a text'");
  plant.change(kStation2, true);
  plant.run(1);
  const base::Bytes package = plant.package(kStation3);
  int stops = 0;
  for (bool switched = false; !switched; ++stops) {
    int left = stops;
    plant.driver().set_interruption([&] { return left-- == 0; });
    switched = plant.stage(package).ok() && plant.driver().arm(true).ok() &&
               plant.driver().switch_now().ok();
    plant.driver().set_interruption(nullptr);
    if (switched) break;
    plant.driver().cancel();
    ASSERT_EQ(plant.driver().on_trial(), 1u) << stops;
    ASSERT_EQ(plant.driver().state(), State::kTrial) << stops;
  }
  EXPECT_GT(stops, 5);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.p.turns"), "1");
  plant.undo();
  // Once more, and then the way back of the edit below it.
  ASSERT_TRUE(plant.stage(package).ok());
  plant.driver().cancel();
  plant.undo();
  EXPECT_EQ(plant.get("Main.gone"), "'a text'");
  plant.run(2);
  EXPECT_EQ(plant.driver().state(), State::kIdle);
}

TEST(Edits, D3_FbInitThatTrapsTakesBackTheNewestEditOnly) {
  Plant plant(station(""));
  plant.change(station("x : INT := 3;"));
  const std::string traps =
      "FUNCTION_BLOCK Bad VAR z : INT; END_VAR METHOD FB_Init : BOOL VAR_INPUT "
      "bInitRetains, bInCopyCode : BOOL; END_VAR z := 1 / z; END_METHOD END_FUNCTION_BLOCK\n";
  ASSERT_TRUE(plant.stage(plant.package(traps + station("x : INT := 3; bad : Bad;"))).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  EXPECT_EQ(plant.driver().switch_now().error().refusal, Refusal::kInitFailed);
  EXPECT_EQ(plant.driver().on_trial(), 1u);
  plant.driver().collect();
  plant.controller().cycle();  // the trap is on record
  EXPECT_EQ(plant.get("Main.x"), "3");
  plant.undo();
  EXPECT_EQ(plant.driver().on_trial(), 0u);
}

TEST(Edits, D3_AcceptingTheOldestLeavesTheOthersOnTrial) {
  ThreeEdits edits;
  Plant& plant = edits.plant;
  ASSERT_TRUE(plant.driver().accept_oldest(2).ok());
  EXPECT_EQ(plant.driver().on_trial(), 1u);
  plant.undo();
  EXPECT_EQ(plant.get("Main.p.turns"), "2");
  EXPECT_EQ(plant.driver().state(), State::kIdle);
  EXPECT_EQ(plant.driver().accept().error().refusal, Refusal::kNothingToUndo);
}

TEST(Edits, D3_AcceptEndsThemAll) {
  ThreeEdits edits;
  edits.plant.accept();
  EXPECT_EQ(edits.plant.driver().on_trial(), 0u);
  EXPECT_EQ(edits.plant.driver().undo().error().refusal, Refusal::kNothingToUndo);
  edits.plant.change(station("wide : INT;"), true);
  edits.plant.undo();
  EXPECT_EQ(edits.plant.get("Main.p[2].turns"), "2");
}

TEST(Edits, D3_WhatIsPreparedOnTopStaysWhenThoseBelowAreAccepted) {
  Plant plant(kStation1);
  plant.change(kStation2, true);
  ASSERT_TRUE(plant.stage(plant.package(kStation3)).ok());
  ASSERT_TRUE(plant.driver().accept().ok());
  EXPECT_EQ(plant.driver().state(), State::kPrepared);
  ASSERT_TRUE(plant.driver().arm(true).ok());
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.driver().on_trial(), 1u);
  plant.run(1);
  plant.undo();
  EXPECT_EQ(plant.driver().state(), State::kIdle);
}

TEST(Edits, D3_kMostEditsOnTrial_AreNotExceeded) {
  const auto version = [](uint32_t n) {
    return station("x : INT := " + std::to_string(n) + ";", "x := " + std::to_string(n) + ";");
  };
  Plant plant(version(0));
  for (uint32_t n = 1; n <= base::kMostEditsOnTrial; ++n) plant.change(version(n));
  EXPECT_EQ(plant.driver().on_trial(), size_t{base::kMostEditsOnTrial});
  const base::Error refused = plant.stage(plant.package(version(99))).error();
  EXPECT_EQ(refused.refusal, Refusal::kTooMany);
  EXPECT_NE(refused.text.find("kMostEditsOnTrial"), std::string::npos) << refused.text;
  for (uint32_t n = base::kMostEditsOnTrial; n-- > 0;) {
    plant.undo();
    plant.run(1);
    EXPECT_EQ(plant.get("Main.x"), std::to_string(n));
  }
  EXPECT_EQ(plant.driver().state(), State::kIdle);
}

// X2: the code of a migration belongs to a version that is made anew before its way back is used.
TEST(Edits, D3_X2_AMigrationGoesBackUnderOtherEdits) {
  const auto tank = [](const std::string& members, const std::string& before) {
    return before + "FUNCTION_BLOCK Tank VAR " + members +
           " END_VAR ; END_FUNCTION_BLOCK PROGRAM Main VAR a, b : Tank; n : DINT; END_VAR a(); "
           "b(); ";
  };
  const std::string there =
      "{migration of := 'Tank'} FUNCTION There VAR_INPUT litres : DINT; END_VAR VAR_OUTPUT "
      "cubic : DINT; END_VAR cubic := litres / 1000; END_FUNCTION "
      "{migration of := 'Tank', inverse} FUNCTION Back VAR_INPUT cubic : DINT; END_VAR VAR_OUTPUT "
      "litres : DINT; END_VAR litres := cubic * 1000; END_FUNCTION ";
  Plant plant(tank("litres : DINT := 5500;", "") + "END_PROGRAM");
  plant.run(1);
  const std::string second = tank("cubic : DINT;", there);
  plant.change(second + "END_PROGRAM", true);
  EXPECT_EQ(plant.get("Main.a.cubic"), "5");
  plant.change(second + "n := n + 1; END_PROGRAM", true);
  plant.change(second + "n := n + 2; END_PROGRAM", true);
  plant.run(1);
  plant.set("Main.b.cubic", "7");
  plant.undo();
  plant.undo();
  plant.undo();
  EXPECT_EQ(plant.get("Main.a.litres"), "5500");  // nobody wrote it since
}

}  // namespace
}  // namespace online_change
