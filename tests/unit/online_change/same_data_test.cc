// Changes of code alone take short ways: each must end where the long one does.
#include "online_change/plan/same_data.h"

#include <gtest/gtest.h>

#include <random>

#include "linker/link.h"
#include "online_change/package/delta.h"
#include "online_change/package/package.h"
#include "online_change/plan/pou_edits.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string source(const char* body, const char* variables = "", const char* limit = "9") {
  return std::string(
             "FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := 2 * x; END_FUNCTION "
             "FUNCTION_BLOCK Motor VAR_INPUT on : BOOL; END_VAR VAR n : INT; a : ARRAY[1..4] "
             "OF INT; ") +
         variables + " END_VAR " + body +
         " END_FUNCTION_BLOCK PROGRAM Main VAR m : ARRAY[1..3] OF Motor; limit : INT := " + limit +
         "; s : STRING := 'abc'; END_VAR m[1](on := limit > 3); END_PROGRAM";
}
constexpr const char* kBefore = "n := Twice(n) + 1; a[n] := 7;";
constexpr const char* kAfter = "IF on THEN n := Twice(n + 3) - 1234; a[n + 1] := 5; END_IF;";

struct Pair {
  base::Bytes before;
  base::Bytes after;
  ir::Image old_image;
  ir::Image new_image;
  EncodedImage from() const { return {old_image, before}; }
  EncodedImage to() const { return {new_image, after}; }
};

Pair pair_of(const std::string& before, const std::string& after) {
  Plant plant(before);
  auto package = decode(plant.package(after));
  base::check(package.ok(), "a package of a plant");
  Pair pair{plant.controller().verified().encoded(), package->image, {}, {}};
  pair.old_image = *ir::decode(pair.before);
  pair.new_image = *ir::decode(pair.after);
  return pair;
}

void expect_same(const Plan& quick, const Plan& whole) {
  EXPECT_TRUE(whole.steps.empty() && whole.calls.empty() && whole.fates.empty());
  EXPECT_EQ(quick.counts.kept, whole.counts.kept);
  EXPECT_EQ(quick.predicted_pause_ns, whole.predicted_pause_ns);
  EXPECT_EQ(quick.boundary_bytes, whole.boundary_bytes);
}

TEST(SameData, an_edit_of_statements_has_the_plan_that_a_look_at_everything_finds) {
  const Pair pair = pair_of(source(kBefore), source(kAfter));
  ASSERT_TRUE(same_data(pair.from(), pair.to()));
  const SameDataPlans plans = plans_of_same_data(pair.old_image, pair.new_image);
  expect_same(plans.forward, *plan(pair.old_image, pair.new_image));
  expect_same(plans.inverse, *inverse_plan(pair.old_image, pair.new_image));
  const std::vector<PouEdit> edits = pou_edits(pair.from(), pair.to());
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].pou, "Motor");
  EXPECT_EQ(edits[0].instances, 3u);
}

TEST(SameData, declarations_and_initial_values_are_another_matter) {
  for (const std::string& after : {source(kBefore, "more : INT;"), source(kBefore, "", "10"),
                                   source(kBefore, "{renamed from := 'n'} k : INT;")}) {
    const Pair pair = pair_of(source(kBefore), after);
    EXPECT_FALSE(same_data(pair.from(), pair.to())) << after;
  }
}

TEST(SameData, a_short_package_changes_the_program_and_fits_no_other) {
  Plant plant(source(kBefore));
  plant.run(2);
  auto whole = decode(plant.package(source(kAfter)));
  ASSERT_TRUE(whole.ok());
  const base::Bytes running = plant.controller().verified().encoded();
  const base::Bytes bytes = encode_short(*whole, running);
  EXPECT_LT(bytes.size(), whole->image.size() / 2);
  const ir::Image before = *ir::decode(running);
  const ir::Image after = *ir::decode(whole->image);
  EXPECT_EQ(*make_short_package({before, running}, {after, whole->image}), bytes);
  auto again = decode(bytes, running);
  ASSERT_TRUE(again.ok()) << base::to_string(again.error());
  EXPECT_EQ(again->image, whole->image);
  EXPECT_EQ(decode(bytes).error().refusal, base::Refusal::kStaleBase);
  EXPECT_EQ(decode(bytes, whole->image).error().refusal, base::Refusal::kStaleBase);
  for (size_t bit = 0; bit < bytes.size() * 8; bit += 5) {
    base::Bytes damaged = bytes;
    damaged[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    EXPECT_FALSE(decode(damaged, running).ok()) << bit;
  }
  ASSERT_TRUE(plant.stage(bytes).ok());
}

TEST(SameData, deltas_give_the_bytes_back_and_take_any) {
  std::mt19937 random(7);
  base::Bytes from(20000);
  for (uint8_t& byte : from) byte = static_cast<uint8_t>(random() % 7);
  for (int round = 0; round < 200; ++round) {
    base::Bytes to = from;
    for (int edit = 0; edit < 1 + round % 5; ++edit) {
      const size_t at = random() % to.size();
      const size_t size = std::min<size_t>(random() % 300, to.size() - at);
      if (random() % 2 == 0) {
        to.erase(to.begin() + at, to.begin() + at + size);
      } else {
        to.insert(to.begin() + at, size, static_cast<uint8_t>(random()));
      }
      if (to.empty()) to.push_back(1);
    }
    const base::Bytes delta = make_delta(from, to);
    EXPECT_EQ(apply_delta(from, delta, to.size()), to);
    EXPECT_LT(delta.size(), 4000u);
    EXPECT_EQ(apply_delta(from, delta, to.size() - 1), std::nullopt);
    base::Bytes damaged = delta;
    damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1 + random() % 255);
    (void)apply_delta(from, damaged, 1u << 20);
  }
  EXPECT_EQ(apply_delta(from, make_delta(from, {}), 0), base::Bytes());
  EXPECT_EQ(apply_delta({}, make_delta({}, from), from.size()), from);
}

}  // namespace
}  // namespace online_change
