// F-02, F-03: orders that wait at a broker, from the side of the tool: each run of it has a plan of
// its own, and what it leaves there is done once or never.
#include <atomic>
#include <thread>

#include "tests/unit/fleet/agents.h"
#include "tools/stvm/fleet_agents.h"

namespace fleet_test {
namespace {

using stvm::AgentAct;
using stvm::FleetMember;
using stvm::FleetOutcome;
using stvm::FleetRow;

std::string filler(int step, int own = 0) {
  return "FUNCTION_BLOCK Filler VAR_OUTPUT n : INT; END_VAR n := n + " + std::to_string(step) +
         "; END_FUNCTION_BLOCK FUNCTION Own : INT Own := " + std::to_string(own) +
         "; END_FUNCTION PROGRAM Main VAR f : Filler; c : INT; END_VAR f(); c := Own(); "
         "END_PROGRAM";
}

class WaitingOrders : public ::testing::Test {
 protected:
  // Agents are at work in a thread of their own; those that are away are not.
  class Here {
   public:
    Here(WaitingOrders& test, std::vector<std::string> names)
        : thread_([this, &test, names = std::move(names)] {
            while (!stops_) {
              for (const std::string& name : names) test.agent(name).work();
              std::this_thread::yield();
            }
          }) {}
    ~Here() {
      stops_ = true;
      thread_.join();
    }

   private:
    std::atomic<bool> stops_{false};
    std::thread thread_;
  };

  void SetUp() override {
    base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
    ASSERT_TRUE(folder.ok());
    folder_.emplace(std::move(*folder));
    fleet_.edit(filler(1), filler(10));
    edit_ = fleet_.edit();
    edit_.path = folder_->file("edit.fleet");
    const base::Bytes content(100, 9);  // the edit itself is the test's
    ASSERT_TRUE(tools::write_file(edit_.path, content).ok());
  }
  void add(const std::string& name, const std::string& source) {
    fleet_.add(name, source);
    const std::string path = folder_->file("");
    agents_[name].emplace(fleet_, hub_, name, path.substr(0, path.size() - 1));
    agent(name).work();
  }
  OneAgent& agent(const std::string& name) { return *agents_.at(name); }

  // One run of the tool: what is sent is signed by `key_`.
  std::unique_ptr<stvm::FleetAgents> tool(const std::vector<std::string>& names) {
    stvm::FleetAgentsPorts ports;
    ports.broker = std::make_unique<HubBroker>(hub_, std::nullopt);
    ports.sign = [this](base::ByteSpan content, const std::string& target, const std::string&) {
      SignedAs as;
      as.target = target;
      as.sequence = ++sequence_;
      as.key = key_;
      return base::Result<base::Bytes>(sign_order(*stvm::decode_agent_order(content), as));
    };
    ports.wall_s = [this] { return wall_s_; };
    ports.package = [this](const base::Bytes& running) {
      return fleet_.access().package(running, 0);
    };
    stvm::FleetAgents::Settings settings;
    settings.topics = kTopics;
    settings.plan = "plan" + std::to_string(++runs_);
    settings.patience_ms = patience_ms_;
    settings.who = "ann";
    std::vector<FleetMember> members;
    for (const std::string& name : names) members.push_back(member(name));
    return std::make_unique<stvm::FleetAgents>(std::move(settings), std::move(ports), members);
  }
  static FleetMember member(const std::string& name) {
    return {name, name, false, stvm::PlaceKind::kAtAgent};
  }
  std::vector<FleetRow> change(const std::vector<std::string>& names, bool dry_run = false) {
    const auto run = tool(names);
    stvm::SwitchOptions how = quietly();
    how.dry_run = dry_run;
    std::vector<FleetRow> rows;
    stvm::FleetTalk talk(true);
    for (const std::string& name : names) {
      rows.push_back(run->change(edit_, how, talk, member(name)));
    }
    return rows;
  }
  FleetRow decide(AgentAct act, const std::string& name) {
    stvm::FleetTalk talk(true);
    return tool({name})->decide(act, edit_, quietly(), talk, member(name));
  }
  uint64_t edits(const std::string& name) { return fleet_.plc(name).status().edits; }
  base::Bytes desired(const std::string& name) {
    return hub_.retained()[kTopics.of(name, stvm::kAgentDesired)];
  }
  size_t pieces() {
    size_t count = 0;
    for (const auto& [topic, payload] : hub_.retained()) {
      count += topic.find("/file/") == std::string::npos ? 0 : 1;
    }
    return count;
  }
  static std::string why(const FleetRow& row) { return row.why ? base::to_string(*row.why) : ""; }

  std::optional<tools::TemporaryFolder> folder_;
  Fleet fleet_;
  stvm::FleetEdit edit_;
  Hub hub_;
  std::map<std::string, std::optional<OneAgent>> agents_;
  online_change::PublicKey key_ = kOffice;
  uint64_t sequence_ = 0;
  int runs_ = 0;
  int64_t patience_ms_ = 500;
  int64_t wall_s_ = kAgentNow;
};

// E-27: away, so that its order waits; what is asked meanwhile takes nothing from that.
TEST_F(WaitingOrders, F02_WhatIsAskedLeavesTheOrderThatWaits) {
  add("one", filler(1));
  add("two", filler(1));
  agent("two").kill();
  {
    const Here here(*this, {"one"});
    const std::vector<FleetRow> rows = change({"one", "two"});
    EXPECT_EQ(rows[0].outcome, FleetOutcome::kDone) << why(rows[0]);
    EXPECT_EQ(rows[1].outcome, FleetOutcome::kUnreachable);
    EXPECT_NE(why(rows[1]).find("the order waits for it"), std::string::npos) << why(rows[1]);
  }
  const base::Bytes order = desired("two");
  ASSERT_FALSE(order.empty());
  for (const bool dry_run : {true, false}) {
    const FleetRow row = change({"two"}, dry_run)[0];
    EXPECT_EQ(row.outcome, FleetOutcome::kUnreachable);
    EXPECT_EQ(why(row).find("the order waits"), std::string::npos) << why(row);
    EXPECT_EQ(desired("two"), order) << dry_run;
  }
  agent("two").start();
  agent("two").work();
  EXPECT_EQ(edits("two"), 1u) << agent("two").log;
  // So does an undo.
  agent("two").kill();
  EXPECT_EQ(decide(AgentAct::kTakeBack, "two").outcome, FleetOutcome::kUnreachable);
  change({"two"}, true);
  agent("two").start();
  agent("two").work();
  EXPECT_EQ(edits("two"), 0u) << agent("two").log;
}

TEST_F(WaitingOrders, F02_WhoIsAwayGetsAnOrderByTheProgramOfAnother) {
  add("away", filler(1));
  add("other", filler(1, 7));
  add("here", filler(1));
  agent("away").kill();
  {
    const Here here(*this, {"other", "here"});
    const std::vector<FleetRow> rows = change({"away", "other", "here"});
    EXPECT_NE(why(rows[0]).find("the order waits for it"), std::string::npos) << why(rows[0]);
    EXPECT_EQ(rows[1].outcome, FleetOutcome::kDone) << why(rows[1]);
    EXPECT_EQ(rows[2].outcome, FleetOutcome::kDone) << why(rows[2]);
  }
  agent("away").start();
  agent("away").work();
  EXPECT_EQ(edits("away"), 1u) << agent("away").log;
  // Nobody else has its program: it gets none, and that is said.
  agent("other").kill();
  EXPECT_EQ(decide(AgentAct::kTakeBack, "other").outcome, FleetOutcome::kUnreachable);
  agent("other").start();
  agent("other").work();
  agent("other").kill();
  const Here here(*this, {"away", "here"});
  const std::vector<FleetRow> rows = change({"other", "here"});
  EXPECT_NE(why(rows[0]).find("nothing new is ordered"), std::string::npos) << why(rows[0]);
}

TEST_F(WaitingOrders, F02_WhatWasRefusedIsNotDoneLater) {
  add("one", filler(1));
  key_ = {9};
  {
    const Here here(*this, {"one"});
    const FleetRow row = change({"one"})[0];
    EXPECT_EQ(row.outcome, FleetOutcome::kRefused);
    EXPECT_NE(why(row).find("R0422"), std::string::npos) << why(row);
  }
  EXPECT_TRUE(desired("one").empty());
  // Here an order is refused; a change asks for the program first.
  key_ = kOffice;
  agent("one").trust({9});
  const auto run = tool({"one"});
  {
    const Here here(*this, {"one"});
    stvm::FleetTalk talk(true);
    const FleetRow row =
        run->decide(AgentAct::kTakeBack, edit_, quietly(), talk, member("one"));
    EXPECT_EQ(row.outcome, FleetOutcome::kRefused);
    EXPECT_NE(why(row).find("R0422"), std::string::npos) << why(row);
  }
  EXPECT_TRUE(desired("one").empty()) << "already, though the run goes on";
}

// Its agent is there, and its controller is not: as for one that is away.
TEST_F(WaitingOrders, F02_AnOrderWaitsForTheControllerToo) {
  add("one", filler(1));
  add("two", filler(1));
  fleet_.cut_off("two");
  {
    const Here here(*this, {"one", "two"});
    const std::vector<FleetRow> rows = change({"one", "two"});
    EXPECT_EQ(rows[0].outcome, FleetOutcome::kDone) << why(rows[0]);
    EXPECT_EQ(rows[1].outcome, FleetOutcome::kUnreachable);
    EXPECT_NE(why(rows[1]).find("the order waits for it"), std::string::npos) << why(rows[1]);
  }
  agent("two").look();
  agent("two").work();
  EXPECT_EQ(edits("two"), 0u);
  fleet_.cut_off("");
  agent("two").look();
  agent("two").work();
  EXPECT_EQ(edits("two"), 1u) << agent("two").log;
  // Taken back before it comes: then it does nothing.
  {
    const Here here(*this, {"one", "two"});
    EXPECT_EQ(decide(AgentAct::kTakeBack, "two").outcome, FleetOutcome::kUndone);
  }
  fleet_.cut_off("two");
  {
    const Here here(*this, {"one", "two"});
    EXPECT_EQ(decide(AgentAct::kTakeBack, "one").outcome, FleetOutcome::kUndone);
    EXPECT_EQ(change({"one", "two"})[1].outcome, FleetOutcome::kUnreachable);
  }
  hub_.publish(kTopics.of("two", stvm::kAgentDesired), {}, true);
  agent("two").work();
  fleet_.cut_off("");
  agent("two").look();
  agent("two").work();
  EXPECT_EQ(edits("two"), 0u) << agent("two").log;
}

TEST_F(WaitingOrders, F03_AnOrderThatWasWithdrawnIsNotDoneWhenItIsShownAgain) {
  add("one", filler(1));
  add("two", filler(1));
  agent("two").kill();
  {
    const Here here(*this, {"one"});
    change({"one", "two"});
  }
  const base::Bytes change_order = desired("two");
  EXPECT_EQ(decide(AgentAct::kTakeBack, "two").outcome, FleetOutcome::kUnreachable);
  agent("two").start();
  agent("two").work();
  EXPECT_EQ(agent("two").answer()->row.outcome, FleetOutcome::kHadItNot) << agent("two").log;
  const base::Digest answered = agent("two").answer()->order;
  for (int restarted = 0; restarted < 2; ++restarted) {
    hub_.publish(kTopics.of("two", stvm::kAgentDesired), change_order, true);
    agent("two").work();
    EXPECT_EQ(edits("two"), 0u) << agent("two").log;
    EXPECT_NE(agent("two").log.find("R0425"), std::string::npos) << agent("two").log;
    EXPECT_EQ(agent("two").answer()->order, answered);
    agent("two").kill();
    agent("two").start();
  }
}

// An order that was answered after its tool had ended: the next run takes it away, with its files.
TEST_F(WaitingOrders, F02_FilesGoWithTheOrdersThatNameThem) {
  add("one", filler(1));
  add("two", filler(1, 2));
  add("three", filler(1));
  agent("two").kill();
  agent("three").kill();
  {
    const Here here(*this, {"one"});
    change({"one", "three"});
  }
  EXPECT_TRUE(desired("one").empty());
  EXPECT_FALSE(desired("three").empty());
  const size_t of_three = pieces();
  EXPECT_GT(of_three, 0u);
  {
    // Another run, of another controller: what waits for `three` is not its own to take away.
    const Here here(*this, {"one"});
    EXPECT_EQ(decide(AgentAct::kTakeBack, "one").outcome, FleetOutcome::kUndone);
    EXPECT_EQ(change({"one"})[0].outcome, FleetOutcome::kDone);
  }
  EXPECT_EQ(pieces(), of_three);
  agent("three").start();
  agent("three").work();
  EXPECT_EQ(edits("three"), 1u) << agent("three").log;
  EXPECT_EQ(pieces(), of_three);
  {
    const Here here(*this, {"three"});
    EXPECT_EQ(change({"three"})[0].outcome, FleetOutcome::kHadIt);
    EXPECT_EQ(pieces(), of_three) << "who only looks takes nothing away";
    EXPECT_EQ(decide(AgentAct::kTakeBack, "three").outcome, FleetOutcome::kUndone);
  }
  EXPECT_EQ(pieces(), 0u);
  EXPECT_TRUE(desired("three").empty());
  // One that nobody has ever answered goes when it has long expired.
  agent("three").kill();
  {
    const Here here(*this, {"one"});
    EXPECT_EQ(decide(AgentAct::kTakeBack, "one").outcome, FleetOutcome::kUndone);
    EXPECT_EQ(change({"one"})[0].outcome, FleetOutcome::kDone);
    EXPECT_EQ(decide(AgentAct::kTakeBack, "three").outcome, FleetOutcome::kUnreachable);
    EXPECT_GT(pieces(), 0u);
    wall_s_ += 3 * 86'400;
    EXPECT_EQ(decide(AgentAct::kTakeBack, "one").outcome, FleetOutcome::kUndone);
  }
  EXPECT_EQ(pieces(), 0u);
  EXPECT_TRUE(desired("three").empty());
}

// An order is older than another one by when it was signed; that is said, not passed over.
TEST_F(WaitingOrders, F03_WhoseClockIsBehindIsToldSo) {
  add("one", filler(1));
  const Here here(*this, {"one"});
  sequence_ = 1000;
  EXPECT_EQ(change({"one"})[0].outcome, FleetOutcome::kDone);
  sequence_ = 1;
  const FleetRow row = decide(AgentAct::kTakeBack, "one");
  EXPECT_EQ(row.outcome, FleetOutcome::kRefused);
  EXPECT_NE(why(row).find("R0425"), std::string::npos) << why(row);
  EXPECT_EQ(edits("one"), 1u);
  // Who only asks is answered: that changes nothing.
  EXPECT_EQ(change({"one"}, true)[0].outcome, FleetOutcome::kHadIt);
  EXPECT_TRUE(desired("one").empty());
}

// X6: no roll-out begins there; --permanent ends the trial.
TEST_F(WaitingOrders, X602_E31_AnEditThatIsThereOnTrialIsToldFromOneThatIsAccepted) {
  add("one", filler(1));
  const Here here(*this, {"one"});
  EXPECT_EQ(change({"one"})[0].outcome, FleetOutcome::kDone);
  stvm::FleetTalk talk(true);
  stvm::SwitchOptions rolls = quietly();
  rolls.guard = {1};
  FleetRow row = tool({"one"})->change(edit_, rolls, talk, member("one"));
  EXPECT_EQ(row.outcome, FleetOutcome::kRefused);
  EXPECT_NE(why(row).find("R0302"), std::string::npos) << why(row);
  stvm::SwitchOptions for_good = quietly();
  for_good.switch_flags |= vm::kPermanent;
  row = tool({"one"})->change(edit_, for_good, talk, member("one"));
  EXPECT_EQ(row.outcome, FleetOutcome::kAccepted) << why(row);
  EXPECT_EQ(edits("one"), 0u);
  EXPECT_EQ(tool({"one"})->change(edit_, rolls, talk, member("one")).outcome,
            FleetOutcome::kHadIt);
}

}  // namespace
}  // namespace fleet_test
