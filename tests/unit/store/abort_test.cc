// C9: a change that is being prepared is aborted at once, by a command, by the end of the
// connection that brings it, and by a condition of the user; the standby side is cleared, and the
// next change works. Wherever it comes: the steps are counted, nothing waits.
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "ir/bytecode/symbols.h"
#include "online_change/package/package.h"
#include "tests/sim/heap_use.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

using base::Refusal;
using vm::Command;

const char* const kOld =
    "VAR_GLOBAL RETAIN r : DINT := 1; END_VAR PROGRAM P VAR alarm : BOOL; n : DINT; "
    "data : ARRAY[0..999] OF DINT; END_VAR n := n + 1; data[n MOD 1000] := n; END_PROGRAM";
const char* const kNew =
    "{migration of := 'P'} FUNCTION Move VAR_INPUT n : DINT; END_VAR VAR_OUTPUT more : DINT; "
    "END_VAR more := n; END_FUNCTION VAR_GLOBAL RETAIN r : LINT := 1; END_VAR "
    "PROGRAM P VAR alarm : BOOL; n : DINT; more : DINT; data : ARRAY[0..999] OF LINT; END_VAR "
    "n := n + 1; data[n MOD 1000] := n; END_PROGRAM";

class Aborted : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(plc_.boot(kOld).ok());
    plc_.run(20);
    next_.emplace(build(kNew, &plc_.controller().image()));
    running_ = plc_.status().running;
    hash_ = ir::state_hash(plc_.controller().image(), plc_.controller().memory().view());
  }
  base::Status stage(uint32_t flags, const char* unless = nullptr, const std::string& note = {}) {
    auto package =
        online_change::make_package(plc_.controller().verified().encoded(), next_->encoded());
    EXPECT_TRUE(package.ok());
    vm::Request upload{.command = Command::kUpload};
    upload.data = online_change::encode(*package);
    vm::Request stage{.command = Command::kStage};
    stage.digest = base::sha256(upload.data);
    stage.flags = flags;
    if (unless != nullptr) stage.names = {unless};
    if (!note.empty()) stage.names = {"", note};
    base::Status done = ask_as(1, std::move(upload));
    return done.ok() ? ask_as(1, std::move(stage)) : done;
  }
  base::Status make_switch(uint32_t flags = vm::kAllowLoss) {
    vm::Request change{.command = Command::kSwitch};
    change.flags = flags;
    return ask_as(1, std::move(change));
  }
  base::Status ask_as(uint64_t session, vm::Request request) {
    plc_.service().asked_by("user" + std::to_string(session), session);
    return plc_.ask(std::move(request));
  }
  std::vector<online_change::JournalEntry> journal() { return plc_.store().history(); }

  // The old program runs with its values, what was taken is given back, and it is said why.
  void expect_gone(const std::string& why, const std::string& where) {
    const vm::StatusReport now = plc_.status();
    EXPECT_EQ(now.change, "idle") << where;
    EXPECT_EQ(now.running, running_) << where;
    EXPECT_EQ(now.boots_next, running_) << where;
    EXPECT_FALSE(plc_.store().tries(next_->digest())) << where << ": it is stored as on trial";
    EXPECT_NE(now.aborted.find(why), std::string::npos) << where << ": " << now.aborted;
    ASSERT_FALSE(journal().empty());
    EXPECT_EQ(journal().back().event, online_change::Event::kCancelled) << where;
    EXPECT_NE(journal().back().text.find(why), std::string::npos) << journal().back().text;
    const base::Status later = make_switch();
    ASSERT_FALSE(later.ok());
    EXPECT_EQ(later.error().refusal, Refusal::kDeadline) << where;
  }
  void expect_next_works(uint32_t flags, const std::string& where) {
    ASSERT_TRUE(stage(flags).ok()) << where;
    EXPECT_EQ(plc_.status().aborted, "") << where;
    const base::Status done = make_switch(vm::kAllowLoss | vm::kAllowOverrun);
    ASSERT_TRUE(done.ok()) << where << base::to_string(done.error());
    EXPECT_GE(std::stoi(plc_.get("P.more")), 20) << where << ": the migration has its value";
  }

  sim::SimStorage disk_;
  Plc plc_{disk_};
  std::optional<ir::VerifiedImage> next_;
  base::Digest running_{};
  base::Digest hash_{};
};

// What the journal says of a change by whoever brought it: of this one, and not for ever.
TEST_F(Aborted, E33_ANoteIsOfOneChangeAndBounded) {
  ASSERT_TRUE(stage(0, nullptr, "fleet file 0123 " + std::string(60000, 'x')).ok());
  ASSERT_TRUE(stage(vm::kRehearsal, nullptr, "a dry run").ok());
  ASSERT_TRUE(stage(0, nullptr, "fleet file 0123 " + std::string(60000, 'x')).ok());
  ASSERT_TRUE(make_switch(vm::kAllowLoss | vm::kAllowOverrun).ok());
  const std::string text = journal().back().text;
  EXPECT_NE(text.find("edit E1, fleet file 0123 xxx"), std::string::npos) << text;
  EXPECT_LT(text.size(), 200u);
  ASSERT_TRUE(ask_as(1, {.command = Command::kUndo}).ok());
  ASSERT_TRUE(stage(0).ok());
  ASSERT_TRUE(make_switch(vm::kAllowLoss | vm::kAllowOverrun).ok());
  EXPECT_EQ(journal().back().text.find("fleet"), std::string::npos) << journal().back().text;
}

enum class By : uint8_t { kCommand, kConnection };

class AbortedAt : public Aborted, public ::testing::WithParamInterface<std::pair<uint32_t, By>> {};

TEST_P(AbortedAt, C9_WhereverSomebodyEndsItTheOldProgramRunsOn) {
  const auto [strategy, by] = GetParam();
  const std::string why =
      by == By::kCommand ? "by operator" : "because the connection of user1 has ended";
  int looks = 0;
  for (bool came = true; came; ++looks) {
    came = false;
    int look = 0;
    const std::string where = "look " + std::to_string(looks);
    plc_.service().meanwhile = [&, by = by] {
      if (look++ != looks) return;
      came = true;
      if (by == By::kConnection) return plc_.service().asker_left();
      const auto answer = plc_.service().answer_urgent(
          "operator", vm::encode(vm::Request{.command = Command::kAbort}));
      ASSERT_TRUE(answer.has_value()) << where;
      EXPECT_TRUE(vm::decode_answer(*answer).ok()) << where;
    };
    base::Status done = stage(strategy);
    if (done.ok()) done = make_switch();
    plc_.service().meanwhile = nullptr;
    if (!came) {
      EXPECT_TRUE(done.ok()) << base::to_string(done.error());
      break;
    }
    ASSERT_FALSE(done.ok()) << where;
    EXPECT_EQ(done.error().refusal, Refusal::kDeadline) << where << base::to_string(done.error());
    EXPECT_NE(done.error().text.find(why), std::string::npos) << done.error().text;
    expect_gone(why, where);
    if (looks % 4 != 0) continue;
    expect_next_works(strategy, where);
    ASSERT_TRUE(plc_.undo().ok());
  }
  EXPECT_GT(looks, 9);
}

INSTANTIATE_TEST_SUITE_P(, AbortedAt,
                         ::testing::Values(std::pair(0u, By::kCommand),
                                           std::pair(uint32_t{vm::kByStandby}, By::kCommand),
                                           std::pair(uint32_t{vm::kByStandby}, By::kConnection)));

// Nobody is asked in the middle of the switch, nor behind it: what is said to be aborted is.
TEST_F(Aborted, C9_ASwitchThatIsMadeIsNotAborted) {
  int late = 0;
  plc_.service().meanwhile = [&] {
    if (plc_.controller().verified().digest() == next_->digest()) ++late;
  };
  ASSERT_TRUE(stage(0).ok());
  ASSERT_TRUE(make_switch().ok());
  EXPECT_EQ(late, 0);
  vm::Request abort{.command = Command::kAbort};
  EXPECT_FALSE(plc_.service().answer_urgent("operator", vm::encode(abort)).has_value());
  base::Result<base::Bytes> answer = plc_.answer_to(abort);
  ASSERT_TRUE(answer.ok());
  base::Result<vm::AbortAnswer> aborted = vm::decode_abort_answer(*answer);
  ASSERT_TRUE(aborted.ok());
  EXPECT_FALSE(aborted->done);
  EXPECT_NE(aborted->text.find("`stvm undo`"), std::string::npos);
  EXPECT_EQ(plc_.status().change, "trial");
}

TEST_F(Aborted, C9_OneThatIsStagedIsAbortedByCommandAndByTheEndOfItsConnection) {
  const uint64_t before = sim::heap_use();
  for (const bool by_command : {true, false}) {
    ASSERT_TRUE(stage(vm::kByStandby).ok());
    plc_.service().ended(7);
    EXPECT_EQ(plc_.status().change, "prepared") << "somebody else's connection";
    if (by_command) {
      ASSERT_TRUE(ask_as(2, {.command = Command::kAbort}).ok());
      expect_gone("by user2", "staged");
    } else {
      plc_.service().ended(1);
      expect_gone("because the connection of user1 has ended", "staged");
    }
    EXPECT_EQ(ir::state_hash(plc_.controller().image(), plc_.controller().memory().view()), hash_);
  }
  EXPECT_LE(sim::heap_use(), before + (1u << 20));
  expect_next_works(vm::kByStandby, "afterwards");
}

TEST_F(Aborted, C9_AnUploadIsAborted) {
  vm::Request part{.command = Command::kUpload};
  part.data.assign(100, 1);
  ASSERT_TRUE(ask_as(1, part).ok());
  ASSERT_TRUE(ask_as(2, {.command = Command::kAbort}).ok());
  part.offset = 100;
  EXPECT_EQ(ask_as(1, part).error().refusal, Refusal::kDeadline);
  const auto nothing = plc_.answer_to({.command = Command::kAbort});
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(nothing->front(), 0) << "nothing is being prepared";
}

// --- a condition of the user -----------------------------------------------------------

// TRUE at boundary k, for each: where that is before the switch, there is none.
TEST_F(Aborted, C9_NothingIsSwitchedWhileTheConditionIsTrue) {
  for (const uint32_t strategy : {0u, uint32_t{vm::kByStandby}}) {
    int boundaries = 0;
    int aborted = 0;
    for (bool came = true; came; ++boundaries) {
      came = false;
      int number = 0;
      bool switched_first = false;
      plc_.at_boundary = [&] {
        if (number++ == boundaries) {
          came = true;
          switched_first = plc_.controller().verified().digest() == next_->digest();
          plc_.set("P.alarm", "TRUE");
        }
        return vm::Boundary::Outcome::kDone;
      };
      base::Status done = stage(strategy, "P.alarm");
      if (done.ok()) done = make_switch();
      plc_.at_boundary = nullptr;
      plc_.set("P.alarm", "FALSE");
      if (came && !switched_first) {
        ASSERT_FALSE(done.ok()) << boundaries;
        EXPECT_EQ(done.error().refusal, Refusal::kDeadline) << boundaries;
        expect_gone("by the condition `P.alarm`, which is TRUE", std::to_string(boundaries));
        ++aborted;
      } else {
        EXPECT_TRUE(done.ok()) << base::to_string(done.error());
        ASSERT_TRUE(plc_.undo().ok());
      }
    }
    EXPECT_GT(aborted, 4);
  }
}

// While somebody thinks about the report, the controller looks by itself.
TEST_F(Aborted, C9_TheConditionEndsOneThatIsStaged) {
  ASSERT_TRUE(stage(0, "P.alarm").ok());
  EXPECT_LE(plc_.service().keep_up_ms(), 20);
  plc_.service().keep_up();
  EXPECT_EQ(plc_.status().change, "prepared");
  plc_.set("P.alarm", "TRUE");
  plc_.service().keep_up();
  expect_gone("by the condition `P.alarm`, which is TRUE", "staged");
  EXPECT_EQ(stage(0, "P.alarm").error().refusal, Refusal::kDeadline);
  EXPECT_EQ(stage(vm::kRehearsal, "P.alarm").error().refusal, Refusal::kDeadline);
  plc_.set("P.alarm", "FALSE");
  expect_next_works(0, "afterwards");
}

TEST_F(Aborted, C9_TheConditionIsABoolOfTheRunningProgram) {
  EXPECT_EQ(stage(0, "P.n").error().refusal, Refusal::kBadValue);
  EXPECT_EQ(stage(0, "P.more").error().refusal, Refusal::kNoSuchVariable);
}

// While its parts come: whoever brings it is told that it was aborted, and by whom.
TEST_F(Aborted, C9_WhileItsPartsCome) {
  auto package =
      online_change::make_package(plc_.controller().verified().encoded(), next_->encoded());
  ASSERT_TRUE(package.ok());
  const base::Bytes bytes = online_change::encode(*package);
  const auto part = [&](uint64_t offset, uint64_t end) {
    vm::Request upload{.command = Command::kUpload};
    upload.offset = offset;
    upload.data.assign(bytes.begin() + static_cast<ptrdiff_t>(offset),
                       bytes.begin() + static_cast<ptrdiff_t>(end));
    return ask_as(1, std::move(upload));
  };
  vm::Request stage{.command = Command::kStage};
  stage.digest = base::sha256(bytes);
  stage.flags = vm::kAllowLoss;
  for (const bool all : {false, true}) {
    ASSERT_TRUE(part(0, all ? bytes.size() : 100).ok());
    ASSERT_TRUE(ask_as(2, {.command = Command::kAbort}).ok());
    EXPECT_EQ(journal().back().event, online_change::Event::kCancelled);
    const base::Status next = all ? ask_as(1, stage) : part(100, bytes.size());
    ASSERT_FALSE(next.ok());
    EXPECT_EQ(next.error().refusal, Refusal::kDeadline) << base::to_string(next.error());
    EXPECT_NE(next.error().text.find("by user2"), std::string::npos) << next.error().text;
  }
  ASSERT_TRUE(part(0, bytes.size()).ok());  // and the next one works
  EXPECT_TRUE(ask_as(1, stage).ok());
}

}  // namespace
}  // namespace plc
