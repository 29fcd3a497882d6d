// A1 to A4, A8: offsets of members across versions.
#include "tests/unit/linker/linked.h"

namespace linker {
namespace {

TEST(Layout, A1UnchangedVariablesKeepTheirAddressesWhateverHappensAroundThem) {
  const ir::Image first = linked(
      simple("  member global a : INT\n  member global b : DINT\n  member global c : BOOL\n", ""));
  const ir::Image second =
      relinked(first, simple("  member global n : LREAL\n  member global C : BOOL\n"
                             "  member global b : DINT\n  member global m : BOOL\n",
                             ""));
  EXPECT_EQ(offset_of(second, "G", "b"), offset_of(first, "G", "b"));
  EXPECT_EQ(offset_of(second, "G", "c"), offset_of(first, "G", "c"));
  EXPECT_EQ(second.instances[0].data, first.instances[0].data);
}

TEST(Layout, A2RetypedVariableIsADeletionPlusAnAddition) {
  const ir::Image first = linked(simple("  member global a : INT\n  member global b : INT\n", ""));
  const ir::Image second =
      relinked(first, simple("  member global a : DINT\n  member global b : INT\n", ""));
  EXPECT_EQ(offset_of(first, "G", "a"), 0u);
  EXPECT_EQ(offset_of(second, "G", "b"), 2u);
  EXPECT_EQ(offset_of(second, "G", "a"), 4u);
}

TEST(Layout, A2DeletedBytesAreUsedAgainByTheNextChange) {
  const ir::Image first = linked(simple("  member global a : INT\n  member global b : INT\n", ""));
  const ir::Image second =
      relinked(first, simple("  member global b : INT\n  member global n : INT\n", ""));
  EXPECT_EQ(offset_of(second, "G", "n"), 4u);  // not where `a` still is: A19
  const ir::Image third =
      relinked(second, simple("  member global b : INT\n  member global n : INT\n"
                              "  member global m : INT\n",
                              ""));
  EXPECT_EQ(offset_of(third, "G", "m"), 0u);
}

TEST(Layout, A3UsesBytesThatThisChangeFreesWhenNothingElseIsLeft) {
  Options tight;
  tight.slack.globals_bytes = tight.slack.globals_percent = 0;
  const ir::Image first =
      linked(simple("  member global a : LREAL\n  member global b : LREAL\n", ""), tight);
  const ir::Image second =
      relinked(first, simple("  member global b : LREAL\n  member global n : LREAL\n", ""), tight);
  EXPECT_EQ(offset_of(second, "G", "n"), 0u);
  EXPECT_EQ(second.instances[0].data, first.instances[0].data);
}

TEST(Layout, A4LocalsOfProgramsAndFunctionBlocksLikeGlobals) {
  const auto text = [](std::string_view members) {
    return simple("", "  member local f : F\n" + std::string(members),
                  "type F = function_block\n" + std::string(members),
                  empty_pou("function_block", "F"));
  };
  const ir::Image first = linked(text("  member local a : INT\n  member local b : DINT\n"));
  const ir::Image second =
      relinked(first, text("  member local n : INT\n  member local b : DINT\n"));
  for (const char* type : {"F", "Main"}) {
    EXPECT_EQ(offset_of(second, type, "b"), offset_of(first, type, "b")) << type;
    EXPECT_NE(offset_of(second, type, "n"), offset_of(first, type, "a")) << type;
  }
}

TEST(Layout, A8DeletedVariablesGiveTheirBytesBackToTheSlack) {
  std::string globals = "  member global a : LREAL\n";
  Options options;
  options.slack.globals_bytes = 16;
  ir::Image image = linked(simple(globals, ""), options);
  const uint32_t area = image.instances[0].data;
  for (int round = 0; round < 100; ++round) {
    const std::string name = "n" + std::to_string(round);
    image =
        relinked(image, simple(globals + "  member global " + name + " : LREAL\n", ""), options);
    EXPECT_LE(image.layouts[image.globals].used, 24u);
    EXPECT_EQ(image.instances[0].data, area);
  }
}

TEST(Layout, OrderInTheSourceMeansNothing) {
  const ir::Image first = linked(simple("  member global a : INT\n  member global b : INT\n", ""));
  const ir::Image second =
      relinked(first, simple("  member global b : INT\n  member global a : INT\n", ""));
  EXPECT_EQ(offset_of(second, "G", "a"), offset_of(first, "G", "a"));
  EXPECT_EQ(offset_of(second, "G", "b"), offset_of(first, "G", "b"));
}

// A12's case: UINT -> ARRAY[0..9] OF UINT before the used member moves it from 2 to
// 20 when laid out anew; against the running version it stays at 2.
TEST(Layout, A12MemberBehindAResizedOne) {
  const auto text = [](std::string_view before, std::string_view types) {
    return simple("", "  member local s : S\n",
                  std::string(types) + "type S = struct\n  member local first : " +
                      std::string(before) + "\n  member local used : UINT\n");
  };
  const std::string grown = text("%25", "type %25 = array UINT [0..9]\n");
  const ir::Image first = linked(text("UINT", ""));
  EXPECT_EQ(offset_of(first, "S", "used"), 2u);
  EXPECT_EQ(offset_of(linked(grown), "S", "used"), 20u);
  EXPECT_EQ(offset_of(relinked(first, grown), "S", "used"), 2u);
}

TEST(Layout, SameValueTypeComparesContentAndOffsets) {
  const auto text = [](std::string_view members) {
    return simple("  member global s : S\n", "",
                  "type S = struct\n" + std::string(members) + "type %26 = array S [0..3]\n");
  };
  const ir::Image first = linked(text("  member local a : INT\n  member local b : INT\n"));
  const ir::Image same = relinked(first, text("  member local b : INT\n  member local a : INT\n"));
  const ir::Image other = relinked(first, text("  member local a : INT\n  member local c : INT\n"));
  const auto equal = [&](const ir::Image& image, ir::TypeId type) {
    return same_value_type(first.types, first.layouts, type, image.types, image.layouts, type);
  };
  EXPECT_TRUE(equal(same, type_named(first, "S")));
  EXPECT_TRUE(equal(same, ir::TypeId(26)));
  EXPECT_FALSE(equal(other, type_named(first, "S")));
  EXPECT_FALSE(equal(other, ir::TypeId(26)));
  EXPECT_EQ(offset_of(same, "G", "s"), offset_of(first, "G", "s"));
  EXPECT_NE(offset_of(other, "G", "s"), offset_of(first, "G", "s"));
}

TEST(Layout, LargeMembersOfAnAreaGoBehindSmallOnes) {
  const ir::Image image = linked(simple("  member global big : %25\n  member global x : INT\n", "",
                                        "type %25 = array INT [0..40000]\n"));
  EXPECT_EQ(offset_of(image, "G", "x"), 0u);
  EXPECT_EQ(offset_of(image, "G", "big"), 2u);
}

}  // namespace
}  // namespace linker
