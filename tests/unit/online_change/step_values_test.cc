// Values of steps, found by place, against a list of all of them.
#include "online_change/package/step_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace online_change {
namespace {

UpdateStep step(uint32_t to, uint32_t size, uint32_t count, uint32_t stride) {
  UpdateStep out;
  out.to = to;
  out.size = size;
  out.count = count;
  out.to_stride = stride;
  return out;
}

std::vector<StepValue> all_values(const std::vector<UpdateStep>& steps) {
  std::vector<StepValue> out;
  for (uint32_t s = 0; s < steps.size(); ++s) {
    for (uint32_t i = 0; i < steps[s].count; ++i) {
      out.push_back({steps[s].to + i * steps[s].to_stride, steps[s].size, s, i});
    }
  }
  std::sort(out.begin(), out.end(),
            [](const StepValue& a, const StepValue& b) { return a.to < b.to; });
  return out;
}

void expect_like_all(const std::vector<UpdateStep>& steps, const std::string& text) {
  const StepValues values(steps);
  const std::vector<StepValue> all = all_values(steps);
  uint64_t end = 0;
  bool twice = false;
  for (const StepValue& value : all) {
    twice = twice || value.to < end;
    end = std::max(end, value.end());
  }
  ASSERT_EQ(values.overlap().has_value(), twice) << text;
  if (twice) return;
  for (uint32_t place = 0; place <= end + 2; ++place) {
    const auto wanted = std::find_if(all.begin(), all.end(),
                                     [&](const StepValue& value) { return value.end() > place; });
    const std::optional<StepValue> found = values.first_behind(place);
    ASSERT_EQ(found.has_value(), wanted != all.end()) << text << " at " << place;
    if (!found) continue;
    EXPECT_EQ(found->to, wanted->to) << text << " at " << place;
    EXPECT_EQ(found->size, wanted->size) << text << " at " << place;
    EXPECT_EQ(found->step, wanted->step) << text << " at " << place;
    EXPECT_EQ(found->index, wanted->index) << text << " at " << place;
  }
}

TEST(StepValues, NoneAreNowhere) {
  const StepValues none({});
  EXPECT_FALSE(none.first_behind(0));
  EXPECT_FALSE(none.overlap());
}

// Arrays of structures with several members, arrays inside of them, single values in the gaps.
TEST(StepValues, AreFoundByPlace) {
  std::mt19937 random(7);
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  int sound = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<UpdateStep> steps;
    for (uint32_t groups = 1 + below(3); groups > 0; --groups) {
      const uint32_t begin = below(120);
      const uint32_t stride = 4 + below(12);
      const uint32_t count = 1 + below(6);
      for (uint32_t member = 1 + below(3); member > 0; --member) {
        const uint32_t size = 1 + below(3);
        const bool other = below(8) == 0;
        steps.push_back(step(begin + below(stride - size + 1), size, other ? 1 + below(6) : count,
                             other ? size + below(9) : stride));
      }
    }
    std::shuffle(steps.begin(), steps.end(), random);
    expect_like_all(steps, "round " + std::to_string(round));
    sound += StepValues(steps).overlap() ? 0 : 1;
  }
  EXPECT_GT(sound, 300);
}

TEST(StepValues, AsManyAsAnArrayHasCostNothing) {
  constexpr uint32_t kCount = 400'000'000;
  const StepValues values({step(100, 2, kCount, 8), step(104, 4, kCount, 8), step(40, 1, 1, 0)});
  EXPECT_FALSE(values.overlap());
  EXPECT_EQ(values.first_behind(100 + 8 * (kCount - 1))->index, kCount - 1);
  EXPECT_EQ(values.first_behind(102 + 8 * (kCount - 1))->step, 1u);
  EXPECT_FALSE(values.first_behind(108 + 8 * (kCount - 1)));
}

}  // namespace
}  // namespace online_change
