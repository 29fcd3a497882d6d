// A recording is a file from anywhere: what it says is bounded before it is played.
#include "tools/stvm/player.h"

#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"

namespace stvm {
namespace {

vm::Recording endless(uint64_t fuel_budget) {
  vm::Recording recording;
  vm::RecordedStart& start = recording.start;
  start.image = plc::build("PROGRAM Main VAR n : DINT; END_VAR"
                           " WHILE TRUE DO n := n + 1; END_WHILE END_PROGRAM\n"
                           "CONFIGURATION c RESOURCE r ON cpu"
                           " TASK t (INTERVAL := T#1ms, PRIORITY := 1);"
                           " PROGRAM Main WITH t : Main; END_RESOURCE END_CONFIGURATION")
                    .encoded();
  start.code_limit = vm::ControllerOptions().code_limit;
  start.fuel_budget = fuel_budget;
  recording.cycles.resize(1);
  return recording;
}

TEST(Player, AScanHasNoMoreFuelThanAnyControllerGives) {
  const uint64_t most = vm::ControllerOptions().fuel_budget;
  Player usual(endless(most));
  EXPECT_EQ(usual.start().error().refusal, base::Refusal::kReplayDiffers) << "it is played";
  Player forged(endless(most + 1));
  const base::Status refused = forged.start();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kBadRecording) << refused.error().text;
}

}  // namespace
}  // namespace stvm
