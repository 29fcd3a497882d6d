// How the steps of one area are joined.
#include "online_change/plan/area_steps.h"

#include <gtest/gtest.h>

namespace online_change {
namespace {

UpdateStep copy(uint32_t from, uint32_t to, uint32_t size) {
  UpdateStep step;
  step.how = CopiedValues{from, 0};
  step.to = to;
  step.size = size;
  return step;
}

// What stays in its place has no step, so a gap between two copies may be somebody's.
TEST(AreaSteps, A1_copies_are_joined_side_by_side_only) {
  std::vector<UpdateStep> steps = {copy(8, 108, 4), copy(0, 100, 4), copy(4, 104, 2)};
  join_steps(steps);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].to, 100u);
  EXPECT_EQ(steps[0].size, 6u);
  EXPECT_EQ(steps[1].to, 108u);
  EXPECT_EQ(steps[1].size, 4u);
}

TEST(AreaSteps, A1_copies_of_different_distances_stay_apart) {
  std::vector<UpdateStep> steps = {copy(0, 100, 4), copy(8, 104, 4)};
  join_steps(steps);
  EXPECT_EQ(steps.size(), 2u);
}

}  // namespace
}  // namespace online_change
