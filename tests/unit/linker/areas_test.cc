// A5 to A7: areas of instances.
#include "linker/extents.h"
#include "tests/unit/linker/linked.h"

namespace linker {
namespace {

std::string two_blocks(std::string_view a_members, std::string_view instances) {
  return simple("", instances,
                "type A = function_block\n" + std::string(a_members) +
                    "type B = function_block\n  member local x : LREAL\n",
                empty_pou("function_block", "A") + empty_pou("function_block", "B"));
}

constexpr std::string_view kSmall = "  member local x : LREAL\n";
constexpr std::string_view kBoth = "  member local a : A\n  member local b : B\n";

std::string longs(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += "  member local l" + std::to_string(i) + " : LREAL\n";
  return std::string(kSmall) + out;
}

TEST(Areas, A5InstanceThatOutgrowsItsAreaMovesAndNoOther) {
  const ir::Image first = linked(two_blocks(kSmall, kBoth));
  const ir::Image second = relinked(first, two_blocks(longs(20), kBoth));
  EXPECT_NE(area_of(second, "Main.a"), area_of(first, "Main.a"));
  EXPECT_EQ(area_of(second, "Main.b"), area_of(first, "Main.b"));
  EXPECT_EQ(area_of(second, "Main"), area_of(first, "Main"));
  EXPECT_EQ(second.instances[0].data, first.instances[0].data);
  EXPECT_EQ(offset_of(second, "A", "x"), offset_of(first, "A", "x"));
}

TEST(Areas, A5DeletedInstancesAreaIsFreeAndUsedAgain) {
  const ir::Image first = linked(two_blocks(kSmall, kBoth));
  const uint32_t freed = area_of(first, "Main.a");
  const ir::Image second = relinked(first, two_blocks(kSmall, "  member local b : B\n"));
  bool is_free = false;
  for (const ir::Extent& extent : second.free) {
    is_free |= extent.offset <= freed && freed < extent.offset + extent.size;
  }
  EXPECT_TRUE(is_free);
  const ir::Image third =
      relinked(second, two_blocks(kSmall, "  member local b : B\n  member local again : A\n"));
  EXPECT_EQ(area_of(third, "Main.again"), freed);
}

TEST(Areas, A5GrowthInsideTheSlackMovesNothingAndShrinkingKeepsTheArea) {
  Options options;
  options.slack.instance_bytes = 16;
  const ir::Image first = linked(two_blocks(kSmall, kBoth), options);
  const ir::Image grown = relinked(first, two_blocks(longs(2), kBoth), options);
  const ir::Image shrunk = relinked(grown, two_blocks(kSmall, kBoth), options);
  for (const ir::Image* image : {&grown, &shrunk}) {
    EXPECT_EQ(area_of(*image, "Main.a"), area_of(first, "Main.a"));
    EXPECT_EQ(image->layouts[type_named(*image, "A")].area_capacity, 24u);
  }
  const ir::Image over = relinked(first, two_blocks(longs(3), kBoth), options);
  EXPECT_NE(area_of(over, "Main.a"), area_of(first, "Main.a"));
}

TEST(Areas, A6SlackSizesAreTheProjects) {
  Options options;
  options.slack = {0, 100, 0, 200, 0, 300, 4096, 0};
  const ir::Image image = linked(simple("  member global g : LREAL\n", "  member local f : F\n",
                                        "type F = function_block\n  member local x : LREAL\n",
                                        empty_pou("function_block", "F")),
                                 options);
  EXPECT_EQ(image.layouts[image.globals].area_capacity, 112u);  // 8 + 100, to 8
  EXPECT_EQ(image.layouts[type_named(image, "F")].area_capacity, 208u);
  EXPECT_EQ(image.layouts[type_named(image, "Main")].area_capacity, 304u);  // 4 + 300
  EXPECT_EQ(image.data_capacity, 64u + 112 + 208 + 304 + 4096);
}

TEST(Areas, A7RefusesWithWhatDidNotFitAndByHowMuch) {
  Options options;
  options.slack.free_bytes = 64;
  options.slack.free_percent = 0;
  const ir::Image first = linked(two_blocks(kSmall, kBoth), options);
  options.base = &first;
  const base::Result<ir::Image> second = try_link(two_blocks(longs(20), kBoth), options);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().refusal, base::Refusal::kOutOfMemory);
  // 21 LREALs and a quarter more are 210 bytes, on a multiple of 8; 64 free and the
  // 24 of the area that it leaves do not touch.
  EXPECT_NE(second.error().text.find("instance `Main.a` (A) needs an area of 216 bytes"),
            std::string::npos)
      << second.error().text;
  EXPECT_NE(second.error().text.find("bytes, 152 too few"), std::string::npos)
      << second.error().text;
}

// What the refusal asks for is enough, and nothing less.
TEST(Areas, case71_DataMemoryGrowsByTheFreeAreaOfTheProject) {
  Options options;
  options.slack.free_bytes = 64;
  options.slack.free_percent = 0;
  const ir::Image first = linked(two_blocks(kSmall, kBoth), options);
  options.base = &first;
  const std::string bigger = two_blocks(longs(2000), kBoth);
  const base::Result<ir::Image> refused = try_link(bigger, options);
  ASSERT_FALSE(refused.ok());
  const std::string& text = refused.error().text;
  const size_t at = text.find("free_bytes = ");
  ASSERT_NE(at, std::string::npos) << text;
  const auto need = static_cast<uint32_t>(std::stoul(text.substr(at + 13)));
  options.slack.free_bytes = need - 8;
  EXPECT_FALSE(try_link(bigger, options).ok());
  options.slack.free_bytes = need;
  const ir::Image second = relinked(first, bigger, options);
  EXPECT_GT(second.data_capacity, first.data_capacity);
  EXPECT_EQ(area_of(second, "Main.b"), area_of(first, "Main.b"));
  // The same again is the same.
  options.base = &second;
  const ir::Image third = relinked(second, bigger, options);
  EXPECT_EQ(third.data_capacity, second.data_capacity);
  EXPECT_EQ(area_of(third, "Main.a"), area_of(second, "Main.a"));
}

// Each version has the free area of the project behind it, so no line of changes ends at a wall.
TEST(Areas, case71_ManyChangesGrowIt) {
  Options options;
  options.slack.free_bytes = 400;
  options.slack.free_percent = 0;
  std::string members(kBoth);
  ir::Image version = linked(two_blocks(longs(20), members), options);
  const uint32_t before = version.data_capacity;
  for (int i = 1; i <= 10; ++i) {  // 216 bytes each
    members += "  member local more" + std::to_string(i) + " : A\n";
    ir::Image next = relinked(version, two_blocks(longs(20), members), options);
    version = std::move(next);
  }
  EXPECT_GT(version.data_capacity, before + 1000);
}

TEST(Areas, A7UsesTheWholeFreeAreaBeforeRefusing) {
  Options options;
  options.slack.free_bytes = 216;
  options.slack.free_percent = 0;
  const ir::Image first = linked(two_blocks(kSmall, kBoth), options);
  const ir::Image second = relinked(first, two_blocks(longs(20), kBoth), options);
  EXPECT_EQ(area_of(second, "Main.a") + 216, second.data_capacity);
}

// No free area at all: what goes in this very change makes the room for what comes.
TEST(Areas, A7UsesWhatTheChangeItselfFreesBeforeRefusing) {
  Options options;
  options.slack.free_bytes = 0;
  options.slack.free_percent = 0;
  const ir::Image first = linked(two_blocks(longs(20), kBoth), options);
  const std::string_view other = "  member local c : A\n  member local b : B\n";
  const ir::Image second = relinked(first, two_blocks(longs(20), other), options);
  EXPECT_EQ(area_of(second, "Main.c"), area_of(first, "Main.a"));
  EXPECT_EQ(area_of(second, "Main.b"), area_of(first, "Main.b"));
  options.base = &first;
  const base::Result<ir::Image> third = try_link(two_blocks(longs(27), other), options);
  ASSERT_FALSE(third.ok());
  EXPECT_EQ(third.error().refusal, base::Refusal::kOutOfMemory);
  // 28 LREALs and a quarter more; `a` leaves what 21 and a quarter more took.
  EXPECT_NE(third.error().text.find("has 216 bytes, 64 too few"), std::string::npos)
      << third.error().text;
}

// What is free before the switch can be written before it.
TEST(Areas, A19UsesWhatWasFreeBeforeWhatTheChangeFrees) {
  const ir::Image first = linked(two_blocks(kSmall, kBoth));
  const uint32_t freed = area_of(first, "Main.a");
  const ir::Image second =
      relinked(first, two_blocks(kSmall, "  member local c : A\n  member local b : B\n"));
  EXPECT_GT(area_of(second, "Main.c"), freed) << "version 1 uses those bytes until the switch";
  const ir::Image third = relinked(
      second,
      two_blocks(kSmall, "  member local c : A\n  member local b : B\n  member local d : A\n"));
  EXPECT_EQ(area_of(third, "Main.d"), freed);
}

TEST(Areas, MoveAllGivesEveryInstanceANewPlace) {
  const ir::Image first = linked(two_blocks(kSmall, kBoth));
  Options options;
  options.move_all = true;
  const ir::Image second = relinked(first, two_blocks(kSmall, kBoth), options);
  for (const char* path : {"Main", "Main.a", "Main.b"}) {
    EXPECT_NE(area_of(second, path), area_of(first, path)) << path;
    EXPECT_EQ(id_of(second, path), id_of(first, path)) << path;
  }
}

TEST(Areas, SameProgramAgainIsTheSameImage) {
  const ir::Image first = linked(two_blocks(kSmall, kBoth));
  EXPECT_EQ(ir::encode(relinked(first, two_blocks(kSmall, kBoth))), ir::encode(first));
  EXPECT_EQ(ir::encode(linked(two_blocks(kSmall, kBoth))), ir::encode(first));
}

TEST(Extents, JoinsSplitsAndFindsGaps) {
  Extents extents;
  extents.add(10, 5);
  extents.add(20, 5);
  extents.add(15, 5);
  EXPECT_EQ(extents.ranges(), (std::map<uint64_t, uint64_t>{{10, 25}}));
  extents.remove(12, 4);
  EXPECT_EQ(extents.ranges(), (std::map<uint64_t, uint64_t>{{10, 12}, {16, 25}}));
  EXPECT_EQ(extents.first_gap(0, 100, 4, 4), 0u);
  EXPECT_EQ(extents.first_gap(9, 100, 4, 4), 12u);
  EXPECT_EQ(extents.first_gap(9, 100, 8, 4), 28u);
  EXPECT_EQ(extents.first_gap(9, 30, 8, 4), std::nullopt);
  EXPECT_EQ(extents.first_fit(9), 16u);
  EXPECT_EQ(extents.first_fit(10), std::nullopt);
}

}  // namespace
}  // namespace linker
