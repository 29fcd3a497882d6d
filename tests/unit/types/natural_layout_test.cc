// Natural layouts of what an image says it has.
#include "ir/types/natural_layout.h"

#include <gtest/gtest.h>

#include <limits>

namespace ir {
namespace {

// Packed, a structure around a structure takes a byte more; laid out by nature, eight.
TypeId nested(TypeTable& types, uint32_t depth) {
  TypeId inner = types.elementary(Kind::kLint);
  for (uint32_t i = 0; i < depth; ++i) {
    Type outer;
    outer.kind = Kind::kStruct;
    outer.name = "S" + std::to_string(i);
    outer.members.resize(2);
    outer.members[0].name = "inner";
    outer.members[0].type = inner;
    outer.members[1].name = "more";
    outer.members[1].type = types.elementary(Kind::kByte);
    inner = types.declare(std::move(outer));
  }
  return inner;
}

// An image may pack what nature does not: 64 MiB of 16 bytes each are 9 GiB then.
TEST(NaturalLayout, WhatIsLargerThanAnyMemoryStaysSo) {
  constexpr uint32_t kMost = std::numeric_limits<uint32_t>::max();
  TypeTable types;
  const TypeId element = nested(types, 16);
  const TypeId fits = types.array(element, {{1, 1000}});
  const TypeId wraps = types.array(element, {{1, int64_t{1} << 26}});
  const TypeId twice = types.array(wraps, {{1, int64_t{1} << 26}});
  const Layouts layouts = natural_layouts(types);
  EXPECT_EQ(layouts[element].size, 17u * 8);
  EXPECT_EQ(layouts[fits].size, 17u * 8 * 1000);
  EXPECT_EQ(layouts[wraps].size, kMost);
  EXPECT_EQ(layouts[twice].size, kMost);
}

TEST(NaturalLayout, MembersBehindSuchAnArray) {
  TypeTable types;
  Type type;
  type.kind = Kind::kStruct;
  type.name = "Large";
  type.members.resize(2);
  type.members[0].name = "a";
  type.members[0].type = types.array(nested(types, 16), {{1, int64_t{1} << 26}});
  type.members[1].name = "b";
  type.members[1].type = types.elementary(Kind::kLint);
  const TypeId large = types.declare(std::move(type));
  EXPECT_EQ(natural_layouts(types)[large].size, std::numeric_limits<uint32_t>::max());
}

}  // namespace
}  // namespace ir
