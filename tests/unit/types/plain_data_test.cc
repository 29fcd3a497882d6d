// What resources exchange: which types have values that can be copied, and when two are the same.
#include "ir/types/plain_data.h"

#include <gtest/gtest.h>

#include "ir/types/natural_layout.h"

namespace ir {
namespace {

Member member(const char* name, TypeId type) {
  Member out;
  out.name = name;
  out.type = type;
  return out;
}

TypeId structure(TypeTable& types, const char* name, std::vector<Member> members,
                 Kind kind = Kind::kStruct) {
  Type type;
  type.kind = kind;
  type.name = name;
  type.members = std::move(members);
  return types.declare(std::move(type));
}

std::optional<base::Digest> signature(const TypeTable& types, TypeId id) {
  return plain_signature(types, natural_layouts(types), id);
}

TEST(PlainData, WhatHoldsAReferenceOrABlockIsNone) {
  TypeTable types;
  const TypeId integer = types.elementary(Kind::kInt);
  const TypeId block = structure(types, "F", {member("n", integer)}, Kind::kFunctionBlock);
  Member located = member("at", integer);
  located.address.area = DirectArea::kInput;
  EXPECT_TRUE(is_plain_data(types, types.array(types.string(5), {{1, 3}})));
  EXPECT_TRUE(is_plain_data(types, structure(types, "S", {member("a", types.wstring(2))})));
  for (TypeId id :
       {block, types.pointer(integer), types.ref_to(integer), types.array(block, {{1, 2}}),
        TypeId(), TypeId(5000), structure(types, "P", {member("p", types.pointer(integer))}),
        structure(types, "L", {located})}) {
    EXPECT_FALSE(is_plain_data(types, id)) << id.index;
    if (!types.contains(id)) continue;
    EXPECT_FALSE(signature(types, id).has_value());
  }
}

TEST(PlainData, TheSignatureSaysEverythingThatAValueMeans) {
  TypeTable types;
  const TypeId integer = types.elementary(Kind::kInt);
  Type colours;
  colours.kind = Kind::kEnum;
  colours.name = "Colour";
  colours.base = integer;
  colours.literals = {{"red", 0}, {"green", 1}};
  const TypeId colour = types.declare(colours);
  colours.literals[1].value = 2;
  const TypeId other_number = types.declare(colours);
  colours.literals = {{"red", 0}, {"blue", 1}};
  const TypeId other_name = types.declare(colours);
  const TypeId pair = structure(types, "Pair", {member("a", integer), member("b", colour)});
  const std::vector<TypeId> different = {
      integer,
      types.elementary(Kind::kUint),
      types.subrange(integer, 0, 9),
      types.subrange(integer, 0, 10),
      types.string(5),
      types.string(6),
      types.wstring(5),
      types.array(integer, {{1, 3}}),
      types.array(integer, {{0, 2}}),
      types.array(integer, {{1, 3}, {1, 1}}),
      colour,
      other_number,
      other_name,
      pair,
      structure(types, "Pair", {member("b", colour), member("a", integer)}),
      structure(types, "Pair", {member("a", integer), member("c", colour)}),
      structure(types, "Pair", {member("a", integer), member("b", colour)}, Kind::kUnion)};
  for (size_t a = 0; a < different.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      EXPECT_NE(signature(types, different[a]), signature(types, different[b])) << a << ' ' << b;
    }
  }
  EXPECT_EQ(
      signature(types, pair),
      signature(types, structure(types, "PAIR", {member("A", integer), member("b", colour)})));
}

// A change may be filling what lies between members.
TEST(PlainData, RunsLeaveHolesOut) {
  TypeTable types;
  const TypeId part = structure(
      types, "Part",
      {member("b", types.elementary(Kind::kByte)), member("d", types.elementary(Kind::kDint))});
  const TypeId parts = types.array(part, {{1, 2}});
  const std::vector<PlainRun> runs = plain_runs(types, natural_layouts(types), parts);
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].size, 1u);
  EXPECT_EQ(runs[1].offset, 4u);
  EXPECT_EQ(runs[1].size, 5u);  // the first d, and the second b behind it
  EXPECT_EQ(runs[2].offset, 12u);
  EXPECT_EQ(runs[2].size, 4u);
}

// Each structure holds the one before twice: a hostile image must not keep anybody busy.
TEST(PlainData, TooManyPartsAreNotCounted) {
  TypeTable types;
  TypeId id = structure(types, "S0", {});
  for (int i = 1; i < 150; ++i) {
    id = structure(types, ("S" + std::to_string(i)).c_str(), {member("a", id), member("b", id)});
  }
  EXPECT_FALSE(is_plain_data(types, id));
  const TypeId bytes = structure(types, "Byte", {member("b", types.elementary(Kind::kByte))});
  const TypeId many = types.array(bytes, {{0, kMaxPlainParts}});
  EXPECT_TRUE(is_plain_data(types, many));
  EXPECT_FALSE(signature(types, many).has_value());
  EXPECT_TRUE(signature(types, types.array(bytes, {{0, 1000}})).has_value());
}

}  // namespace
}  // namespace ir
