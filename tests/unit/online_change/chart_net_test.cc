// Which steps of a chart can be active together, told from its net alone (change cases 38, 73).
#include "online_change/apply/chart_net.h"

#include <gtest/gtest.h>

namespace {

using online_change::ChartNet;

// A program whose body is a chart of `steps` steps.
ir::Image chart(uint32_t steps, std::vector<ir::ChartMove> moves) {
  ir::Image image;
  ir::Type type;
  type.kind = ir::Kind::kProgram;
  type.name = "P";
  for (uint32_t i = 0; i < steps; ++i) {
    type.members.emplace_back().name = "S" + std::to_string(i);
  }
  ir::TypeTable types;
  const ir::TypeId self = types.declare(std::move(type));
  image.types = std::move(types);
  image.pous.emplace_back().self = self;
  image.charts.push_back({0, std::move(moves)});
  return image;
}
ChartNet net(const ir::Image& image) { return {image, image.pous[0].self}; }

TEST(ChartNet, case73_ASequenceHasOneActiveStep) {
  const ir::Image image = chart(3, {{{}, {0}}, {{0}, {1}}, {{1}, {2}}, {{2}, {0}}});
  const ChartNet sequence = net(image);
  for (uint32_t step = 0; step < 3; ++step) EXPECT_TRUE(sequence.reaches({step}));
  EXPECT_FALSE(sequence.reaches({0, 1}));
  EXPECT_TRUE(sequence.reaches({})) << "it has not begun";
  EXPECT_FALSE(sequence.reaches({7})) << "no step of it";
}

// 0 -> (1, 3); 1 -> 2; (2, 3) -> 4
TEST(ChartNet, case73_BranchesAreActiveTogether) {
  const ir::Image image = chart(5, {{{}, {0}}, {{0}, {1, 3}}, {{1}, {2}}, {{2, 3}, {4}}, {{4}, {0}}});
  const ChartNet branches = net(image);
  EXPECT_TRUE(branches.reaches({1, 3}));
  EXPECT_TRUE(branches.reaches({2, 3}));
  EXPECT_FALSE(branches.reaches({1}));
  EXPECT_FALSE(branches.reaches({3}));
  EXPECT_FALSE(branches.reaches({1, 2}));
  EXPECT_FALSE(branches.reaches({0, 3}));
  EXPECT_FALSE(branches.reaches({1, 2, 3}));
}

// Branches within a branch, alternatives within another: 0 -> (1, 2); 1 -> (3, 4); (3, 4) -> 5;
// 2 -> 6 or 7; 6 -> 8; 7 -> 8; (5, 8) -> 9
TEST(ChartNet, case73_BranchesWithinBranches) {
  const ir::Image image =
      chart(10, {{{}, {0}}, {{0}, {1, 2}}, {{1}, {3, 4}}, {{3, 4}, {5}}, {{2}, {6}}, {{2}, {7}},
                 {{6}, {8}}, {{7}, {8}}, {{5, 8}, {9}}});
  const ChartNet nested = net(image);
  EXPECT_TRUE(nested.reaches({3, 4, 6}));
  EXPECT_TRUE(nested.reaches({5, 7}));
  EXPECT_FALSE(nested.reaches({3, 6}));
  EXPECT_FALSE(nested.reaches({3, 4, 6, 7}));
  EXPECT_FALSE(nested.reaches({9, 8}));
}

TEST(ChartNet, case73_NetworksAreAskedOneByOne) {
  const ir::Image image = chart(4, {{{}, {0}}, {{}, {2}}, {{0}, {1}}, {{2}, {3}}});
  const ChartNet two = net(image);
  EXPECT_TRUE(two.reaches({1})) << "the other one has not begun";
  EXPECT_TRUE(two.reaches({1, 2}));
  EXPECT_FALSE(two.reaches({2, 3}));
}

TEST(ChartNet, case73_WithoutANetNothingIsKnown) {
  EXPECT_FALSE(ChartNet().known());
  ir::Image image = chart(1, {{{}, {0}}});
  image.charts.clear();
  EXPECT_FALSE(net(image).known());
}

// A chart of 20,000 steps, forwards and backwards, is no work to speak of; a net made to be hard is
// given up.
TEST(ChartNet, case73_LongChartsAndHostileOnes) {
  constexpr uint32_t kSteps = 20'000;
  std::vector<ir::ChartMove> moves = {{{}, {0}}};
  for (uint32_t i = 1; i < kSteps; ++i) moves.push_back({{i - 1}, {i}});
  const ir::Image forwards = chart(kSteps, moves);
  EXPECT_TRUE(net(forwards).reaches({kSteps - 1}));
  EXPECT_FALSE(net(forwards).reaches({0, kSteps - 1}));
  std::vector<ir::ChartMove> dense = {{{}, {0}}};
  for (uint32_t i = 1; i < 3000; ++i) {
    ir::ChartMove move{{i}, {}};
    for (uint32_t to = i % 7; to < 3000; to += 1 + i % 11) move.to.push_back(to);
    dense.push_back(std::move(move));
  }
  EXPECT_FALSE(net(chart(3000, dense)).known());
}

}  // namespace
