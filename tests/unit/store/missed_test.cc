// What the operator is told of a switch and of an undo: the releases that they made late, all of
// them and no others. In virtual time a switch takes what the model of the pause says.
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

std::string source(const char* type) {
  return std::string("CONFIGURATION c TASK Fast (INTERVAL := T#200us); PROGRAM P WITH Fast : ") +
         "Main; END_CONFIGURATION PROGRAM Main VAR a : ARRAY[1..800000] OF " + type +
         "; n : DINT; END_VAR n := n + 1; END_PROGRAM";
}

class Missed : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(plc_.boot(source("DINT")).ok());
    plc_.run(5);
  }
  // Nobody gave the controller any time: what it misses here is no switch's affair.
  void stall() {
    plc_.clock().advance(7'000'000);
    plc_.run(2);
    ASSERT_GE(missed(), 6u);
  }
  uint64_t missed() { return plc_.controller().missed_releases(); }
  online_change::SwitchReport report_of(vm::Command command, uint32_t flags) {
    vm::Request request{.command = command};
    request.flags = flags;
    base::Result<base::Bytes> body = plc_.answer_to(std::move(request));
    EXPECT_TRUE(body.ok()) << base::to_string(body.error());
    if (!body.ok()) return {};
    auto report = stvm::decode_switch_report(*body);
    EXPECT_TRUE(report.ok());
    return report.ok() ? *report : online_change::SwitchReport();
  }
  online_change::SwitchReport report_of_switch(const char* type) {
    EXPECT_TRUE(plc_.stage(build(source(type), &plc_.controller().image())).ok());
    return report_of(vm::Command::kSwitch, vm::kAllowLoss | vm::kAllowOverrun);
  }

  sim::SimStorage disk_;
  Plc plc_{disk_};
};

TEST_F(Missed, C5_ASwitchTellsTheReleasesThatItMadeLate) {
  stall();
  const uint64_t before = missed();
  const online_change::SwitchReport report = report_of_switch("REAL");
  EXPECT_GT(report.missed, 0u);
  EXPECT_EQ(report.missed, missed() - before);
  plc_.run(5);
  EXPECT_EQ(report.missed, missed() - before) << "none of them is noticed later";
}

TEST_F(Missed, C5_ASwitchThatFitsTellsNone) {
  stall();
  const online_change::SwitchReport report = report_of_switch("DINT; more : INT");
  EXPECT_EQ(report.missed, 0u);
}

TEST_F(Missed, C5_AnUndoTellsTheReleasesThatItMadeLate) {
  (void)report_of_switch("REAL");
  stall();
  const uint64_t before = missed();
  const online_change::SwitchReport report = report_of(vm::Command::kUndo, 0);
  EXPECT_GT(report.missed, 0u);
  EXPECT_EQ(report.missed, missed() - before);
}

// A task under another name counts from 0, and one that comes back has what it had.
TEST_F(Missed, X1_ATaskThatGoesTakesNoMissedReleasesWithIt) {
  stall();
  std::string renamed = source("DINT");
  for (size_t at; (at = renamed.find("Fast")) != std::string::npos;) renamed.replace(at, 4, "Slow");
  EXPECT_TRUE(plc_.stage(build(renamed, &plc_.controller().image())).ok());
  const uint64_t before = missed();
  EXPECT_EQ(report_of(vm::Command::kSwitch, vm::kAllowLoss | vm::kAllowOverrun).missed,
            missed() - before);
  EXPECT_GE(missed(), before);
  EXPECT_LT(missed(), before + 100);
  stall();
  const uint64_t before_undo = missed();
  EXPECT_LT(report_of(vm::Command::kUndo, 0).missed, 3u);
  EXPECT_LT(missed(), before_undo + 3);
}

}  // namespace
}  // namespace plc
