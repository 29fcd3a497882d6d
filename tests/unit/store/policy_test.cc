// Whose policy counts after a power cut, where edits of both lie on each other (D4).
#include <functional>

#include "tests/unit/store/outage.h"

namespace stvm {
namespace {

using plc::Plc;

// The disks that a cut at any call of `step` leaves.
std::vector<sim::SimStorage> cut_in(Outage& rig, const std::function<base::Status()>& step) {
  std::vector<sim::SimStorage> left;
  rig.disk.before_call = [&] {
    left.push_back(behind_cut(rig.disk));
    left.push_back(rig.disk.after_kill());
  };
  const base::Status done = step();
  rig.disk.before_call = nullptr;
  EXPECT_TRUE(done.ok()) << base::to_string(done.error());
  return left;
}

// Back to what was accepted first: nothing was lost on the way.
void expect_ways_back(Plc& plc, const Outage& rig) {
  while (plc.status().edits != 0) {
    const base::Status undone = plc.undo();
    ASSERT_TRUE(undone.ok()) << base::to_string(undone.error());
  }
  EXPECT_EQ(plc.status().running, rig.digests[0]);
  EXPECT_EQ(plc.get("a"), "70000");
  EXPECT_EQ(plc.get("gone"), "44");
  EXPECT_EQ(plc.get("r"), "5");
}

// A change that is accepted at once is on trial until that is stored. It does not ask to boot, the
// edits below it do: a cut leaves these, or all with it, or it is accepted.
TEST(Policy, D4_X5_APermanentChangeLosesNoEditBelowItThatBoots) {
  Outage rig(vm::kLastEditBoots);
  rig.change(1);
  rig.change(2);
  ASSERT_TRUE(rig.plc.save().ok());
  std::vector<sim::SimStorage> left = cut_in(
      rig, [&] { return rig.plc.change(outage_source(3), vm::kAllowLoss | vm::kPermanent); });
  const base::Digest permanent = rig.plc.status().running;
  EXPECT_EQ(rig.plc.status().edits, 0u);
  EXPECT_FALSE(rig.plc.status().last_edit_boots);
  size_t below = 0;
  size_t all = 0;
  size_t accepted = 0;
  for (sim::SimStorage& disk : left) {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_TRUE(plc.found().alarms.empty());
    EXPECT_FALSE(plc.found().trial_lost.has_value());
    const vm::StatusReport found = plc.status();
    EXPECT_EQ(plc.get("r"), "5");
    if (found.running == rig.digests[2]) {
      ++below;
      EXPECT_EQ(found.edits, 2u);
    } else {
      EXPECT_EQ(found.running, permanent);
      EXPECT_TRUE(found.edits == 3 || found.edits == 0) << found.edits;
      ++(found.edits == 3 ? all : accepted);
    }
    if (found.edits != 0) expect_ways_back(plc, rig);
  }
  EXPECT_GT(below, 0u);
  EXPECT_GT(all, 0u);
  EXPECT_GT(accepted, 0u);
}

// Edits below that do not ask to boot give it nothing: until it is accepted, what was accepted
// before boots.
TEST(Policy, D4_APermanentChangeOnEditsThatDoNotBootBootsWhenItIsAccepted) {
  Outage rig(0);
  rig.change(1);
  std::vector<sim::SimStorage> left = cut_in(
      rig, [&] { return rig.plc.change(outage_source(2), vm::kAllowLoss | vm::kPermanent); });
  size_t accepted = 0;
  for (sim::SimStorage& disk : left) {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_EQ(plc.status().edits, 0u);
    if (plc.status().running == rig.digests[0]) continue;
    ++accepted;
    EXPECT_EQ(plc.status().running, rig.plc.status().running);
  }
  EXPECT_GT(accepted, 0u);
}

// On trial, the newest edit says for all of them what boots; behind its undo the one below does.
TEST(Policy, D4_TheNewestEditSaysForAllWhatBoots) {
  Outage rig(vm::kLastEditBoots);
  rig.change(1);
  ASSERT_TRUE(rig.plc.change(outage_source(2), vm::kAllowLoss).ok());
  EXPECT_FALSE(rig.plc.status().last_edit_boots);
  {
    sim::SimStorage disk = behind_cut(rig.disk);
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_EQ(plc.status().running, rig.digests[0]);
    EXPECT_TRUE(plc.found().trial_lost.has_value());
    EXPECT_EQ(plc.get("a"), "70000");
  }
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_TRUE(rig.plc.status().last_edit_boots);
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.status().running, rig.digests[1]);
  EXPECT_EQ(plc.status().edits, 1u);
}

}  // namespace
}  // namespace stvm
