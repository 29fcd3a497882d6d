// E-14, E-27 to E-32 with whole controllers in one process: others change them in between, and one
// run goes through a hundred.
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/stvm/fleet_edits.h"
#include "tools/stvm/fleet_matrix.h"
#include "tools/stvm/fleet_walk.h"

namespace fleet_test {
namespace {

using base::Refusal;
using stvm::FleetOutcome;
using stvm::FleetRow;

// Three blocks, each of which counts by a step of its own.
std::string project(int a, int b, int c, const std::string& more = {}) {
  const auto block = [](const char* name, int step) {
    return std::string("FUNCTION_BLOCK ") + name + " VAR_OUTPUT n : INT; END_VAR n := n + " +
           std::to_string(step) + "; END_FUNCTION_BLOCK\n";
  };
  return block("A", a) + block("B", b) + block("C", c) + more +
         "PROGRAM Main VAR a1 : A; b1 : B; c1 : C; END_VAR a1(); b1(); c1(); END_PROGRAM\n";
}

// What runs there.
base::Digest running(plc::Plc& plc) { return plc.status().running; }
std::string edits(Fleet& fleet, const std::string& name) {
  base::Result<stvm::ControllerClient> client = fleet.connect(name, "tester");
  auto all = client->edits();
  std::string out;
  for (const stvm::TrialEdit& edit : *all) out += edit.name + (edit.undone ? "- " : " ");
  return out;
}

// Somebody else changes a controller: to a program of that source. What is only staged stays so as
// long as her connection, which is kept.
base::Status changes(Fleet& fleet, const std::string& name, const std::string& source,
                     std::vector<stvm::ControllerClient>* kept = nullptr) {
  base::Result<stvm::ControllerClient> client = fleet.connect(name, "eve");
  EXPECT_TRUE(client->status().ok());
  base::Result<base::Bytes> image = client->image();
  const ir::VerifiedImage now = *ir::verify(*image);
  const ir::VerifiedImage next = plc::build(source, &now.image());
  auto package = online_change::make_package(now.encoded(), next.encoded());
  base::Status staged = client->stage(online_change::encode(*package), 0);
  if (kept != nullptr) kept->push_back(std::move(*client));
  if (!staged.ok() || kept != nullptr) return staged;
  auto report = client->make_switch(vm::kAllowOverrun);
  return report.ok() ? base::Status(base::Ok{}) : report.error();
}

class FleetOfThree : public ::testing::Test {
 protected:
  void SetUp() override {
    fleet_.edit(project(1, 1, 1), project(2, 20, 1));
    for (const char* name : {"one", "two", "three"}) fleet_.add(name, project(1, 1, 1));
  }
  std::vector<FleetRow> change() {
    stvm::FleetChange change(fleet_.edit(), quietly(), fleet_.access());
    return go([&](const stvm::FleetMember& member) { return change.visit(member); });
  }
  std::vector<FleetRow> undo() {
    stvm::FleetUndo undo(fleet_.edit(), quietly(), fleet_.access());
    return go([&](const stvm::FleetMember& member) { return undo.visit(member); });
  }
  std::vector<FleetRow> accept() {
    stvm::FleetAccept accept(fleet_.edit(), quietly(), fleet_.access());
    return go([&](const stvm::FleetMember& member) { return accept.visit(member); });
  }
  std::vector<FleetRow> go(std::function<FleetRow(const stvm::FleetMember&)> visit) {
    stvm::FleetWalk how;
    how.visit = std::move(visit);
    how.told = [](const stvm::FleetMember&, const FleetRow&) {};
    return walk(fleet_.members(), how);
  }
  static std::string outcomes(const std::vector<FleetRow>& rows) {
    std::string out;
    for (const FleetRow& row : rows) {
      out += (out.empty() ? "" : ", ") + std::string(outcome_name(row.outcome));
      if (row.why) out += std::string(" ") + base::refusal_code(row.why->refusal);
    }
    return out;
  }
  // The edit, by a client that has not asked for its report yet.
  stvm::ControllerClient staged_on_two() {
    base::Result<stvm::ControllerClient> client = fleet_.connect("two", "fleet");
    EXPECT_TRUE(client->status().ok());
    base::Result<base::Bytes> image = client->image();
    base::Result<base::Bytes> package = fleet_.access().package(*image, 0);
    EXPECT_TRUE(client->stage(*package, 0).ok());
    return std::move(*client);
  }
  // Of what was staged nothing was switched.
  void expect_refused(stvm::ControllerClient& client) {
    base::Result<stvm::Outcome> outcome = bring_staged(quietly(), client);
    ASSERT_TRUE(outcome.ok());
    ASSERT_TRUE(outcome->refused.has_value());
    EXPECT_EQ(outcome->refused->refusal, Refusal::kStaleBase);
  }
  Fleet fleet_;
};

// Eve is faster: behind the check, and before the package that was made by it arrives.
TEST_F(FleetOfThree, E14_AChangeBehindTheCheckRefusesThisControllerAlone) {
  int packages = 0;
  fleet_.before_package = [&] {
    if (++packages != 2) return;
    ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9)).ok());
  };
  const std::vector<FleetRow> rows = change();
  EXPECT_EQ(outcomes(rows), "done, refused R0301, done");
  EXPECT_NE(rows[1].why->text.find("made by eve"), std::string::npos) << rows[1].why->text;
  EXPECT_EQ(edits(fleet_, "two"), "E1 ") << "hers runs on";
  fleet_.plc("two").run(1);
  EXPECT_EQ(outcomes(change()), "had it, done, had it") << "the same again";
  EXPECT_EQ(edits(fleet_, "two"), "E1 E2 ");
}

// Between what was staged and its switch: while somebody thinks about the report, and before the
// report was fetched.
TEST_F(FleetOfThree, E14_AChangeBetweenStageAndSwitchRefusesThisControllerAlone) {
  const base::Digest before = running(fleet_.plc("two"));
  int asked = 0;
  std::vector<stvm::ControllerClient> hers;
  stvm::SwitchOptions how = quietly();
  how.ask = true;
  for (const bool only_staged : {true, false}) {
    asked = 0;
    std::vector<FleetRow> rows;
    for (const stvm::FleetMember& member : fleet_.members()) {
      base::Result<stvm::ControllerClient> client = fleet_.connect(member.name, "fleet");
      ASSERT_TRUE(client->status().ok());
      base::Result<base::Bytes> image = client->image();
      base::Result<base::Bytes> package = fleet_.access().package(*image, 0);
      ASSERT_TRUE(package.ok());
      how.confirm = [&]() -> base::Status {
        if (++asked == 2)
          return changes(fleet_, "two", project(1, 1, 9), only_staged ? &hers : nullptr);
        return base::Ok{};
      };
      base::Result<stvm::Outcome> outcome = bring(how, *client, *package);
      ASSERT_TRUE(outcome.ok());
      const bool late = member.name == "two";
      ASSERT_EQ(outcome->refused.has_value(), late);
      const Refusal why = late ? outcome->refused->refusal : Refusal::kStaleBase;
      EXPECT_EQ(why, Refusal::kStaleBase);
      ASSERT_TRUE(late || fleet_.plc(member.name).undo().ok());
    }
    EXPECT_EQ(running(fleet_.plc("two")) == before, only_staged);
    EXPECT_EQ(edits(fleet_, "two"), only_staged ? "" : "E1 ");
  }
}

// The request for the report does not take over what another one has staged in the meantime.
TEST_F(FleetOfThree, E14_WhatOthersStageBeforeTheReportIsNotSwitched) {
  stvm::ControllerClient client = staged_on_two();
  std::vector<stvm::ControllerClient> hers;
  ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9), &hers).ok());
  expect_refused(client);
  EXPECT_EQ(edits(fleet_, "two"), "");
}

// Of an edit that is brought again nobody has the package: its edition alone tells.
TEST_F(FleetOfThree, E14_WhatOthersStageIsNotSwitchedByRedo) {
  ASSERT_EQ(outcomes(change()), "done, done, done");
  ASSERT_TRUE(fleet_.plc("two").undo().ok());
  base::Result<stvm::ControllerClient> client = fleet_.connect("two", "fleet");
  ASSERT_TRUE(client->status().ok());
  ASSERT_TRUE(client->stage_again("E1").ok());
  std::vector<stvm::ControllerClient> hers;
  ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9), &hers).ok());
  expect_refused(*client);
  EXPECT_EQ(edits(fleet_, "two"), "E1- ");
}

// A controller that was started anew counts its editions from 0 again: what is staged there is
// told by its package.
TEST_F(FleetOfThree, E14_TheSwitchNamesThePackageThatWasChecked) {
  stvm::ControllerClient client = staged_on_two();
  plc::Plc& plc = fleet_.plc("two");
  ASSERT_TRUE(plc.boot().ok());
  std::vector<stvm::ControllerClient> hers;
  ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9), &hers).ok());
  ASSERT_EQ(plc.status().edition, 1u) << "the same as before";
  auto report = client.make_switch(vm::kAllowOverrun);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().refusal, Refusal::kStaleBase);
  EXPECT_NE(report.error().text.find("by eve"), std::string::npos) << report.error().text;
  EXPECT_EQ(edits(fleet_, "two"), "");
}

// The newest edit, one below an edit of others, one that depends on it, and the same again.
TEST_F(FleetOfThree, E32_UndoTakesTheEditBackWhereItIs) {
  ASSERT_EQ(outcomes(change()), "done, done, done");
  ASSERT_TRUE(changes(fleet_, "two", project(2, 20, 9)).ok());
  ASSERT_TRUE(changes(fleet_, "three", project(3, 20, 1)).ok());
  const std::vector<FleetRow> rows = undo();
  EXPECT_EQ(outcomes(rows), "undone, undone, refused R0320");
  EXPECT_EQ(rows[1].edits, "E1");
  EXPECT_EQ(edits(fleet_, "one"), "E1- ");
  EXPECT_EQ(edits(fleet_, "two"), "E1 E2 E3 ") << "an edit of its own takes it out";
  EXPECT_EQ(edits(fleet_, "three"), "E1 E2 ");
  plc::Plc& two = fleet_.plc("two");
  two.run(1);
  two.set("Main.a1.n", "0");
  two.set("Main.c1.n", "0");
  two.run(1);
  EXPECT_EQ(two.get("Main.a1.n") + two.get("Main.c1.n"), "19") << "A as it was, C as she made it";
  EXPECT_EQ(outcomes(undo()), "had it not, had it not, refused R0320") << "the same again";
  ASSERT_TRUE(fleet_.plc("two").undo().ok());
  EXPECT_EQ(outcomes(undo()), "had it not, undone, refused R0320") << "it had come again";
  ASSERT_TRUE(fleet_.plc("three").undo().ok());
  EXPECT_EQ(outcomes(undo()), "had it not, had it not, undone");
  ASSERT_EQ(outcomes(change()), "done, done, done");
  ASSERT_EQ(outcomes(accept()), "accepted, refused R0302, accepted") << "hers is below";
  fleet_.cut_off("two");
  EXPECT_EQ(outcomes(undo()), "refused R0305, unreachable R0404, refused R0305") << "it is final";
}

// What others have on trial below it would become final without their word.
TEST_F(FleetOfThree, E32_AcceptMakesItFinalAndNothingOfOthers) {
  ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9)).ok());
  ASSERT_EQ(outcomes(change()), "done, done, done");
  ASSERT_TRUE(changes(fleet_, "three", project(2, 20, 9)).ok());
  fleet_.cut_off("one");
  std::vector<FleetRow> rows = accept();
  EXPECT_EQ(outcomes(rows), "unreachable R0404, refused R0302, accepted");
  EXPECT_NE(rows[1].why->text.find("E1 by eve"), std::string::npos) << rows[1].why->text;
  EXPECT_EQ(edits(fleet_, "two"), "E1 E2 ");
  EXPECT_EQ(edits(fleet_, "three"), "E2 ") << "hers is on trial still";
  fleet_.cut_off("");
  rows = accept();
  EXPECT_EQ(outcomes(rows), "accepted, refused R0302, had it");
  EXPECT_EQ(edits(fleet_, "one"), "");
  EXPECT_EQ(outcomes(accept()), "had it, refused R0302, had it");
}

// The same again with --permanent, where it is on trial: that ends there, as by `accept`.
TEST_F(FleetOfThree, E31_PermanentMakesFinalWhatIsOnTrial) {
  ASSERT_TRUE(changes(fleet_, "two", project(1, 1, 9)).ok());
  ASSERT_EQ(outcomes(change()), "done, done, done");
  ASSERT_EQ(outcomes(change()), "had it, had it, had it");
  EXPECT_EQ(edits(fleet_, "one"), "E1 ");
  stvm::SwitchOptions how = quietly();
  how.switch_flags |= vm::kPermanent;
  stvm::FleetChange for_good(fleet_.edit(), how, fleet_.access());
  std::vector<FleetRow> rows;
  for (const auto& member : fleet_.members()) rows.push_back(for_good.visit(member));
  EXPECT_EQ(outcomes(rows), "accepted, refused R0302, accepted");
  EXPECT_EQ(edits(fleet_, "one"), "");
  EXPECT_EQ(edits(fleet_, "two"), "E1 E2 ") << "with one of somebody else below it";
  EXPECT_EQ(for_good.visit(fleet_.members()[0]).outcome, FleetOutcome::kHadIt);
}

// What was undone and brought again is still of the file; an edit of the same name that another
// process made is not.
TEST(FleetEdits, E32_AnEditIsKnownByItsNameAndItsVersions) {
  const base::Digest file{1};
  stvm::TrialEdit edit;
  edit.name = "E1";
  edit.from = {2};
  edit.to = {3};
  online_change::JournalEntry entry;
  entry.event = online_change::Event::kSwitched;
  entry.from = edit.from;
  entry.to = edit.to;
  entry.text = "edit E1, fleet file " + base::short_hex(file);
  EXPECT_EQ(stvm::fleet_edits({edit}, {entry}, file).here.size(), 1u);
  EXPECT_EQ(stvm::fleet_edits({edit}, {entry}, {9}).here.size(), 0u);
  stvm::TrialEdit undone = edit;
  undone.undone = true;
  EXPECT_EQ(stvm::fleet_edits({undone}, {entry}, file).here.size(), 0u);
  for (base::Digest* other : {&edit.from, &edit.to}) {
    const base::Digest before = std::exchange(*other, {7});
    EXPECT_EQ(stvm::fleet_edits({edit}, {entry}, file).here.size(), 0u);
    *other = before;
  }
  entry.event = online_change::Event::kUndone;
  EXPECT_EQ(stvm::fleet_edits({edit}, {entry}, file).here.size(), 0u);
}

// One run through a hundred, eight at once: every tenth has a B of its own, and one is cut off.
TEST(FleetOfHundred, E27_E30_OneRunGoesThroughAHundredControllers) {
  Fleet fleet;
  fleet.edit(project(1, 1, 1), project(2, 20, 1));
  std::map<FleetOutcome, int> counts;
  for (int i = 0; i < 100; ++i) {
    fleet.add("line" + std::to_string(i), project(1, i % 10 == 3 ? 100 : 1, i));
  }
  fleet.cut_off("line55");
  stvm::FleetChange change(fleet.edit(), quietly(), fleet.access());
  stvm::FleetWalk how;
  how.jobs = 8;
  how.visit = [&](const stvm::FleetMember& member) { return change.visit(member); };
  size_t told = 0;
  how.told = [&](const stvm::FleetMember& member, const FleetRow& row) {
    ++told;
    EXPECT_EQ(member.name, row.place);
  };
  const std::vector<FleetRow> rows = walk(fleet.members(), how);
  ASSERT_EQ(rows.size(), 100u);
  EXPECT_EQ(told, 100u);
  for (const FleetRow& row : rows) ++counts[row.outcome];
  EXPECT_EQ(counts[FleetOutcome::kDone], 89);
  EXPECT_EQ(counts[FleetOutcome::kRefused], 10);
  EXPECT_EQ(rows[55].outcome, FleetOutcome::kUnreachable);
  for (int i = 0; i < 100; ++i) {
    plc::Plc& plc = fleet.plc("line" + std::to_string(i));
    plc.set("Main.c1.n", "0");
    plc.run(1);
    EXPECT_EQ(plc.get("Main.c1.n"), std::to_string(i)) << "its own C";
  }
  fleet.cut_off("");
  for (const FleetRow& row : walk(fleet.members(), how)) {
    const bool late = row.place == "line55";
    const bool other = row.place.back() == '3';
    EXPECT_EQ(row.outcome, late    ? FleetOutcome::kDone
                           : other ? FleetOutcome::kRefused
                                   : FleetOutcome::kHadIt);
  }
}

}  // namespace
}  // namespace fleet_test
