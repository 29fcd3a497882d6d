// E-23 to E-26: an edit whose units start one after the other, on whole controllers in one process.
#include <gtest/gtest.h>

#include "ir/bytecode/verify.h"
#include "linker/edit_steps.h"
#include "online_change/package/package.h"
#include "tests/unit/fleet/fleet_of_plcs.h"

namespace fleet_test {
namespace {

using linker::StepOrder;
using stvm::FleetOutcome;
using stvm::FleetRow;

// Main calls A and C; A calls B. `more` is a global variable that A uses.
std::string chain(int step, const std::string& more = {}, const std::string& body_of_b = {}) {
  const std::string n = std::to_string(step);
  return (more.empty() ? "" : "VAR_GLOBAL " + more + " : INT; END_VAR\n") +
         "FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR VAR b : B; END_VAR b(); n := n + " + n +
         (more.empty() ? "" : "; " + more + " := n") +
         "; END_FUNCTION_BLOCK\n"
         "FUNCTION_BLOCK B VAR_OUTPUT n, zero : INT; END_VAR n := n + " +
         n + "; " + body_of_b +
         " END_FUNCTION_BLOCK\n"
         "FUNCTION_BLOCK C VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK\n"
         "PROGRAM Main VAR a1 : A; c1 : C; n : INT; END_VAR a1(); c1(); n := n + " +
         n + "; END_PROGRAM\n";
}

std::string joined(const std::vector<std::string>& steps) {
  std::string out;
  for (const std::string& step : steps) out += (out.empty() ? "" : " ") + ir::step_text(step);
  return out;
}

std::string names_of(const std::vector<stvm::Mixture>& mixtures) {
  std::string out;
  for (const stvm::Mixture& one : mixtures) {
    out += joined(one.new_ones) + " | " + joined(one.old_ones) + "\n";
  }
  return out;
}

class Steps : public ::testing::Test {
 protected:
  void start(const std::string& original, const std::string& edited, StepOrder order) {
    fleet_.edit(original, edited);
    fleet_.start_each(order);
    fleet_.add("one", original);
  }
  FleetRow change() {
    stvm::FleetChange change(fleet_.edit(), quietly(), fleet_.access());
    return change.visit(fleet_.members().front());
  }
  plc::Plc& plc() { return fleet_.plc("one"); }
  int edits() {
    base::Result<stvm::ControllerClient> client = fleet_.connect("one", "tester");
    int on_trial = 0;
    const auto all = client->edits();
    for (const stvm::TrialEdit& edit : *all) on_trial += edit.undone ? 0 : 1;
    return on_trial;
  }
  Fleet fleet_;
};

class Orders : public ::testing::Test {
 protected:
  std::string order(StepOrder which) { return joined(*linker::edit_steps(images(), which)); }
  std::string early(const std::vector<std::string>& steps) {
    std::string out;
    const auto before = linker::runs_before(images(), steps);
    for (const linker::RunsBefore& one : *before) {
      out += one.unit + "<" + one.needs + " ";
    }
    return out;
  }
  linker::EditImages images() const { return {original_.image(), edited_.image()}; }
  ir::VerifiedImage original_ = plc::build(chain(1));
  ir::VerifiedImage edited_ = plc::build(chain(2, "seen"), &original_.image());
};

TEST_F(Orders, E23_EachOrderIsOfTheEditedPartsAlone) {
  EXPECT_EQ(order(StepOrder::kTableFirst), "table A B Main");
  EXPECT_EQ(order(StepOrder::kTableLast), "A B Main table");
  EXPECT_EQ(order(StepOrder::kCalleesFirst), "table B A Main");
  EXPECT_EQ(order(StepOrder::kCallersFirst), "table Main A B");
}

TEST_F(Orders, E23_AListHasEachPartOnce) {
  EXPECT_EQ(joined(*linker::listed_steps(images(), {"main", "TABLE", "B", "A"})), "Main table B A");
  EXPECT_EQ(joined(*linker::listed_steps(images(), {"B", "A", "Main"})), "table B A Main");
  const std::vector<std::vector<std::string>> bad = {
      {"A", "B"}, {"A", "A", "B", "Main"}, {"A", "B", "C", "Main"}};
  for (const std::vector<std::string>& one : bad) {
    EXPECT_EQ(linker::listed_steps(images(), one).error().refusal, base::Refusal::kUsage);
  }
}

TEST_F(Orders, E24_WhoRunsBeforeWhatItNeedsIsNamed) {
  EXPECT_EQ(early({"", "B", "A", "Main"}), "");
  EXPECT_EQ(early({"", "A", "B", "Main"}), "A<B ");
  EXPECT_EQ(early({"", "Main", "A", "B"}), "Main<A A<B ");
}

TEST_F(Steps, E25_EachUnitRunsFromABoundaryOfItsOwn) {
  start(chain(1), chain(10, "seen"), StepOrder::kCalleesFirst);
  const FleetRow row = change();
  ASSERT_EQ(row.outcome, FleetOutcome::kDone) << (row.why ? row.why->text : "");
  EXPECT_EQ(names_of(row.mixtures), "table | B A Main\ntable B | A Main\ntable B A | Main\n");
  EXPECT_EQ(edits(), 4);
  for (size_t i = 1; i < row.mixtures.size(); ++i) {
    EXPECT_GT(row.mixtures[i].cycle, row.mixtures[i - 1].cycle);
  }
  const int n = std::stoi(plc().get("Main.n"));
  const int seen = std::stoi(plc().get("seen"));
  plc().run(1);
  EXPECT_EQ(plc().get("Main.n"), std::to_string(n + 10));
  EXPECT_EQ(plc().get("seen"), std::to_string(seen + 10));
  // The same run again has nothing to do.
  EXPECT_EQ(change().outcome, FleetOutcome::kHadIt);
}

TEST_F(Steps, E25_TogetherWhereThereIsRoomElseEachByItself) {
  for (const bool room : {true, false}) {
    Fleet fleet;
    fleet.edit(chain(1), chain(10));
    fleet.start_each(StepOrder::kCalleesFirst, true);
    fleet.add("one", chain(1));
    if (!room) fleet.refuses = {0, base::Refusal::kOutOfMemory};
    stvm::FleetChange change(fleet.edit(), quietly(), fleet.access());
    const FleetRow row = change.visit(fleet.members().front());
    EXPECT_EQ(row.outcome, FleetOutcome::kDone) << (row.why ? row.why->text : "");
    EXPECT_EQ(row.mixtures.size(), room ? 0u : 2u);
  }
  fleet_.edit(chain(1), chain(10));
  fleet_.start_each(StepOrder::kCalleesFirst, true);
  fleet_.add("one", chain(1));
  fleet_.refuses = {0, base::Refusal::kWouldLose};
  EXPECT_EQ(change().outcome, FleetOutcome::kRefused) << "no matter of room";
}

// The last of three steps cannot be made: the others go again.
TEST_F(Steps, E26_AFailureInTheMiddleTakesAllBack) {
  start(chain(1), chain(10), StepOrder::kCalleesFirst);
  const base::Digest before = plc().status().running;
  fleet_.refuses = {3, base::Refusal::kCannotRelink};
  int packages = 0;
  fleet_.before_package = [&] { EXPECT_EQ(edits(), packages++); };
  const FleetRow row = change();
  EXPECT_EQ(row.outcome, FleetOutcome::kTakenBack) << (row.why ? row.why->text : "");
  ASSERT_TRUE(row.why.has_value());
  EXPECT_EQ(row.why->refusal, base::Refusal::kCannotRelink);
  EXPECT_EQ(plc().status().running, before);
  EXPECT_EQ(edits(), 0);
}

// The connection is gone, so the controller does it by itself.
TEST_F(Steps, E26_AConnectionThatEndsInTheMiddleTakesAllBack) {
  start(chain(1), chain(10), StepOrder::kCalleesFirst);
  const base::Digest before = plc().status().running;
  base::Result<stvm::ControllerClient> client = fleet_.connect("one", "ann");
  for (size_t step = 1; step <= 2; ++step) {
    ASSERT_TRUE(client->status().ok());
    const base::Bytes package = *fleet_.access().package(*client->image(), step);
    ASSERT_TRUE(client->stage(package, 0).ok());
    ASSERT_TRUE(client->make_switch(vm::kAllowOverrun | vm::kMoreToCome).ok());
    plc().run(2);
  }
  EXPECT_EQ(edits(), 2);
  client = base::Error{base::Refusal::kNotRunning, "cut"};
  EXPECT_EQ(plc().status().running, before);
  EXPECT_EQ(edits(), 0);
}

// An edit of somebody else on top of one that has not come wholly: its trap is its own affair.
TEST_F(Steps, E26_X7_ATrapOfAnotherEditLeavesWhatHasCome) {
  start(chain(1), chain(10), StepOrder::kCalleesFirst);
  base::Result<stvm::ControllerClient> ann = fleet_.connect("one", "ann");
  ASSERT_TRUE(ann->status().ok());
  ASSERT_TRUE(ann->stage(*fleet_.access().package(*ann->image(), 1), 0).ok());
  ASSERT_TRUE(ann->make_switch(vm::kAllowOverrun | vm::kMoreToCome).ok());
  const base::Digest incomplete = plc().status().running;
  std::string traps = chain(1);
  traps.replace(traps.find("c1();"), 5, "c1(); n := n / (n - n);");
  base::Result<stvm::ControllerClient> eve = fleet_.connect("one", "eve");
  ASSERT_TRUE(eve->status().ok());
  const ir::VerifiedImage now = *ir::verify(*eve->image());
  const ir::VerifiedImage next = plc::build(traps, &now.image());
  const auto package = online_change::make_package(now.encoded(), next.encoded());
  ASSERT_TRUE(eve->stage(online_change::encode(*package), 0).ok());
  ASSERT_TRUE(eve->make_switch(vm::kAllowOverrun).ok());
  plc().run(2);
  plc().service().keep_up();
  EXPECT_EQ(plc().status().running, incomplete);
  EXPECT_EQ(edits(), 1);
}

// A trap of the last unit in its first cycles takes back what came before it, too.
TEST_F(Steps, E26_X7_ATrapInTheMiddleTakesAllBack) {
  start(chain(1), chain(10, {}, "n := n / zero;"), StepOrder::kCallersFirst);
  const base::Digest before = plc().status().running;
  const FleetRow row = change();
  EXPECT_EQ(row.outcome, FleetOutcome::kDone) << "its last unit has come";
  EXPECT_EQ(row.mixtures.size(), 2u);
  plc().run(2);
  plc().service().keep_up();
  EXPECT_EQ(plc().status().running, before);
  EXPECT_EQ(edits(), 0);
}

}  // namespace
}  // namespace fleet_test
