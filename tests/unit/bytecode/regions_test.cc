#include "ir/bytecode/regions.h"

#include <gtest/gtest.h>

#include "tests/unit/bytecode/sample_image.h"

namespace {

using namespace sample;

class Regions : public ::testing::Test {
 protected:
  Regions() : image(busy_image()), t(types_of(image)), map(image.types, image.layouts) {}
  // Both lookups must say the same.
  std::optional<ir::Leaf> leaf(ir::Region region, uint32_t offset) {
    const auto slow = ir::leaf_at(image.types, image.layouts, region, offset);
    const auto fast = map.leaf_at(region, offset);
    EXPECT_EQ(slow.has_value(), fast.has_value()) << offset;
    if (slow && fast) {
      EXPECT_EQ(slow->begin, fast->begin);
      EXPECT_EQ(slow->type, fast->type);
    }
    return fast;
  }
  bool has(ir::Region region, uint32_t offset, ir::Region wanted) {
    const bool slow = ir::has_region_at(image.types, image.layouts, region, offset, wanted);
    EXPECT_EQ(slow, map.find(region, offset, wanted).has_value());
    return slow;
  }
  ir::Image image;
  Types t;
  ir::RegionMap map;
};

TEST_F(Regions, LeavesOfAnArea) {
  const ir::Region main{t.main, 0};
  EXPECT_EQ(leaf(main, kX)->kind, ir::LeafKind::kScalar);
  EXPECT_EQ(leaf(main, kX + 1)->begin, kX);
  EXPECT_EQ(leaf(main, kText + 7)->kind, ir::LeafKind::kStringByte);
  EXPECT_EQ(leaf(main, kText + 7)->begin, kText);
  EXPECT_EQ(leaf(main, kNumbers + 5)->begin, kNumbers + 4);
  EXPECT_EQ(leaf(main, kPair + 3)->begin, kPair + 2);
  EXPECT_EQ(leaf(main, kFb)->kind, ir::LeafKind::kInstanceSlot);
  EXPECT_EQ(leaf(main, kFbs + 4)->kind, ir::LeafKind::kInstanceSlot);
  EXPECT_EQ(leaf(main, kFbs + 4)->begin, kFbs + 4);
  EXPECT_FALSE(leaf(main, 5).has_value());    // padding
  EXPECT_FALSE(leaf(main, 120).has_value());  // slack
  EXPECT_FALSE(leaf(main, 0xffffffffu).has_value());
  EXPECT_EQ(leaf({t.counter, 0}, kIo)->kind, ir::LeafKind::kInOutSlot);
}

TEST_F(Regions, EveryOffsetAgreesWithTheLinearLookup) {
  for (uint32_t offset = 0; offset < 160; ++offset) {
    leaf({t.main, 0}, offset);
    leaf({image.globals, 0}, offset);
  }
}

TEST_F(Regions, FlagsOfGlobals) {
  const ir::Region globals{image.globals, 0};
  EXPECT_TRUE(leaf(globals, 4)->input);
  EXPECT_TRUE(leaf(globals, 5)->output);
  EXPECT_TRUE(leaf(globals, 6)->constant);
}

TEST_F(Regions, PartsOfExactType) {
  const ir::Region main{t.main, 0};
  const ir::Region integer{image.types.elementary(ir::Kind::kInt), 0};
  EXPECT_TRUE(has(main, 0, main));
  EXPECT_TRUE(has(main, kPair, {t.pair, 0}));
  EXPECT_TRUE(has(main, kPair, integer));
  EXPECT_TRUE(has(main, kNumbers, {t.numbers, 0}));
  EXPECT_TRUE(has(main, kNumbers + 2, integer));
  EXPECT_FALSE(has(main, kNumbers + 2, {t.numbers, 0}));
  EXPECT_FALSE(has(main, kReal, integer));
  EXPECT_TRUE(has(main, kText, {t.text5, 0}));  // room for at least as much
  EXPECT_FALSE(has(main, kPair + 2, {t.text, 0}));
  EXPECT_FALSE(has(main, kFb, {t.counter, 0}));       // a slot is no area
  EXPECT_TRUE(has(main, kFbs + 4, {t.counters, 1}));  // but an element of its array
  EXPECT_FALSE(has({t.counter, 0}, kIo, integer));    // an in-out is no variable
}

TEST_F(Regions, Indexing) {
  ir::TypeTable types;
  ir::Layouts layouts;
  const auto integer = types.elementary(ir::Kind::kInt);
  const auto matrix = types.array(integer, {{0, 2}, {1, 4}});
  layouts.of.resize(types.size());
  layouts.of[integer.index].size = 2;
  layouts.of[matrix.index].size = 24;
  EXPECT_EQ(ir::region_size(types, layouts, {matrix, 1}), 8u);
  EXPECT_EQ(ir::index_stride(types, layouts, {matrix, 0}), 8u);
  EXPECT_EQ(ir::index_stride(types, layouts, {matrix, 1}), 2u);
  EXPECT_EQ(ir::indexed_region(types, {matrix, 0}), (ir::Region{matrix, 1}));
  EXPECT_EQ(ir::indexed_region(types, {matrix, 1}), (ir::Region{integer, 0}));
  EXPECT_TRUE(ir::has_region_at(types, layouts, {matrix, 0}, 8, {matrix, 1}));
  EXPECT_FALSE(ir::has_region_at(types, layouts, {matrix, 0}, 6, {matrix, 1}));
  EXPECT_EQ(ir::leaf_at(types, layouts, {matrix, 1}, 7)->begin, 6u);
  EXPECT_FALSE(ir::leaf_at(types, layouts, {matrix, 1}, 8).has_value());
}

}  // namespace
