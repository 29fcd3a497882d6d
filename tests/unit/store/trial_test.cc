// What the controller does by itself with a version on trial (X7), and in FAULT (case 72).
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/fate_message.h"

namespace stvm {
namespace {

using plc::Plc;

// Traps in its `at`-th scan; `declare` and `policy` as in sources.
std::string program(const std::string& declare, const std::string& body,
                    const std::string& policy = {}) {
  return "PROGRAM Main VAR n : DINT; level : INT := 3; z : INT; " + declare +
         " END_VAR n := n + 1; " + body +
         " END_PROGRAM\n"
         "PROGRAM Other VAR m : DINT; END_VAR m := m + 1; END_PROGRAM\n"
         "CONFIGURATION c RESOURCE r ON cpu " +
         policy +
         " TASK t (INTERVAL := T#1ms, PRIORITY := 1); TASK u (INTERVAL := T#1ms, PRIORITY := 2);"
         " PROGRAM Main WITH t : Main; PROGRAM Other WITH u : Other; END_RESOURCE "
         "END_CONFIGURATION";
}
std::string traps_in(int scan, const std::string& policy = {}) {
  return program("k : DINT;",
                 "k := k + 1; IF k >= " + std::to_string(scan) + " THEN z := 1 / z; END_IF",
                 policy);
}
const std::string kStopTask = "{attribute 'on_trap' := 'stop_task'}";

struct Rig {
  explicit Rig(const std::string& policy = {}) : plc(disk) {
    EXPECT_TRUE(plc.boot(program({}, {}, policy)).ok());
    plc.run(5);
    plc.set("Main.level", "77");
  }
  std::string journal() const {
    std::string text;
    for (const auto& entry : const_cast<Plc&>(plc).store().history()) text += entry.text + "\n";
    return text;
  }
  sim::SimStorage disk;
  Plc plc;
};

void expect_undone(Rig& rig, const std::string& why) {
  EXPECT_EQ(rig.plc.status().change, "idle");
  EXPECT_FALSE(rig.plc.status().faulted);
  EXPECT_EQ(rig.plc.get("Main.level"), "77");
  EXPECT_NE(rig.journal().find(why), std::string::npos) << rig.journal();
  const int64_t before = std::stoll(rig.plc.get("Main.n"));
  rig.plc.run(3);
  EXPECT_EQ(std::stoll(rig.plc.get("Main.n")), before + 3);
}

// By the controller: whoever looks later is told, until somebody changes the program again.
void expect_given_back(Rig& rig, const std::string& why) {
  const std::vector<std::string> alarms = rig.plc.status().alarms;
  ASSERT_EQ(alarms.size(), 1u);
  EXPECT_TRUE(alarms[0].starts_with("E1 undone by the controller at ")) << alarms[0];
  expect_undone(rig, why);
}

TEST(Trial, X7_case72_ATrapInItsFirstScansUndoesIt) {
  Rig rig;
  ASSERT_TRUE(rig.plc.change(traps_in(8)).ok());
  rig.plc.run(2);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "trial");
  rig.plc.run(8);
  EXPECT_TRUE(rig.plc.controller().faulted());
  rig.plc.service().keep_up();
  expect_given_back(rig, "a trap on trial");
  ASSERT_TRUE(rig.plc.change(program("k : DINT;", "k := k + 1;")).ok());
  EXPECT_TRUE(rig.plc.status().alarms.empty());
}

TEST(Trial, X7_ATaskThatStopsAloneUndoesItToo) {
  Rig rig(kStopTask);
  ASSERT_TRUE(rig.plc.change(traps_in(4, kStopTask)).ok());
  rig.plc.run(6);
  EXPECT_FALSE(rig.plc.controller().faulted());
  rig.plc.service().keep_up();
  expect_given_back(rig, "a trap on trial");
}

// A block on trial whose FB_Exit traps whatever happens must not keep it there.
std::string with_bad_exit(const std::string& body, const std::string& policy = {}) {
  return "FUNCTION_BLOCK Bad VAR n, zero : INT; END_VAR METHOD FB_Exit : BOOL VAR_INPUT "
         "bInCopyCode : BOOL; END_VAR n := 1 / zero; END_METHOD END_FUNCTION_BLOCK\n" +
         program("b : Bad; k : DINT;", body, policy);
}

TEST(Trial, X7_AnFbExitThatTrapsKeepsNothingOnTrial) {
  Rig rig(kStopTask);
  const std::string body = "k := k + 1; IF k >= 4 THEN z := 1 / z; END_IF";
  ASSERT_TRUE(rig.plc.change(with_bad_exit(body, kStopTask)).ok());
  rig.plc.run(6);
  rig.plc.service().keep_up();
  expect_given_back(rig, "edit E1, without FB_Exit of Main.b: a trap on trial");
}

TEST(Trial, X4_case34_AnUndoWithoutFbExitIsAskedForAndNoted) {
  Rig rig;
  ASSERT_TRUE(rig.plc.change(with_bad_exit("")).ok());
  rig.plc.run(3);
  EXPECT_EQ(rig.plc.undo().error().refusal, base::Refusal::kExitFailed);
  EXPECT_EQ(rig.plc.status().change, "trial");
  // The report says what will not run, and asking for it does nothing.
  vm::Request fates{.command = vm::Command::kFates, .names = {vm::kWithoutExit}};
  base::Result<base::Bytes> body = rig.plc.answer_to(fates);
  ASSERT_TRUE(body.ok());
  base::Result<FatePage> page = decode_fate_page(*body);
  ASSERT_TRUE(page.ok());
  ASSERT_FALSE(page->system.empty());
  EXPECT_EQ(page->system[0].kind, "FB_Exit");
  EXPECT_EQ(page->system[0].name, "Main.b");
  EXPECT_EQ(rig.plc.status().change, "trial");
  // A way that only a newer controller knows is not taken for the usual one.
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"E1", "in another way"}, {"E1", vm::kWithoutExit, "twice"}}) {
    const base::Status other = rig.plc.ask({.command = vm::Command::kUndo, .names = names});
    ASSERT_FALSE(other.ok());
    EXPECT_EQ(other.error().refusal, base::Refusal::kProtocol);
    EXPECT_EQ(rig.plc.status().change, "trial");
  }
  ASSERT_TRUE(rig.plc.ask({.command = vm::Command::kUndo, .names = {"E1", vm::kWithoutExit}}).ok());
  expect_undone(rig, "edit E1, without FB_Exit of Main.b");
  // After a power cut the version before boots, and what was left out is still noted.
  Plc again(rig.disk);
  ASSERT_TRUE(again.boot().ok());
  EXPECT_EQ(again.get("Main.b.n"), "no Main.b.n");
  std::string noted;
  for (const auto& entry : again.store().history()) noted += entry.text + "\n";
  EXPECT_NE(noted.find("edit E1, without FB_Exit of Main.b\n"), std::string::npos) << noted;
}

// The last scan of the first ones, and the one behind it.
TEST(Trial, X7_OnlyTheFirstScansCount) {
  for (const bool late : {false, true}) {
    Rig rig;
    const int first = static_cast<int>(kProbationCycles);
    const uint64_t before = rig.plc.controller().cycles();
    ASSERT_TRUE(rig.plc.change(traps_in(late ? first + 1 : first)).ok());
    while (!rig.plc.controller().faulted()) rig.plc.run(1);
    const uint64_t trapped = rig.plc.controller().traps().back()->cycle;
    EXPECT_EQ(trapped, before + kProbationCycles - (late ? 0 : 1));
    // However late it is looked at.
    rig.plc.service().keep_up();
    EXPECT_EQ(rig.plc.controller().faulted(), late);
    EXPECT_EQ(rig.plc.status().change, late ? "trial" : "idle");
  }
}

TEST(Trial, X7_AHealthConditionThatFailsUndoesIt) {
  Rig rig;
  const std::string sick =
      program("well : BOOL := TRUE; k : DINT;", "k := k + 1; IF k > 50 THEN well := FALSE; END_IF");
  ASSERT_TRUE(rig.plc.change(plc::build(sick, &rig.plc.controller().image()), vm::kAllowLoss,
                             "Main.well")
                  .ok());
  rig.plc.run(40);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "trial");
  rig.plc.run(20);
  rig.plc.service().keep_up();
  expect_given_back(rig, "the health condition `Main.well` is FALSE");
}

TEST(Trial, X7_WhoeverAsksForItLooksAtTheTrapHimself) {
  Rig rig;
  ASSERT_TRUE(rig.plc.change(traps_in(4), vm::kAllowLoss | vm::kNoWayBack).ok());
  rig.plc.run(10);
  rig.plc.service().keep_up();
  EXPECT_TRUE(rig.plc.controller().faulted());
  EXPECT_EQ(rig.plc.status().change, "trial");
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_FALSE(rig.plc.controller().faulted());
}

// What was stopped before the change stays so: the new version has nothing to do with it.
TEST(Trial, X7_OldTrapsAreNotItsFault) {
  Rig rig(kStopTask);
  ASSERT_TRUE(rig.plc.change(traps_in(2, kStopTask), vm::kAllowLoss | vm::kPermanent).ok());
  rig.plc.run(5);
  ASSERT_TRUE(rig.plc.change(program("k : DINT; more : INT;", "", kStopTask)).ok());
  rig.plc.run(5);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "trial");
}

// A task that was stopped before is left out, and another one is stopped by the new version.
TEST(Trial, X7_AnotherTaskMayBeStoppedThanBefore) {
  Rig rig(kStopTask);
  ASSERT_TRUE(rig.plc.change(traps_in(2, kStopTask), vm::kAllowLoss | vm::kPermanent).ok());
  rig.plc.run(5);
  const std::string other =
      "PROGRAM Other VAR m : DINT; z : INT; END_VAR m := m + 1; z := 1 / z; END_PROGRAM "
      "CONFIGURATION c RESOURCE r ON cpu " +
      kStopTask +
      " TASK u (INTERVAL := T#1ms, PRIORITY := 2); PROGRAM Other WITH u : Other; END_RESOURCE "
      "END_CONFIGURATION";
  ASSERT_TRUE(rig.plc.change(other).ok());
  rig.plc.run(3);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "idle");
}

TEST(Trial, case72_AControllerInFaultTakesAChangeAndGoesOn) {
  for (const uint32_t flags : {uint32_t{vm::kAllowLoss}, vm::kAllowLoss | vm::kPermanent}) {
    Rig rig;
    ASSERT_TRUE(rig.plc.change(traps_in(4), vm::kAllowLoss | vm::kPermanent).ok());
    rig.plc.run(10);
    ASSERT_TRUE(rig.plc.controller().faulted());
    const int64_t before = std::stoll(rig.plc.get("Main.n"));
    ASSERT_TRUE(rig.plc.change(program("k : DINT; more : INT := 9;", ""), flags).ok());
    EXPECT_FALSE(rig.plc.controller().faulted());
    rig.plc.run(3);
    EXPECT_GT(std::stoll(rig.plc.get("Main.n")), before);
    EXPECT_EQ(rig.plc.get("Main.level"), "77");
    EXPECT_EQ(rig.plc.get("Main.more"), "9");
  }
}

// What is new is made, though no task could run when the switch was.
TEST(Trial, case72_FbInitOfWhatIsNewRunsBehindAFault) {
  Rig rig;
  ASSERT_TRUE(rig.plc.change(traps_in(4), vm::kAllowLoss | vm::kPermanent).ok());
  rig.plc.run(10);
  ASSERT_TRUE(rig.plc.controller().faulted());
  const std::string box =
      "FUNCTION_BLOCK Box VAR made : INT; END_VAR METHOD FB_Init : BOOL VAR_INPUT "
      "bInitRetains, bInCopyCode : BOOL; END_VAR made := 5; END_METHOD END_FUNCTION_BLOCK\n";
  ASSERT_TRUE(rig.plc.change(box + program("k : DINT; b : Box;", "")).ok());
  rig.plc.run(2);
  EXPECT_FALSE(rig.plc.controller().faulted());
  EXPECT_EQ(rig.plc.get("Main.b.made"), "5");
}

// case78: dry runs of several connections, beside what others have staged.
class DryRun : public ::testing::Test {
 protected:
  base::Status as(uint64_t session, vm::Request request) {
    rig_.plc.service().asked_by("user" + std::to_string(session), session);
    return rig_.plc.ask(std::move(request));
  }
  base::Status stage(uint64_t session, const std::string& source, uint32_t flags) {
    const ir::VerifiedImage& running = rig_.plc.controller().verified();
    const ir::VerifiedImage next = plc::build(source, &running.image());
    auto package = online_change::make_package(running.encoded(), next.encoded());
    EXPECT_TRUE(package.ok());
    vm::Request upload{.command = vm::Command::kUpload};
    upload.data = online_change::encode(*package);
    vm::Request stage{.command = vm::Command::kStage};
    stage.digest = base::sha256(upload.data);
    stage.flags = flags;
    base::Status done = as(session, std::move(upload));
    return done.ok() ? as(session, std::move(stage)) : done;
  }
  base::Status ask(uint64_t session, vm::Command command) {
    return as(session, vm::Request{.command = command});
  }
  base::Status make_switch(uint64_t session) {
    vm::Request request{.command = vm::Command::kSwitch};
    request.flags = vm::kAllowLoss | vm::kAllowOverrun;
    return as(session, std::move(request));
  }
  Rig rig_;
  const std::string a_ = program("a : DINT;", "");
  const std::string b_ = program("b : DINT;", "");
};

TEST_F(DryRun, case78_NeitherTakesNorEndsWhatAnotherOneHasStaged) {
  ASSERT_TRUE(stage(1, a_, 0).ok());
  const uint64_t edition = rig_.plc.status().edition;
  ASSERT_TRUE(stage(2, b_, vm::kRehearsal).ok());
  EXPECT_EQ(stage(3, b_, vm::kRehearsal).error().refusal, base::Refusal::kChangePending);
  EXPECT_TRUE(ask(2, vm::Command::kFates).ok());
  EXPECT_TRUE(ask(2, vm::Command::kCancel).ok());
  EXPECT_EQ(rig_.plc.status().edition, edition);
  EXPECT_TRUE(make_switch(1).ok());
  EXPECT_EQ(rig_.plc.get("Main.a"), "0");
}

TEST_F(DryRun, case78_OneThatWasReplacedIsToldSo) {
  ASSERT_TRUE(stage(2, b_, vm::kRehearsal).ok());
  const uint64_t edition = rig_.plc.status().edition;
  ASSERT_TRUE(stage(1, a_, 0).ok());
  EXPECT_GT(rig_.plc.status().edition, edition);
  EXPECT_EQ(ask(2, vm::Command::kFates).error().refusal, base::Refusal::kChangePending);
  EXPECT_EQ(ask(2, vm::Command::kRehearse).error().refusal, base::Refusal::kChangePending);
  EXPECT_TRUE(ask(2, vm::Command::kCancel).ok());
  EXPECT_TRUE(make_switch(1).ok());
}

TEST_F(DryRun, case78_EndsWithItsConnectionAndIsNeverSwitched) {
  const uint64_t edition = rig_.plc.status().edition;
  ASSERT_TRUE(stage(2, b_, vm::kRehearsal).ok());
  EXPECT_EQ(rig_.plc.status().edition, edition) << "others go on with what they have seen";
  EXPECT_FALSE(make_switch(2).ok());
  rig_.plc.service().ended(2);
  EXPECT_EQ(rig_.plc.status().change, "idle");
}

// Whoever brings a change can ask for additions only; the controller compares what it runs itself.
TEST_F(DryRun, E16_E22_TheControllerRefusesAnotherTableBeforeItIsStaged) {
  const std::string retyped = std::string(a_).replace(a_.find("level : INT"), 11, "level : LINT");
  const uint64_t edition = rig_.plc.status().edition;
  const base::Status refused = stage(1, retyped, vm::kTableAdditions);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTableEdit);
  EXPECT_EQ(refused.error().text, "the table that runs: `Main.level`: type INT -> LINT");
  EXPECT_EQ(rig_.plc.status().edition, edition) << "nothing is staged";
  EXPECT_FALSE(make_switch(1).ok());
  ASSERT_TRUE(stage(1, a_, vm::kTableAdditions).ok());
  EXPECT_EQ(stage(2, retyped, vm::kRehearsal | vm::kTableAdditions).error().refusal,
            base::Refusal::kTableEdit);
  EXPECT_TRUE(stage(2, retyped, vm::kRehearsal).ok());
  EXPECT_TRUE(make_switch(1).ok());
  EXPECT_EQ(rig_.plc.get("Main.level"), "77");
}

// On trial it is of the version that runs then; the trial and its way back stay.
TEST_F(DryRun, case78_OnTrial) {
  ASSERT_TRUE(stage(1, a_, 0).ok());
  ASSERT_TRUE(make_switch(1).ok());
  ASSERT_TRUE(stage(2, b_, vm::kRehearsal).ok());
  EXPECT_TRUE(ask(2, vm::Command::kFates).ok());
  EXPECT_EQ(rig_.plc.status().change, "trial");
  EXPECT_TRUE(ask(1, vm::Command::kUndo).ok());
  EXPECT_EQ(ask(2, vm::Command::kFates).error().refusal, base::Refusal::kChangePending);
  EXPECT_EQ(rig_.plc.get("Main.level"), "77");
}

}  // namespace
}  // namespace stvm
