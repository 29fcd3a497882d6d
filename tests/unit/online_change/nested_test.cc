// Case 81: what is nested deeply is planned in proportion to its depth: steps, allocations, bytes.
#include "base/limits.h"
#include "online_change/package/package.h"
#include "tests/unit/online_change/heap_use.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string number(int i) { return std::to_string(i); }

// S1 in S2 in S3..., each with a variable of its own.
std::string structures(int levels, const char* innermost) {
  std::string text = "TYPE S1 : STRUCT x : " + std::string(innermost) + "; END_STRUCT\n";
  for (int i = 2; i <= levels; ++i) {
    text += "S" + number(i) + " : STRUCT inside : S" + number(i - 1) + "; own : INT; END_STRUCT\n";
  }
  return text + "END_TYPE PROGRAM Main VAR s : S" + number(levels) + "; END_VAR END_PROGRAM";
}

std::string innermost(int levels) {
  std::string path = "Main.s";
  for (int i = 1; i < levels; ++i) path += ".inside";
  return path + ".x";
}

// F1, extended by F2, extended by F3..., each with a variable of its own.
std::string blocks(int levels, const char* first) {
  std::string text =
      "FUNCTION_BLOCK F1 VAR x : " + std::string(first) + "; END_VAR END_FUNCTION_BLOCK\n";
  for (int i = 2; i <= levels; ++i) {
    text += "FUNCTION_BLOCK F" + number(i) + " EXTENDS F" + number(i - 1) + " VAR own" + number(i) +
            " : INT; END_VAR END_FUNCTION_BLOCK\n";
  }
  return text + "PROGRAM Main VAR f : F" + number(levels) + "; END_VAR END_PROGRAM";
}

struct Cost {
  uint64_t steps = 0;
  uint64_t package = 0;  // bytes
  uint64_t data = 0;     // bytes that the new version takes
  tests::HeapUse heap;   // of planning
};

// Of the plan from `before` to `after`; `path` has a value, and must have it after the change.
Cost cost_of(const std::string& before, const std::string& after, const std::string& path) {
  Plant plant(before);
  plant.set(path, "77");
  const ir::Image old_image = plant.controller().image();
  const base::Bytes old_encoded = plant.controller().verified().encoded();
  plant.change(after);
  EXPECT_EQ(plant.get(path), "77");
  Cost cost;
  cost.package = encode(*make_package(old_encoded, plant.controller().verified().encoded())).size();
  cost.data = plant.controller().image().data_capacity;
  cost.heap = tests::heap_use_of([&] {
    base::Result<Plan> made = plan(old_image, plant.controller().image());
    EXPECT_TRUE(made.ok());
    cost.steps = made->steps.size();
  });
  plant.undo();
  EXPECT_EQ(plant.get(path), "77");
  return cost;
}

// Twice as many more levels cost twice as much more; four times would be the square.
void expect_in_proportion(uint64_t few, uint64_t some, uint64_t many, const char* what) {
  EXPECT_LE(many, some + 5 * (some - few) / 2 + 16) << what << ": " << few << " for 25 levels, "
                                                      << some << " for 50, " << many << " for 100";
}

void expect_linear(const Cost& few, const Cost& some, const Cost& many) {
  expect_in_proportion(few.steps, some.steps, many.steps, "steps");
  expect_in_proportion(few.data, some.data, many.data, "bytes of data");
  const auto count = [](const Cost& cost) { return static_cast<uint64_t>(cost.heap.allocations); };
  expect_in_proportion(count(few), count(some), count(many), "allocations");
  // Each level has the pieces of those inside it while a plan is made, so this is no proportion.
  EXPECT_LT(many.heap.bytes, 4u << 20);
}

TEST(Nested, case81_hundred_nested_structures_cost_in_proportion) {
  const auto cost = [](int levels) {
    return cost_of(structures(levels, "INT"), structures(levels, "DINT"), innermost(levels));
  };
  const Cost few = cost(25);
  const Cost some = cost(50);
  const Cost many = cost(100);
  expect_linear(few, some, many);
  expect_in_proportion(few.package, some.package, many.package, "bytes of the package");
}

// The image has all members of each block, those that it inherits too, so a package is no measure.
TEST(Nested, case81_hundred_levels_of_extends_cost_in_proportion) {
  const auto cost = [](int levels) {
    return cost_of(blocks(levels, "INT"), blocks(levels, "DINT"), "Main.f.x");
  };
  expect_linear(cost(25), cost(50), cost(100));
}

// As deep as a program may be.
TEST(Nested, case81_two_hundred_nested_structures_are_changed) {
  const int levels = static_cast<int>(base::kMaxNesting) - 2;
  cost_of(structures(levels, "INT"), structures(levels, "DINT"), innermost(levels));
}

}  // namespace
}  // namespace online_change
