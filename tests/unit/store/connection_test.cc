// Case 58: the connection goes at any exchange of a change, before the controller gets the request
// or before the tool gets the answer, so before and after Armed. What runs is one of the two
// versions, status says which, and whoever connects next can go on.
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/controller_client.h"

namespace plc {
namespace {

const char* const kOld =
    "VAR_GLOBAL RETAIN r : INT := 3; END_VAR PROGRAM P VAR n : INT; END_VAR "
    "n := n + 1; END_PROGRAM";
const char* const kNew =
    "VAR_GLOBAL RETAIN r : DINT := 3; END_VAR PROGRAM P VAR n : INT; "
    "more : INT; END_VAR n := n + 1; END_PROGRAM";

// Loses exchange number `number`, and is gone from then on.
class Way : public vm::Transport {
 public:
  Way(vm::Service& service, int number, bool answer_lost, int& count)
      : service_(service), number_(number), answer_lost_(answer_lost), count_(count) {}
  base::Result<base::Bytes> exchange(base::ByteSpan request) override {
    const base::Error gone{base::Refusal::kNotRunning, "the connection is lost"};
    if (++count_ > number_ || (count_ == number_ && !answer_lost_)) return gone;
    bool keep_open = true;
    base::Bytes answer = service_.answer(request, keep_open);
    if (count_ == number_) return gone;
    return answer;
  }

 private:
  vm::Service& service_;
  int number_;
  bool answer_lost_;
  int& count_;
};

constexpr uint32_t kFlags = vm::kAllowLoss | vm::kAllowOverrun;

base::Status change(stvm::ControllerClient& tool, const base::Bytes& package, uint32_t strategy) {
  base::Result<vm::StatusReport> seen = tool.status();
  if (!seen.ok()) return seen.error();
  base::Status staged = tool.stage(package, strategy);
  if (!staged.ok()) return staged;
  auto report = tool.fates();
  if (!report.ok()) return report.error();
  auto switched = tool.make_switch(kFlags);
  if (!switched.ok()) return switched.error();
  seen = tool.status();
  if (!seen.ok()) return seen.error();
  auto accepted = tool.call({.command = vm::Command::kAccept});
  return accepted.ok() ? base::Status(base::Ok{}) : accepted.error();
}

stvm::ControllerClient connected(Plc& plc, int number, bool answer_lost, int& count) {
  return stvm::ControllerClient(std::make_unique<Way>(plc.service(), number, answer_lost, count));
}

// False: there are not so many exchanges.
bool lost_at(int number, bool answer_lost, uint32_t strategy) {
  sim::SimStorage disk;
  Plc plc(disk);
  EXPECT_TRUE(plc.boot(kOld).ok());
  plc.set("r", "7");
  const base::Digest old = plc.status().running;
  const ir::VerifiedImage next = build(kNew, &plc.controller().image());
  const base::Bytes package = online_change::encode(
      *online_change::make_package(plc.controller().verified().encoded(), next.encoded()));
  int count = 0;
  stvm::ControllerClient tool = connected(plc, number, answer_lost, count);
  const base::Status done = change(tool, package, strategy);
  if (count < number) {
    EXPECT_TRUE(done.ok());
    return false;
  }
  EXPECT_FALSE(done.ok());
  plc.run(2);
  const vm::StatusReport now = plc.status();
  EXPECT_TRUE(now.running == old || now.running == next.digest());
  EXPECT_EQ(now.change == "trial", now.running != old && now.boots_next == old);
  EXPECT_EQ(plc.get("r"), "7");
  // Somebody else takes over.
  int others = 0;
  stvm::ControllerClient other = connected(plc, 1000, false, others);
  if (now.running == old) {
    const base::Status again = change(other, package, strategy);
    EXPECT_TRUE(again.ok()) << base::to_string(again.error()) << " at " << number;
  } else if (now.change == "trial") {
    EXPECT_TRUE(other.status().ok());
    EXPECT_TRUE(other.undo().ok());
    EXPECT_EQ(plc.status().running, old);
  }
  EXPECT_EQ(plc.status().change, "idle");
  EXPECT_EQ(plc.status().boots_next, plc.status().running);
  EXPECT_EQ(plc.get("r"), "7");
  return true;
}

TEST(Connection, case58_connection_lost_before_and_after_Armed) {
  for (const uint32_t strategy : {0u, uint32_t{vm::kByStandby}}) {
    for (const bool answer_lost : {false, true}) {
      int number = 1;
      while (lost_at(number, answer_lost, strategy)) ++number;
      EXPECT_EQ(number, 8) << "status, upload, stage, fates, switch, status, accept";
    }
  }
}

}  // namespace
}  // namespace plc
