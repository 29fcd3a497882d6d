#include "ir/types/types.h"

#include <gtest/gtest.h>

#include "base/limits.h"

namespace ir {
namespace {

TEST(Scalars, HaveSizesAndSigns) {
  EXPECT_EQ(scalar_name(Scalar::kU16), "u16");
  EXPECT_EQ(scalar_size(Scalar::kBool), 1u);
  EXPECT_EQ(scalar_size(Scalar::kAddr), 4u);
  EXPECT_EQ(scalar_size(Scalar::kWstr), 8u);
  EXPECT_TRUE(is_signed(Scalar::kI64));
  EXPECT_FALSE(is_signed(Scalar::kU8));
  EXPECT_FALSE(is_integer(Scalar::kBool));
  EXPECT_FALSE(is_integer(Scalar::kF32));
  EXPECT_TRUE(is_float(Scalar::kF64));
}

TEST(TypeTable, HoldsTheElementaryTypesFromTheStart) {
  const TypeTable types;
  ASSERT_EQ(types.size(), kElementaryCount);
  EXPECT_EQ(types.text(types.elementary(Kind::kLtod)), "LTIME_OF_DAY");
  EXPECT_EQ(types.scalar(types.elementary(Kind::kDword)), Scalar::kU32);
  EXPECT_EQ(elementary_group(Kind::kDword), Group::kBit);
  EXPECT_EQ(elementary_group(Kind::kArray), Group::kNone);
}

TEST(TypeTable, InternsByContent) {
  TypeTable types;
  const TypeId integer = types.elementary(Kind::kInt);
  EXPECT_EQ(types.string(20), types.string(20));
  EXPECT_NE(types.string(20), types.wstring(20));
  EXPECT_NE(types.string(20), types.string(21));
  EXPECT_EQ(types.array(integer, {{0, 9}}), types.array(integer, {{0, 9}}));
  EXPECT_NE(types.array(integer, {{0, 9}}), types.array(integer, {{0, 9}, {1, 2}}));
  EXPECT_EQ(types.subrange(integer, -1, 5), types.subrange(integer, -1, 5));
  EXPECT_NE(types.subrange(integer, -1, 5), types.subrange(integer, 1, 5));
}

TEST(TypeTable, SpellsTypesOut) {
  TypeTable types;
  const TypeId integer = types.elementary(Kind::kInt);
  Type motor;
  motor.kind = Kind::kStruct;
  motor.name = "Motor";
  const TypeId named = types.declare(motor);
  EXPECT_EQ(types.text(types.array(named, {{1, 3}, {-2, 9}})), "ARRAY[1..3,-2..9] OF Motor");
  EXPECT_EQ(types.text(types.string(80)), "STRING[80]");
  EXPECT_EQ(types.text(types.subrange(integer, 0, 10)), "INT(0..10)");
  EXPECT_EQ(types.text(types.subrange(types.elementary(Kind::kUlint), 0, -1)),
            "ULINT(0..18446744073709551615)");
  Type colour;
  colour.kind = Kind::kEnum;
  colour.base = integer;
  colour.literals = {{"Red", 0}, {"Green", 5}};
  EXPECT_EQ(types.text(types.declare(colour)), "INT (Red := 0, Green := 5)");
  motor.name.clear();
  motor.members.push_back(
      {.name = "speed", .type = integer, .init = {}, .address = {}, .old_name = {}});
  EXPECT_EQ(types.text(types.declare(motor)), "STRUCT speed : INT; END_STRUCT");
}

TEST(TypeTable, TextOfAnEndlessTypeEnds) {
  TypeTable types;
  Type loop;
  loop.kind = Kind::kStruct;
  const TypeId id = types.declare(loop);
  const Member member{.name = "next", .type = id, .init = {}, .address = {}, .old_name = {}};
  types.edit(id).members.assign(2, member);
  EXPECT_LT(types.text(id).size(), 200'000u);
}

TEST(TypeTable, LooksBelowSubrangesAndEnumerations) {
  TypeTable types;
  const TypeId narrow = types.subrange(types.elementary(Kind::kUint), 1, 5);
  const TypeId narrower = types.subrange(narrow, 2, 3);
  EXPECT_TRUE(types.is_scalar(narrower));
  EXPECT_EQ(types.scalar(narrower), Scalar::kU16);
  EXPECT_EQ(types.root_kind(narrower), Kind::kUint);
  EXPECT_EQ(types.root_kind(types.string(3)), Kind::kString);
  EXPECT_FALSE(types.is_scalar(types.string(3)));
  types.edit(narrow).base = narrower;  // as a damaged image may have it
  EXPECT_FALSE(types.is_scalar(narrower));
}

TEST(TypeTable, FindsMembersWithoutCase) {
  TypeTable types;
  Type fb;
  fb.kind = Kind::kFunctionBlock;
  fb.members.push_back(
      {.name = "Start", .type = TypeId(0), .init = {}, .address = {}, .old_name = {}});
  const TypeId id = types.declare(fb);
  EXPECT_EQ(types.find_member(id, "START"), 0);
  EXPECT_EQ(types.find_member(id, "Stop"), -1);
  EXPECT_TRUE(types.is_instance(id));
  EXPECT_TRUE(types.has_members(id));
}

TEST(Types, ReferencesAreInternedByTargetAndMayLeadBackToThemselves) {
  TypeTable types;
  Type node;
  node.kind = Kind::kStruct;
  node.name = "Node";
  const TypeId id = types.declare(node);
  const TypeId pointer = types.pointer(id);
  Member next;
  next.name = "next";
  next.type = pointer;
  types.edit(id).members.push_back(next);
  EXPECT_EQ(types.pointer(id), pointer);
  EXPECT_NE(types.ref_to(id), pointer);
  EXPECT_EQ(types.text(pointer), "POINTER TO Node");
  EXPECT_EQ(types.text(types.ref_to(types.elementary(Kind::kInt))), "REF_TO INT");
  EXPECT_EQ(types.text(types.reference_to(types.array(pointer, {{0, 3}}))),
            "REFERENCE TO ARRAY[0..3] OF POINTER TO Node");
  EXPECT_TRUE(types.is_scalar(pointer));
  EXPECT_EQ(types.scalar(pointer), Scalar::kU64);
  EXPECT_TRUE(types.is_reference(pointer));
}

TEST(Types, MembersOfAUnionOverlap) {
  TypeTable types;
  Type both;
  both.kind = Kind::kUnion;
  Member member;
  member.name = "raw";
  member.type = types.elementary(Kind::kDword);
  both.members.push_back(member);
  member.name = "real";
  member.type = types.elementary(Kind::kReal);
  both.members.push_back(member);
  const TypeId id = types.declare(both);
  EXPECT_TRUE(types.overlaps(id));
  EXPECT_TRUE(types.has_members(id));
  EXPECT_EQ(types.text(id), "UNION raw : DWORD; real : REAL; END_UNION");
  both.kind = Kind::kStruct;
  EXPECT_FALSE(types.overlaps(types.declare(both)));
  both.overlap = true;
  EXPECT_TRUE(types.overlaps(types.declare(both)));
}

}  // namespace
}  // namespace ir
