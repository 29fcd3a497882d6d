// F-01 to F-03: one agent, and a broker that loses, repeats and turns around what it is given, or
// makes it up.
#include "tests/unit/fleet/agents.h"
#include "tools/stvm/fleet_agents.h"

namespace {

using fleet_test::kTopics;
using fleet_test::sign_order;
using fleet_test::SignedAs;
using stvm::AgentAct;
using stvm::FleetOutcome;

std::string program(int step) {
  return "FUNCTION_BLOCK Filler VAR_OUTPUT n : INT; END_VAR n := n + " + std::to_string(step) +
         "; END_FUNCTION_BLOCK PROGRAM Main VAR f : Filler; END_VAR f(); END_PROGRAM";
}

class AgentOfOne : public ::testing::Test {
 protected:
  void SetUp() override {
    base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
    ASSERT_TRUE(folder.ok());
    folder_.emplace(std::move(*folder));
    const std::string path = folder_->file("");
    fleet_.edit(program(1), program(10));
    fleet_.add("line1", program(1));
    fleet_file_.assign(3 * stvm::kAgentPiece - 7, 9);  // the edit itself is the test's
    agent_.emplace(fleet_, hub_, "line1", path.substr(0, path.size() - 1));
    agent_->work();
  }
  stvm::AgentFile put(const base::Bytes& file) {
    const stvm::AgentFile out{base::sha256(file), file.size()};
    for (uint64_t at = 0; at * stvm::kAgentPiece < file.size(); ++at) {
      const uint64_t begin = at * stvm::kAgentPiece;
      const uint64_t size = std::min<uint64_t>(stvm::kAgentPiece, file.size() - begin);
      hub_.publish(kTopics.file(out.digest, std::to_string(at)),
                   base::ByteSpan(file).subspan(begin, size), true);
    }
    return out;
  }
  stvm::AgentOrder order(AgentAct act) {
    auto client = fleet_.connect("line1", "test");
    const vm::StatusReport status = *client->status();
    stvm::AgentOrder out;
    out.act = act;
    out.plan = "0badcafe";
    out.note = note("0badcafe");
    out.base = status.running;
    out.switch_flags = vm::kAllowOverrun | vm::kAllowLoss;
    out.fleet = put(fleet_file_);
    if (act == AgentAct::kCheck || act == AgentAct::kBring) {
      out.package = put(*fleet_.access().package(*client->image(), 0));
    }
    return out;
  }
  std::string note(const std::string& plan) {
    return stvm::fleet_note(fleet_.edit().digest) + ", plan " + plan + " wave 1 by ann";
  }
  void desire(const base::Bytes& payload) {
    hub_.publish(kTopics.of("line1", stvm::kAgentDesired), payload, true);
  }
  // As it came; and the agent works on it.
  base::Bytes give(const stvm::AgentOrder& what, const SignedAs& as) {
    const base::Bytes payload = sign_order(what, as);
    desire(payload);
    agent_->work();
    return payload;
  }
  size_t switches() {
    size_t count = 0;
    auto client = fleet_.connect("line1", "test");
    const auto journal = client->journal();
    for (const auto& entry : *journal) {
      if (entry.event == online_change::Event::kSwitched) ++count;
    }
    return count;
  }
  uint64_t edits() { return fleet_.plc("line1").status().edits; }
  FleetOutcome last_outcome() {
    const auto said = stvm::decode_agent_answer(
        hub_.last(kTopics.of("line1", stvm::kAgentAnswer)));
    EXPECT_TRUE(said.ok());
    return said->row.outcome;
  }
  size_t answers() { return hub_.published(kTopics.of("line1", stvm::kAgentAnswer)); }

  std::optional<tools::TemporaryFolder> folder_;
  fleet_test::Fleet fleet_;
  fleet_test::Hub hub_;
  base::Bytes fleet_file_;
  std::optional<fleet_test::OneAgent> agent_;
};

TEST_F(AgentOfOne, F01_SaysWhatItsControllerIsAndSaysItOnce) {
  const auto all = hub_.retained();
  ASSERT_TRUE(all.contains("plant/1/line1/online"));
  EXPECT_EQ(all.at("plant/1/line1/online"), base::Bytes{'1'});
  const auto about = stvm::decode_agent_about(all.at("plant/1/line1/about"));
  ASSERT_TRUE(about.ok());
  EXPECT_EQ(about->running, fleet_.plc("line1").status().running);
  EXPECT_TRUE(std::ranges::any_of(about->parts, [](const ir::Part& one) {
    return one.name == "Filler" && one.kind == ir::PartKind::kUnit;
  }));
  const base::Bytes& page = all.at("plant/1/line1/status");
  EXPECT_NE(std::string(page.begin(), page.end()).find("\"faulted\":false"), std::string::npos);
  fleet_.plc("line1").run(5);
  for (int i = 0; i < 5; ++i) agent_->look();
  EXPECT_EQ(hub_.published("plant/1/line1/about"), 1u);
  EXPECT_EQ(hub_.published("plant/1/line1/status"), 1u);
  agent_->kill();
  EXPECT_EQ(hub_.retained().at("plant/1/line1/online"), base::Bytes{'0'});
}

TEST_F(AgentOfOne, F02_AnOrderThatComesAgainIsAnsweredAndNotDoneAgain) {
  const base::Bytes payload = give(order(AgentAct::kBring), {});
  ASSERT_TRUE(agent_->answer().has_value());
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kDone) << agent_->log;
  EXPECT_TRUE(agent_->answer()->trace.on_trial);
  EXPECT_EQ(agent_->answer()->order, base::sha256(payload));
  const size_t before = answers();
  for (int i = 0; i < 3; ++i) desire(payload);
  agent_->work();
  EXPECT_EQ(answers(), before + 3);
  agent_->kill();
  agent_->start();
  agent_->work();
  EXPECT_EQ(switches(), 1u);
  EXPECT_EQ(edits(), 1u);
}

TEST_F(AgentOfOne, F02_ACheckChangesNothingAndSaysWhatWouldBe) {
  give(order(AgentAct::kCheck), {});
  EXPECT_EQ(last_outcome(), FleetOutcome::kPossible) << agent_->log;
  EXPECT_EQ(switches(), 0u);
}

// A question is no order: it may come late, and it takes nothing from what is at work or was said.
TEST_F(AgentOfOne, F02_AQuestionTakesNothingFromAnOrder) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  stvm::AgentOrder check = order(AgentAct::kCheck);
  check.plan = "another";
  const std::string topic = kTopics.file(change.package.digest, "0");
  const base::Bytes piece = hub_.retained().at(topic);
  hub_.publish(topic, {}, true);
  const base::Bytes payload = give(change, {.sequence = 2});  // waits for its package
  hub_.publish(kTopics.of("line1", stvm::kAgentDesired), sign_order(check, {.sequence = 1}), false);
  agent_->work();
  EXPECT_EQ(answers(), 0u) << agent_->log;
  hub_.publish(topic, piece, true);
  agent_->work();
  EXPECT_EQ(switches(), 1u) << agent_->log;
  EXPECT_EQ(answers(), 2u) << agent_->log;
  EXPECT_EQ(last_outcome(), FleetOutcome::kHadIt) << agent_->log;
  EXPECT_EQ(agent_->answer()->order, base::sha256(payload)) << "what was said to the order stays";
  const auto about = stvm::decode_agent_about(hub_.retained().at("plant/1/line1/about"));
  EXPECT_EQ(about->plan, change.plan);
  EXPECT_TRUE(about->trace.on_trial);
  EXPECT_EQ(about->edits, 1u);
  // The other way round: the order comes first, and the question is answered after it.
  check.base = about->running;
  check.package = put(base::Bytes(100, 7));
  const std::string other = kTopics.file(check.package.digest, "0");
  const base::Bytes other_piece = hub_.retained().at(other);
  hub_.publish(other, {}, true);
  hub_.publish(kTopics.of("line1", stvm::kAgentDesired), sign_order(check, {.sequence = 3}), false);
  agent_->work();
  give(order(AgentAct::kTakeBack), {.sequence = 4});
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kUndone) << agent_->log;
  const size_t before = answers();
  hub_.publish(other, other_piece, true);
  agent_->work();
  EXPECT_EQ(answers(), before + 1) << agent_->log;
  EXPECT_EQ(last_outcome(), FleetOutcome::kRefused) << agent_->log;  // R0301: another one runs
}

TEST_F(AgentOfOne, F02_DecisionsEndTheTrialAndChangeNothingTwice) {
  stvm::AgentOrder change = order(AgentAct::kBring);
  give(change, {});
  give(order(AgentAct::kTakeBack), {.sequence = 2});
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kUndone) << agent_->log;
  EXPECT_EQ(edits(), 0u);
  give(order(AgentAct::kTakeBack), {.sequence = 3});
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kHadItNot);
  // The change of before comes late: whoever sent it is told so, and the answer to what came after
  // it stands.
  const base::Digest last = agent_->answer()->order;
  desire(sign_order(change, {}));
  agent_->work();
  EXPECT_NE(agent_->log.find("R0425"), std::string::npos);
  EXPECT_EQ(last_outcome(), FleetOutcome::kRefused);
  EXPECT_EQ(agent_->answer()->order, last);
  EXPECT_EQ(switches(), 1u);
  change.plan = "0badcaff";
  change.note = note("0badcaff");
  give(change, {.sequence = 4});
  EXPECT_EQ(edits(), 1u) << agent_->log;
  stvm::AgentOrder accept = order(AgentAct::kMakeFinal);
  accept.plan = "0badcaff";
  give(accept, {.sequence = 5});
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kAccepted) << agent_->log;
  EXPECT_TRUE(agent_->answer()->trace.accepted);
  EXPECT_EQ(edits(), 0u);
}

TEST_F(AgentOfOne, F02_PiecesComeInAnyOrderTwiceAndMadeUp) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  std::vector<mqtt::Message> held;
  hub_.bad_network = [&](const mqtt::Message& message) {
    if (message.topic.find("/file/") == std::string::npos) return std::vector{message};
    held.insert(held.begin(), message);
    mqtt::Message made_up = message;
    made_up.payload.resize(made_up.payload.size() - 1);
    held.insert(held.begin(), made_up);
    made_up.topic.back() = '9';
    held.insert(held.begin(), made_up);
    return std::vector<mqtt::Message>();
  };
  give(change, {});
  hub_.bad_network = {};
  for (int round = 0; round < 2; ++round) {  // the fleet file, then the package
    const std::vector<mqtt::Message> all = std::move(held);
    held.clear();
    for (int twice = 0; twice < 2; ++twice) {
      for (const mqtt::Message& one : all) hub_.publish(one.topic, one.payload, false);
    }
    agent_->work();
  }
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kDone) << agent_->log;
  EXPECT_EQ(switches(), 1u);
}

TEST_F(AgentOfOne, F03_AFileOfTheBrokerIsNotTaken) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  const std::string topic = kTopics.file(change.package.digest, "0");
  base::Bytes good = hub_.retained().at(topic);
  base::Bytes bad = good;
  bad[bad.size() / 2] ^= 1;
  hub_.publish(topic, bad, true);
  const base::Bytes payload = give(change, {});
  EXPECT_NE(agent_->log.find("R0102"), std::string::npos) << agent_->log;
  EXPECT_EQ(switches(), 0u);
  EXPECT_FALSE(agent_->answer().has_value());
  // The order was not used up by that.
  hub_.publish(topic, good, true);
  desire(payload);
  agent_->work();
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kDone) << agent_->log;
}

TEST_F(AgentOfOne, F02_AFileThatDoesNotComeIsGivenUpAndAskedForAgain) {
  stvm::AgentOrder change = order(AgentAct::kBring);
  const std::string topic = kTopics.file(change.package.digest, "0");
  const base::Bytes piece = hub_.retained().at(topic);
  hub_.publish(topic, {}, true);
  const base::Bytes payload = give(change, {});
  agent_->look();
  EXPECT_EQ(agent_->log.find("R0501"), std::string::npos);
  agent_->now_ms += 60'001;
  agent_->look();
  EXPECT_NE(agent_->log.find("R0501"), std::string::npos) << agent_->log;
  hub_.publish(topic, piece, true);
  desire(payload);
  agent_->work();
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kDone) << agent_->log;
}

TEST_F(AgentOfOne, F03_NothingIsDoneThatIsNotSignedForIt) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  const auto refused = [&](const base::Bytes& payload, const char* code) {
    agent_->log.clear();
    desire(payload);
    agent_->work();
    EXPECT_NE(agent_->log.find(code), std::string::npos) << code << ": " << agent_->log;
    EXPECT_EQ(switches(), 0u) << code;
    EXPECT_FALSE(agent_->answer().has_value());
  };
  refused(encode(change), "R0420");
  refused({}, "");
  refused(sign_order(change, {.target = "line2"}), "R0426");
  refused(sign_order(change, {.target = ""}), "R0426");
  refused(sign_order(change, {.expires_s = fleet_test::kAgentNow}), "R0424");
  refused(sign_order(change, {.key = {9}}), "R0422");
  refused(sign_order(change, {.kind = online_change::SignedKind::kPackage}), "R0426");
  base::Bytes flipped = sign_order(change, {});
  flipped[60] ^= 1;
  refused(flipped, "R0");
  flipped = sign_order(change, {});
  flipped.back() ^= 1;
  refused(flipped, "R0102");
  refused(base::Bytes(stvm::kMostOrderBytes + 1, 'S'), "R0204");
  give(change, {});
  EXPECT_EQ(switches(), 1u) << agent_->log;
}

TEST_F(AgentOfOne, F03_AClockThatGoesBackMakesNoExpiredOrderGood) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  give(order(AgentAct::kTakeBack), {.expires_s = fleet_test::kAgentNow + 10});
  EXPECT_EQ(agent_->answer()->row.outcome, FleetOutcome::kHadItNot) << agent_->log;
  agent_->wall_s -= 10LL * 365 * 86'400;
  desire(sign_order(change, {.sequence = 2, .expires_s = fleet_test::kAgentNow}));
  agent_->work();
  EXPECT_NE(agent_->log.find("R0424"), std::string::npos) << agent_->log;
  EXPECT_EQ(switches(), 0u);
  give(change, {.sequence = 2});
  EXPECT_EQ(switches(), 1u) << agent_->log;
}

TEST_F(AgentOfOne, F02_AnAgentThatIsKilledGoesOnWithItsOrder) {
  // The connection to the controller is cut at each message: so is a process that ends there.
  for (int cut = 0; cut < 60; ++cut) {
    stvm::AgentOrder change = order(AgentAct::kBring);
    change.plan = "plan" + std::to_string(cut);
    change.note = note(change.plan);
    int left = cut;
    fleet_.before_message = [&] { return left-- > 0; };
    const uint64_t sequence = 1 + 2 * static_cast<uint64_t>(cut);
    give(change, {.sequence = sequence});
    fleet_.before_message = {};
    agent_->kill();
    agent_->start();
    agent_->work();
    ASSERT_TRUE(agent_->answer().has_value()) << cut << ": " << agent_->log;
    const FleetOutcome outcome = agent_->answer()->row.outcome;
    EXPECT_TRUE(outcome == FleetOutcome::kDone || outcome == FleetOutcome::kHadIt)
        << cut << ": " << agent_->log;
    ASSERT_EQ(edits(), 1u) << cut << ": " << agent_->log;
    stvm::AgentOrder undo = order(AgentAct::kTakeBack);
    undo.plan = change.plan;
    give(undo, {.sequence = sequence + 1});
    ASSERT_EQ(edits(), 0u) << cut << ": " << agent_->log;
  }
}

// Brokers keep what an agent said last, also while nobody reaches it.
TEST_F(AgentOfOne, X608_WhatWasSaidBeforeAnOrderIsNoAnswerToIt) {
  const stvm::FleetMember member{"line1", "line1", false, stvm::PlaceKind::kAtAgent};
  stvm::FleetEdit edit = fleet_.edit();
  edit.path = folder_->file("edit.fleet");
  ASSERT_TRUE(tools::write_file(edit.path, fleet_file_).ok());
  uint64_t sequence = 0;
  stvm::FleetAgentsPorts ports;
  ports.broker = std::make_unique<fleet_test::HubBroker>(hub_, std::nullopt);
  ports.sign = [&](base::ByteSpan content, const std::string&, const std::string&) {
    const auto order = stvm::decode_agent_order(content);
    return base::Result<base::Bytes>(sign_order(*order, {.sequence = ++sequence}));
  };
  ports.wall_s = [] { return fleet_test::kAgentNow; };
  ports.package = [&](const base::Bytes& running) { return fleet_.access().package(running, 0); };
  stvm::FleetAgents::Settings settings;
  settings.topics = kTopics;
  settings.plan = "0badcafe";
  settings.patience_ms = 1;
  stvm::FleetAgents tool(std::move(settings), std::move(ports), {member});
  while (!tool.is_online(member)) {
  }  // until the tool has heard what the broker keeps
  EXPECT_TRUE(tool.look(member, "0badcafe").answers);
  stvm::FleetTalk talk(true);
  const stvm::FleetRow row =
      tool.decide(AgentAct::kTakeBack, edit, fleet_test::quietly(), talk, member);
  EXPECT_EQ(row.outcome, FleetOutcome::kUnreachable);
  EXPECT_FALSE(tool.look(member, "0badcafe").answers);
  agent_->work();
  while (!tool.look(member, "0badcafe").answers) {
  }
}

TEST_F(AgentOfOne, F02_MessagesOfAgentsAreReadBackOrRefused) {
  const stvm::AgentOrder change = order(AgentAct::kBring);
  const base::Bytes bytes = encode(change);
  ASSERT_TRUE(stvm::decode_agent_order(bytes).ok());
  EXPECT_EQ(encode(*stvm::decode_agent_order(bytes)), bytes);
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(stvm::decode_agent_order(base::ByteSpan(bytes).first(size)).ok()) << size;
  }
  base::Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(stvm::decode_agent_order(longer).ok());
  give(change, {});
  const base::Bytes answer = encode(*agent_->answer());
  EXPECT_EQ(encode(*stvm::decode_agent_answer(answer)), answer);
  EXPECT_FALSE(stvm::decode_agent_answer(base::ByteSpan(answer).first(answer.size() / 2)).ok());
  for (const char* bad : {"", "-", "a/b", "a b", "+", "#"}) EXPECT_FALSE(stvm::is_agent_name(bad));
}

}  // namespace
