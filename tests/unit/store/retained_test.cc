// D4, X5, cases 16, 55 and 57: retained values over power cuts, in the same program, another one,
// and the one before.
#include "online_change/store/retained_values.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/limits.h"
#include "tests/unit/store/carried.h"

namespace plc {
namespace {

TEST_F(Carried, D4_RetainedValuesComeBackAndOthersAreInitialised) {
  begin(program("r : INT := 3;"));
  plc_->set("r", "77");
  plc_->run(5);
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("r"), "77");
  EXPECT_EQ(plc_->get("P.n"), "0");
}

TEST_F(Carried, WithoutASaveTheyBeginAnew) {
  begin(program("r : INT := 3;"));
  plc_->set("r", "77");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("r"), "3");
}

TEST_F(Carried, ByPathWhereverTheyLie) {
  begin(program("a : INT; b : DINT; c : ARRAY[0..3] OF INT;"));
  plc_->set("b", "12");
  plc_->set("c[2]", "7");
  boot_with(program("c : ARRAY[0..3] OF INT; x : ARRAY[0..100] OF LINT; b : DINT := 5; y : INT;"));
  EXPECT_EQ(plc_->get("b"), "12");
  EXPECT_EQ(plc_->get("c[2]"), "7");
  EXPECT_EQ(plc_->get("x[0]"), "0");
}

TEST_F(Carried, A14_WidenedNarrowedAndConverted) {
  begin(program("w : INT; n : DINT; s : STRING[20]; b : BOOL; i : INT; r : REAL; t : TIME;"));
  plc_->set("w", "-300");
  plc_->set("n", "100000");
  plc_->set("s", "'hello world'");
  plc_->set("b", "TRUE");
  plc_->set("i", "5");
  plc_->set("r", "2.75");
  boot_with(
      program("w : LINT; n : INT; s : STRING[5]; b : INT; i : REAL; r : LREAL; t : INT := 9;"));
  EXPECT_EQ(plc_->get("w"), "-300");
  EXPECT_EQ(plc_->get("n"), "32767");
  EXPECT_EQ(plc_->get("s"), "'hello'");
  EXPECT_EQ(plc_->get("b"), "1");
  EXPECT_EQ(plc_->get("i"), "5.0");
  EXPECT_EQ(plc_->get("r"), "2.75");
}

TEST_F(Carried, ElementsByIndexMembersByNameLiteralsByName) {
  const std::string before =
      "TYPE S : STRUCT a : INT; b : INT; END_STRUCT; E : (Red, Green, Blue); END_TYPE";
  const std::string after =
      "TYPE S : STRUCT b : DINT; new : INT := 4; END_STRUCT; E : (Red, Grey, Green, Blue); "
      "END_TYPE";
  begin(program("m : ARRAY[1..3] OF S; e : E; q : ARRAY[0..1, 0..2] OF INT;", ";", before));
  plc_->set("m[2].b", "21");
  plc_->set("m[3].b", "31");
  plc_->set("e", "Green");
  plc_->set("q[1,1]", "11");
  boot_with(program("m : ARRAY[2..9] OF S; e : E; q : ARRAY[0..2, 0..1] OF INT;", ";", after));
  EXPECT_EQ(plc_->get("m[2].b"), "21");
  EXPECT_EQ(plc_->get("m[3].b"), "31");
  EXPECT_EQ(plc_->get("m[9].new"), "4");
  EXPECT_EQ(plc_->get("e"), "Green");
  EXPECT_EQ(plc_->get("q[1,1]"), "11");
}

TEST_F(Carried, case16_OnlyWhatIsRetainedInBoth) {
  begin(
      "VAR_GLOBAL RETAIN was : INT := 1; both : INT; END_VAR\nVAR_GLOBAL becomes : INT := 2; "
      "END_VAR\nPROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM");
  for (const char* path : {"was", "both", "becomes"}) plc_->set(path, "50");
  boot_with(
      "VAR_GLOBAL RETAIN becomes : INT := 5; both : INT; END_VAR\nVAR_GLOBAL was : INT := 6; "
      "END_VAR\nPROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM");
  EXPECT_EQ(plc_->get("was"), "6");
  EXPECT_EQ(plc_->get("both"), "50");
  EXPECT_EQ(plc_->get("becomes"), "5");
}

TEST_F(Carried, case16_ACutBeforeAndAfterTheFirstSave) {
  begin("VAR_GLOBAL v : INT := 1; END_VAR PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM");
  plc_->set("v", "40");
  const std::string retained = program("v : INT := 2;");
  // The change itself saves: the value is kept, and retained from then on.
  ASSERT_TRUE(plc_->change(retained, vm::kPermanent).ok());
  EXPECT_EQ(plc_->get("v"), "40");
  plc_->set("v", "41");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "40");
  plc_->set("v", "42");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "42");
  // And back: nothing of it is retained.
  ASSERT_TRUE(plc_->change("VAR_GLOBAL v : INT := 3; END_VAR PROGRAM P VAR n : INT; END_VAR "
                           "n := n + 1; END_PROGRAM",
                           vm::kPermanent)
                  .ok());
  EXPECT_EQ(plc_->get("v"), "42");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "3");
}

TEST_F(Carried, InstancesAndTheirMembers) {
  const std::string block =
      "FUNCTION_BLOCK F VAR RETAIN total : DINT; END_VAR VAR other : INT; "
      "END_VAR total := total + 1; END_FUNCTION_BLOCK\n";
  begin(block + "PROGRAM P VAR a : F; b : ARRAY[0..1] OF F; END_VAR a(); b[1](); END_PROGRAM");
  plc_->set("P.a.total", "100");
  plc_->set("P.b[1].total", "200");
  boot_with(block + "PROGRAM P VAR z : F; b : ARRAY[0..2] OF F; a : F; END_VAR ; END_PROGRAM");
  EXPECT_EQ(plc_->get("P.a.total"), "100");
  EXPECT_EQ(plc_->get("P.b[1].total"), "200");
  EXPECT_EQ(plc_->get("P.z.total"), "0");
}

TEST_F(Carried, ReferencesFollowWhatTheyLeadTo) {
  begin(
      "VAR_GLOBAL x : ARRAY[0..3] OF INT; END_VAR VAR_GLOBAL RETAIN p : POINTER TO INT; q : "
      "POINTER TO INT; END_VAR PROGRAM P VAR n : INT; END_VAR IF n = 0 THEN p := ADR(x[2]); "
      "q := ADR(x[3]); END_IF n := n + 1; END_PROGRAM");
  boot_with(
      "VAR_GLOBAL new : ARRAY[0..99] OF LINT; x : ARRAY[0..2] OF INT; END_VAR VAR_GLOBAL "
      "RETAIN q : POINTER TO INT; p : POINTER TO INT; END_VAR PROGRAM P VAR n : INT; END_VAR "
      "IF p <> 0 THEN p^ := 9; END_IF END_PROGRAM");
  EXPECT_EQ(plc_->get("q"), "NULL") << "what it led to is gone";
  plc_->run(1);
  EXPECT_EQ(plc_->get("x[2]"), "9");
}

TEST_F(Carried, X2_RenamedVariablesKeepThemBothWays) {
  begin(program("speed : DINT;"));
  plc_->set("speed", "70000");
  const std::string renamed = program("{renamed from := 'speed'} velocity : INT; x : INT;");
  ASSERT_TRUE(plc_->change(renamed).ok());
  EXPECT_EQ(plc_->get("velocity"), "32767");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("speed"), "70000") << "nobody wrote it during the trial";
  ASSERT_TRUE(plc_->change(renamed).ok());
  plc_->set("velocity", "12");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("speed"), "12");
  plc_->set("speed", "13");
  boot_with(renamed);
  EXPECT_EQ(plc_->get("velocity"), "13");
}

TEST_F(Carried, X2_VariablesMovedIntoAStructureKeepThem) {
  begin(program("speed : DINT;"));
  plc_->set("speed", "70000");
  const std::string moved = "TYPE Drive : STRUCT mode, speed : INT; END_STRUCT END_TYPE " +
                            program("{renamed '.speed' from := 'speed'} drive : Drive;");
  ASSERT_TRUE(plc_->change(moved).ok());
  EXPECT_EQ(plc_->get("drive.speed"), "32767");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("speed"), "70000") << "nobody wrote it during the trial";
  ASSERT_TRUE(plc_->change(moved).ok());
  plc_->set("drive.speed", "12");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("speed"), "12");
  plc_->set("speed", "13");
  boot_with(moved);
  EXPECT_EQ(plc_->get("drive.speed"), "13");
  EXPECT_EQ(plc_->get("drive.mode"), "0");
}

// Retained values are in place before anything of the program runs; then it starts as at a warm
// restart.
TEST_F(Carried, StartCodeFindsThem) {
  const std::string source =
      "VAR_GLOBAL RETAIN r : INT := 3; END_VAR\nFUNCTION_BLOCK F VAR seen : INT; END_VAR METHOD "
      "FB_Init : BOOL VAR_INPUT bInitRetains : BOOL; bInCopyCode : BOOL; END_VAR seen := r; "
      "END_METHOD END_FUNCTION_BLOCK\nPROGRAM P VAR f : F; END_VAR f(); END_PROGRAM";
  begin(source);
  EXPECT_EQ(plc_->get("P.f.seen"), "3");
  plc_->set("r", "8");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("P.f.seen"), "8");
}

// --- a trial that ends with the power -----------------------------------------------

TEST_F(Carried, X5_case55_ALostTrialGoesBackAsUndoDoes) {
  begin(program("gone : INT := 1; narrow : DINT; written : DINT; same : INT;"));
  plc_->set("gone", "11");
  plc_->set("narrow", "100000");
  plc_->set("written", "200000");
  plc_->set("same", "5");
  ASSERT_TRUE(plc_->change(program("narrow : INT; written : INT; same : INT; added : INT;")).ok());
  const base::Digest trial = plc_->status().running;
  EXPECT_EQ(plc_->get("narrow"), "32767");
  plc_->set("written", "7");
  plc_->set("same", "6");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->found().trial_lost, trial);
  EXPECT_EQ(plc_->status().trial_lost, trial);
  const auto events = *online_change::read_journal(disk_, online_change::kJournalFile);
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [&](const auto& entry) {
    return entry.event == online_change::Event::kTrialLost && entry.from == trial;
  }));
  EXPECT_EQ(plc_->get("gone"), "11") << "what the change dropped";
  EXPECT_EQ(plc_->get("narrow"), "100000") << "what it converted, and nobody wrote since";
  EXPECT_EQ(plc_->get("written"), "7") << "what was written since";
  EXPECT_EQ(plc_->get("same"), "6");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_FALSE(plc_->found().trial_lost) << "a lost trial is told once";
  EXPECT_EQ(plc_->get("gone"), "11") << "the same again, before anything was saved";
}

TEST_F(Carried, case57_AnAcceptedChangeThenTheOldProgramOnTheCommandLine) {
  const std::string old_source = program("v : DINT; only_old : INT := 4;");
  begin(old_source);
  plc_->set("v", "1234");
  ASSERT_TRUE(
      plc_->change(program("v : LINT; only_new : INT;"), vm::kPermanent | vm::kAllowLoss).ok());
  plc_->set("v", "1235");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  ASSERT_TRUE(plc_->boot(old_source).ok());
  EXPECT_EQ(plc_->get("v"), "1235");
  EXPECT_EQ(plc_->get("only_old"), "4");
  cut();  // before a save: the layout of the values is that of the other program still
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "1235");
  ASSERT_TRUE(plc_->change(program("v : LINT; only_new : INT;")).ok());
}

TEST_F(Carried, A17_BothVersionsAreStoredUntilOneIsFinal) {
  begin(program("v : INT;"));
  const base::Digest old_version = plc_->status().running;
  ASSERT_TRUE(plc_->change(program("v : DINT;")).ok());
  EXPECT_EQ(plc_->status().boots_next, old_version);
  ASSERT_TRUE(plc_->undo().ok());
  EXPECT_EQ(plc_->status().boots_next, old_version);
  ASSERT_TRUE(plc_->change(program("v : DINT;")).ok());
  const base::Digest new_version = plc_->status().running;
  ASSERT_TRUE(plc_->accept().ok());
  EXPECT_EQ(plc_->status().boots_next, new_version);
  online_change::Recovered found = online_change::Store(disk_, {4096, 64, 64, 8}).take_recovered();
  ASSERT_TRUE(found.boots && found.other);
  EXPECT_EQ(found.boots->digest, new_version);
  EXPECT_EQ(found.other->digest, old_version);
}

TEST_F(Carried, AnEmptyFolderHasNothingToBoot) {
  plc_ = std::make_unique<Plc>(disk_);
  EXPECT_EQ(plc_->boot().error().refusal, base::Refusal::kFileNotFound);
}

TEST_F(Carried, AProgramWithTooMuchToRetainIsRefused) {
  ir::Image image;
  for (int i = 0; i < 2; ++i) image.retain.push_back({64, base::kMaxRetainBytes / 2});
  EXPECT_TRUE(online_change::retained_bytes(image).ok());
  image.retain.push_back({64, 1});
  EXPECT_EQ(online_change::retained_bytes(image).error().refusal, base::Refusal::kTooLarge);
}

// B was there before C, and its slot is free since: on trial again it lies in two slots. What is
// saved on trial has the layout of B, which no next program takes away.
TEST(Retained, D4_case56_AProgramThatWasThereBeforeIsAccepted) {
  const auto steps_by = [](int step) {
    return "PROGRAM Main VAR RETAIN n : DINT; END_VAR n := n + " + std::to_string(step) +
           "; END_PROGRAM";
  };
  sim::SimStorage disk;
  plc::Plc plc(disk);
  ASSERT_TRUE(plc.boot(steps_by(1)).ok());
  plc.run(2);
  const ir::VerifiedImage first = build(steps_by(2), &plc.controller().image());
  const ir::VerifiedImage second = build(steps_by(3), &first.image());
  const ir::VerifiedImage third = build(steps_by(4), &second.image());
  const auto bring = [&](const ir::VerifiedImage& next) {
    ASSERT_TRUE(plc.change(next, vm::kAllowOverrun).ok());
    plc.run(2);
    ASSERT_TRUE(plc.save().ok());
  };
  bring(first);  // on trial below the second one, which so gets the third slot
  bring(second);
  ASSERT_TRUE(plc.accept().ok());
  bring(third);
  ASSERT_TRUE(plc.accept().ok());
  bring(second);
  EXPECT_TRUE(plc.accept().ok());
  EXPECT_EQ(plc.status().change, "idle");
}

}  // namespace
}  // namespace plc
