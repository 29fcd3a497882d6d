// How far handles go (ir/types/reach.h): where they are inside, past the end, near and lost, on
// every way there.
#include "ir/types/reach.h"

#include <gtest/gtest.h>

#include <random>

namespace ir {
namespace {

constexpr uint32_t kSegment = 0x123;

uint64_t begin_of(Reach reach) { return make_handle(kSegment, reach.begin); }

Reach found_by(Reach reach, uint64_t handle) {
  const Reach all[] = {{reach.begin - 8, reach.begin, false},
                       reach,
                       {reach.end, reach.end + 3, false},
                       {reach.end + 3, reach.end + 9000, false}};
  return reach_of(all, 100'000, handle);
}

uint64_t moved(Reach reach, uint64_t handle, int32_t bytes) {
  return moved_from(found_by(reach, handle), handle, static_cast<uint32_t>(bytes));
}

TEST(Reach, I3_past_the_end_is_the_end_of_its_own_variable) {
  for (const uint32_t size : {1u, 2u, 7u, 1000u}) {
    const Reach reach{100, 100 + size, false};
    const uint64_t end = moved(reach, begin_of(reach), static_cast<int32_t>(size));
    EXPECT_EQ(handle_offset(end), reach.end);
    EXPECT_EQ(handle_away(end), 1);
    EXPECT_EQ(found_by(reach, end).begin, reach.begin);
    EXPECT_FALSE(found_by(reach, end).covers(handle_offset(end), 1));
    EXPECT_EQ(moved(reach, end, -static_cast<int32_t>(size)), begin_of(reach));
  }
}

TEST(Reach, I3_one_element_before_the_beginning_comes_back) {
  for (const int32_t element : {1, 2, 4, 8, 32, 128, 512}) {
    const Reach reach{5000, 5000 + static_cast<uint32_t>(element), false};
    const uint64_t before = moved(reach, begin_of(reach), -element);
    EXPECT_NE(handle_away(before), kLost) << element;
    EXPECT_EQ(moved(reach, before, element), begin_of(reach)) << element;
  }
}

// Whatever steps in one direction lead to a place: the handle is the same as by one step. And each
// that is not lost finds its variable.
TEST(Reach, I3_steps_in_one_direction_are_one_step) {
  std::mt19937 random(7);
  for (int round = 0; round < 200'000; ++round) {
    const uint32_t size = 1 + static_cast<uint32_t>(random() >> (random() % 32)) % 40'000;
    const Reach reach{20'000, 20'000 + size, false};
    uint64_t handle = begin_of(reach);
    if (random() % 2 == 0)
      handle = moved(reach, handle, static_cast<int32_t>(random() % 200) - 100);
    if (handle_away(handle) == kLost) continue;
    const int32_t first = static_cast<int32_t>(random() >> (17 + random() % 15));
    const int32_t second = static_cast<int32_t>(random() >> (17 + random() % 15));
    const int32_t sign = random() % 2 == 0 ? 1 : -1;
    if (sign < 0 && first + second > 19'000) continue;
    const uint64_t once = moved(reach, handle, sign * (first + second));
    const uint64_t twice = moved(reach, moved(reach, handle, sign * first), sign * second);
    ASSERT_EQ(once, twice) << size << " " << first << " " << second << " " << sign;
    if (handle_away(once) != kLost) {
      ASSERT_TRUE(reach.holds(anchor_of(once)));
      ASSERT_EQ(moved(reach, once, -sign * (first + second)), handle);
    }
  }
}

TEST(Reach, I3_what_went_too_far_never_comes_back) {
  const Reach reach{100, 104, false};
  uint64_t handle = moved(reach, begin_of(reach), 1000);
  EXPECT_EQ(handle_away(handle), kLost);
  EXPECT_EQ(found_by(reach, handle).size(), 0u);
  handle = moved(reach, handle, -1000);
  EXPECT_EQ(handle_offset(handle), 100u);
  EXPECT_EQ(handle_away(handle), kLost);
}

TEST(Reach, I3_nothing_moves_by_no_bytes) {
  for (const uint64_t handle : {uint64_t{0}, ~uint64_t{0}, make_handle(5, 7), with_away(9, -3)}) {
    EXPECT_EQ(moved_from({}, handle, 0), handle);
  }
}

TEST(Reach, I3_the_variable_is_the_one_that_holds_the_byte) {
  std::vector<Reach> all;
  for (uint32_t count = 0; count < 40; ++count) {
    for (uint32_t offset = 0; offset < 200; ++offset) {
      const uint32_t number = offset / 5;
      const bool inside = number < count && offset % 5 < 3;
      const Reach found = reach_at(all, offset);
      ASSERT_EQ(found.size(), inside ? 3u : 0u) << count << " " << offset;
      if (inside) {
        ASSERT_EQ(found.begin, number * 5);
      }
    }
    all.push_back({count * 5, count * 5 + 3, false});
  }
}

}  // namespace
}  // namespace ir
