// References across a change (change cases 29 to 33): failure at every step leaves them as they
// were, what is found broken at the boundary only stops the switch, and nothing is done where
// nothing moves. Values are in tests/golden/change/references_*.st.
#include <gtest/gtest.h>

#include "online_change/diff/place_moves.h"
#include "online_change/diff/reference_leaves.h"
#include "online_change/plan/pause.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;

const char* const kFirst = R"(
TYPE Part : STRUCT low, high : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor VAR_OUTPUT hours : DINT; part : Part; END_VAR hours := hours + 1; END_FUNCTION_BLOCK
PROGRAM Main
  VAR
    m, gone : Motor; a : ARRAY[0..3] OF Part; p : ARRAY[0..3] OF POINTER TO INT; q : REF_TO Part;
    r, s : REFERENCE TO Motor; inner : POINTER TO DINT; i : INT;
  END_VAR
  FOR i := 0 TO 3 DO p[i] := ADR(a[i].high); p[i]^ := i; END_FOR
  q := REF(a[2]); r REF= m; s REF= gone; inner := ADR(m.hours); m(); gone();
END_PROGRAM)";
const char* const kSecond = R"(
TYPE Part : STRUCT first : LREAL; low, high : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor
  VAR_OUTPUT log : ARRAY[0..9] OF LINT; hours : DINT; part : Part; END_VAR
  hours := hours + 1;
END_FUNCTION_BLOCK
PROGRAM Main
  VAR
    m : Motor; a : ARRAY[-1..2] OF Part; p : ARRAY[0..3] OF POINTER TO INT; q : REF_TO Part;
    r, s : REFERENCE TO Motor; inner : POINTER TO DINT; i : INT;
  END_VAR
  m();
END_PROGRAM)";

TEST(References, C1_case29_case32_every_step_can_fail) {
  int points = 0;
  for (int fail_at = 0; fail_at < 10000; ++fail_at) {
    Plant plant(kFirst);
    plant.run(3);
    const base::Digest before = plant.hash();
    int passed = 0;
    plant.driver().set_interruption([&] { return passed++ == fail_at; });
    Change& change = plant.driver();
    const base::Bytes package = plant.package(kSecond);
    if (plant.stage(package).ok() && change.arm(true).ok() && change.switch_now().ok()) break;
    ++points;
    ASSERT_EQ(plant.hash(), before) << fail_at;
  }
  EXPECT_GT(points, 20);
}

TEST(References, X4_every_step_of_undo_can_fail) {
  for (int fail_at = 0; fail_at < 10000; ++fail_at) {
    Plant plant(kFirst);
    plant.run(3);
    const base::Digest first = plant.hash();
    plant.change(kSecond, true);
    const base::Digest trial = plant.hash();
    int passed = 0;
    plant.driver().set_interruption([&] { return passed++ == fail_at; });
    const bool done = plant.driver().undo().ok();
    ASSERT_EQ(plant.hash(), done ? first : trial) << fail_at;
    if (done) break;
  }
}

TEST(References, case29_case30_case32_follow) {
  Plant plant(kFirst);
  plant.run(3);
  plant.change(kSecond, true);
  EXPECT_EQ(plant.get("Main.p[2]"), "Main.a[2].high");
  EXPECT_EQ(plant.get("Main.p[3]"), "NULL");
  EXPECT_EQ(plant.get("Main.q"), "Main.a[2]");
  EXPECT_EQ(plant.get("Main.r"), "Main.m");
  EXPECT_EQ(plant.get("Main.s"), "NULL");
  EXPECT_EQ(plant.get("Main.inner"), "Main.m.hours");
  plant.undo();
  EXPECT_EQ(plant.get("Main.p[3]"), "Main.a[3].high");
  EXPECT_EQ(plant.get("Main.s"), "Main.gone");
}

// The ID of what went is used again; a reference to it stays NULL.
// Past the end of a variable is past its end after the change, whether it grows, shrinks or stays;
// after undo it is where it was, and what was set anew is led back.
TEST(References, case30_case33_past_the_end_follows_its_variable) {
  const std::string rest =
      "t : ARRAY[0..3] OF INT; p, q, r, gone : POINTER TO INT; set : BOOL; END_VAR ";
  Plant plant("PROGRAM Main VAR a, b : ARRAY[0..3] OF INT; " + rest +
              "IF NOT set THEN set := TRUE; p := ADR(a) + 8; q := ADR(b) + 8; r := ADR(b) - 4;"
              "gone := ADR(t) + 8; END_IF END_PROGRAM");
  plant.run(1);
  plant.change(
      "PROGRAM Main VAR x : LREAL; a : ARRAY[0..9] OF INT; b : ARRAY[0..1] OF INT; "
      "t : ARRAY[0..3] OF DINT; p, q, r, gone : POINTER TO INT; set : BOOL; END_VAR "
      "IF set THEN set := FALSE; q := ADR(a) + 20; END_IF END_PROGRAM",
      true);
  EXPECT_EQ(plant.get("Main.p"), "Main.a+20");
  EXPECT_EQ(plant.get("Main.q"), "Main.b+4");
  EXPECT_EQ(plant.get("Main.r"), "Main.b-4");
  EXPECT_EQ(plant.get("Main.gone"), "NULL");
  plant.run(1);
  plant.undo();
  EXPECT_EQ(plant.get("Main.p"), "Main.a+8");
  EXPECT_EQ(plant.get("Main.q"), "Main.a+8");
  EXPECT_EQ(plant.get("Main.r"), "Main.b-4");
  EXPECT_EQ(plant.get("Main.gone"), "Main.t+8");
}

TEST(References, case31_id_used_again) {
  const std::string block = "FUNCTION_BLOCK B VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK ";
  const std::string refs = "r : REFERENCE TO B; i : INT; END_VAR ";
  Plant plant(block + "PROGRAM Main VAR b : B; " + refs + "r REF= b; END_PROGRAM");
  plant.run(1);
  const uint32_t id = plant.id_of("Main.b");
  plant.change(block + "PROGRAM Main VAR " + refs + "END_PROGRAM", true);
  plant.accept();
  EXPECT_EQ(plant.get("Main.r"), "NULL");
  plant.change(block + "PROGRAM Main VAR c : B; " + refs + "c(); END_PROGRAM", true);
  EXPECT_EQ(plant.id_of("Main.c"), id);
  EXPECT_EQ(plant.get("Main.r"), "NULL");
}

// The value is carried over exactly, so nothing is lost when the change is armed; then a reference
// is set to it.
void break_at_the_boundary(const linker::Slack& slack) {
  const std::string rest = "p : POINTER TO DINT; go : BOOL; END_VAR ";
  Plant plant("PROGRAM Main VAR x : DINT := 7; y : REAL := 2; " + rest +
                  "IF go THEN p := ADR(x); END_IF END_PROGRAM",
              slack);
  const std::string second =
      "PROGRAM Main VAR x : REAL := 7; y : DINT := 2; " + rest + "END_PROGRAM";
  plant.run(1);
  ASSERT_TRUE(plant.stage(plant.package(second)).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  plant.set("Main.go", "TRUE");
  plant.run(1);
  const base::Digest before = plant.hash();
  base::Result<SwitchReport> report = plant.driver().switch_now();
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().refusal, Refusal::kWouldLose);
  EXPECT_NE(report.error().text.find("Main.p"), std::string::npos);
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(plant.refused(second), Refusal::kWouldLose);  // now it is seen beforehand
  plant.change(second, true);
  EXPECT_EQ(plant.get("Main.p"), "NULL");
  EXPECT_EQ(plant.get("Main.y"), "2");
  plant.undo();
  EXPECT_EQ(plant.get("Main.p"), "Main.x");
}

TEST(References, A13_broken_at_the_boundary_only) { break_at_the_boundary({}); }

// Without slack the values have been written over version 1's own when the reference is looked at.
TEST(References, A13_broken_at_the_boundary_where_version_1_is_written_over) {
  break_at_the_boundary({0, 0, 0, 0, 0, 0, 64 * 1024, 0});
}

// What is added in the slack moves nothing: references cost nothing there, nor on the way to it.
TEST(References, A16_nothing_to_do_where_nothing_moves) {
  const std::string head = "PROGRAM Main VAR x : INT; p : ARRAY[1..1000] OF POINTER TO INT; ";
  Plant plant(head + "END_VAR p[1] := ADR(x); END_PROGRAM");
  plant.run(1);
  const ir::Image before = plant.controller().image();
  plant.change(head + "y : INT; END_VAR END_PROGRAM");
  const ir::Image& after = plant.controller().image();
  EXPECT_TRUE(PlaceMoves(before, after).trivial());
  EXPECT_FALSE(PlaceMoves(after, before).trivial());
  EXPECT_LT(plant.plan().predicted_pause_ns, 30'000);
  EXPECT_EQ(reference_leaves(after).size(), 1000u);
}

// 50,000 references into an array that moves.
TEST(References, case52_pause_is_predicted) {
  const std::string tail =
      "p : ARRAY[1..50000] OF POINTER TO INT; i : DINT; END_VAR "
      "IF i = 0 THEN FOR i := 1 TO 50000 DO p[i] := ADR(a[i MOD 100]); END_FOR END_IF END_PROGRAM";
  Plant plant("PROGRAM Main VAR a : ARRAY[0..99] OF INT; " + tail);
  plant.run(1);
  const SwitchReport report = plant.change("PROGRAM Main VAR a : ARRAY[0..199] OF INT; " + tail);
  EXPECT_GE(plant.plan().predicted_pause_ns, 50'000 * kPauseReferenceNs);
  EXPECT_EQ(plant.get("Main.p[47777]"), "Main.a[77]");
  RecordProperty("pause_us", std::to_string(report.pause_ns / 1000));
}

}  // namespace
}  // namespace online_change
