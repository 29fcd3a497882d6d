// Blocks that extend others, overrides and programs among the globals in an image.
#include "tests/unit/linker/linked.h"
#include "tests/unit/program/objects_sample.h"

namespace linker {
namespace {

std::string blocks(std::string_view base, std::string_view own, bool with_base = true) {
  return simple("", "  member local b : Base\n  member local d : Derived\n",
                "type Base = function_block\n" + std::string(base) +
                    (with_base ? "type Derived = function_block extends Base\n"
                               : "type Derived = function_block\n") +
                    std::string(base) + std::string(own),
                empty_pou("function_block", "Base") + empty_pou("function_block", "Derived"));
}

TEST(ObjectLayout, OwnMembersLieBehindTheCapacityOfTheBase) {
  const ir::Image image = linked(blocks("  member local a : INT\n  member local b : LREAL\n",
                                        "  member local c : BOOL\n  member local d : LINT\n"));
  const ir::TypeLayout& base = image.layouts[type_named(image, "Base")];
  for (const char* member : {"a", "b"}) {
    EXPECT_EQ(offset_of(image, "Derived", member), offset_of(image, "Base", member)) << member;
  }
  EXPECT_EQ(offset_of(image, "Derived", "c"), base.area_capacity);
  EXPECT_GE(offset_of(image, "Derived", "d"), base.area_capacity);
  EXPECT_GT(base.area_capacity, base.used);
}

TEST(ObjectLayout, A5_TheBaseGrowsBetweenItsMembersAndThoseAddedToIt) {
  const std::string own = "  member local c : INT\n";
  const ir::Image first = linked(blocks("  member local a : INT\n", own));
  const ir::Image second =
      relinked(first, blocks("  member local a : INT\n  member local n : DINT\n", own));
  EXPECT_EQ(offset_of(second, "Derived", "n"), offset_of(second, "Base", "n"));
  EXPECT_LT(offset_of(second, "Derived", "n"), offset_of(second, "Derived", "c"));
  EXPECT_EQ(offset_of(second, "Derived", "c"), offset_of(first, "Derived", "c"));
  EXPECT_EQ(area_of(second, "Main.d"), area_of(first, "Main.d"));
}

// A base that a block gets later leaves its own members no room: they move behind it.
TEST(ObjectLayout, A5_ANewBasePushesOwnMembersBehindIt) {
  const std::string base = "  member local a : INT\n";
  const std::string own = "  member local c : INT\n";
  const ir::Image first = linked(blocks(base, own, false));
  const ir::Image second = relinked(first, blocks(base, own));
  EXPECT_EQ(offset_of(second, "Derived", "a"), offset_of(second, "Base", "a"));
  EXPECT_GE(offset_of(second, "Derived", "c"),
            second.layouts[type_named(second, "Base")].area_capacity);
}

TEST(ObjectLinking, OverridesAreNumberedAndSorted) {
  const ir::Image image = linked(ir::object_program("", "b0:\n return\n", ir::kObjectOverrides));
  ASSERT_EQ(image.overrides.size(), 5u);
  for (const ir::LinkedOverride& row : image.overrides) {
    EXPECT_EQ(image.pous[row.prototype].kind, ir::PouKind::kMethod);
    EXPECT_TRUE(image.types.is_a(row.type, image.pous[row.target].self));
  }
}

TEST(ObjectLinking, AnOverrideNeedsItsObject) {
  const ir::Program program =
      parsed(ir::object_program("", "b0:\n return\n", ir::kObjectOverrides));
  std::vector<ir::Object> objects = objects_of(program);
  std::erase_if(objects, [](const ir::Object& o) { return o.name == "Adder.add"; });
  const base::Result<ir::Image> image = link(program, objects, {});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kUndefinedSymbol);
}

TEST(ObjectLinking, AProgramAmongTheGlobalsIsTheProgramInstance) {
  const ir::Image image = linked(
      "program P\ntype G = globals\n  member global n : INT\n  member global Second : Second\n"
      "type Main = program\ntype Second = program\n  member local runs : INT\nglobals G\n"
      "task T period 1000000 priority 0\ninstance Main : Main task 0\n"
      "instance Second : Second task 0\n" +
      empty_pou("program", "Main") + empty_pou("program", "Second"));
  EXPECT_EQ(image.instances.size(), 3u);  // the globals, Main, Second
  EXPECT_EQ(ir::initial_id(image, image.instances[0].data + offset_of(image, "G", "Second")),
            id_of(image, "Second"));
}

}  // namespace
}  // namespace linker
