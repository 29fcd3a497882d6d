// FB_Init, FB_Exit and the time they may take; the changes themselves are in tests/golden/change.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

// FB_Exit of b has as many rounds as `rounds` says.
constexpr const char* kTwo = R"(
VAR_GLOBAL inits, exits, rounds : DINT; coil AT %QX0.0 : BOOL; END_VAR
FUNCTION_BLOCK Pump
  VAR i : DINT; END_VAR
  VAR_OUTPUT slow : BOOL; END_VAR
  METHOD FB_Init : BOOL
    VAR_INPUT bInitRetains, bInCopyCode : BOOL; is_slow : BOOL; END_VAR
    inits := inits + 1; slow := is_slow;
  END_METHOD
  METHOD FB_Exit : BOOL
    VAR_INPUT bInCopyCode : BOOL; END_VAR
    coil := NOT bInCopyCode;
    IF slow THEN FOR i := 1 TO rounds DO ; END_FOR END_IF
    exits := exits + 1;
  END_METHOD
END_FUNCTION_BLOCK
PROGRAM P
  VAR a : Pump(FALSE); b : Pump(TRUE); n : DINT; END_VAR
  n := n + 1;
END_PROGRAM
)";

constexpr int64_t kRound = 1000;  // ns

std::vector<uint32_t> pumps(const vm::Controller& controller) {
  std::vector<uint32_t> ids;
  for (uint32_t id = 0; id < controller.image().instances.size(); ++id) {
    const std::string path = controller.image().instance_path(id);
    if (path == "P.a" || path == "P.b") ids.push_back(id);
  }
  return ids;
}

TEST(Leave, EachOnceAndAgainBehindConstruct) {
  Plant plant(kTwo, {}, kRound);
  ASSERT_TRUE(plant.ok());
  plant.cycles(2);
  ASSERT_TRUE(plant->leave(pumps(*plant), kMs).ok());
  EXPECT_EQ(plant.get("exits"), "2");
  ASSERT_TRUE(plant->leave(pumps(*plant), kMs).ok());
  EXPECT_EQ(plant.get("exits"), "2");
  EXPECT_EQ(plant.get("inits"), "2");
  plant->construct();
  plant.cycles(2);
  EXPECT_EQ(plant.get("inits"), "4");
  EXPECT_EQ(plant.get("P.n"), "4");
}

// What takes too long is left out; the program can go on.
TEST(Leave, NoLongerThanTheLimit) {
  Plant plant(kTwo, {}, kRound);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  ASSERT_TRUE(plant->set("rounds", "10000000").ok());
  base::Status left = plant->leave(pumps(*plant), kMs);
  ASSERT_FALSE(left.ok());
  EXPECT_EQ(left.error().refusal, base::Refusal::kExitFailed);
  EXPECT_EQ(plant.get("exits"), "1");
  EXPECT_FALSE(plant->faulted());
  plant->construct();
  plant.cycles(1);
  EXPECT_EQ(plant.get("inits"), "3");  // that of a, which had left
  EXPECT_EQ(plant.get("P.n"), "2");
  ASSERT_TRUE(plant->set("rounds", "10").ok());
  EXPECT_TRUE(plant->leave(pumps(*plant), kMs).ok());
}

// At the end of a run; outputs are sent once more.
TEST(Leave, AllAtTheEnd) {
  Plant plant(kTwo);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  ASSERT_TRUE(plant->leave_all(kMs).ok());
  EXPECT_EQ(plant.get("exits"), "2");
  EXPECT_EQ(plant.get("coil"), "TRUE");
}

}  // namespace
}  // namespace runtime_test
