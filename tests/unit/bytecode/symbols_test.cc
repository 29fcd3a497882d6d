#include "ir/bytecode/symbols.h"

#include <gtest/gtest.h>

#include "ir/bytecode/leaf_walk.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using namespace sample;  // offsets

class Symbols : public ::testing::Test {
 protected:
  Symbols() : image(busy_image()), memory(image.data_capacity) {
    ir::read_initial(image, 0, memory);
  }
  std::string value(std::string_view path) {
    const auto symbol = ir::find_symbol(image, path);
    return symbol ? ir::format_value(image, *symbol, memory) : symbol.error().text;
  }
  ir::Image image;
  std::vector<uint8_t> memory;
};

TEST_F(Symbols, AreFoundByPathWithoutCase) {
  EXPECT_EQ(ir::find_symbol(image, "main.X")->data, kMainData + kX);
  EXPECT_EQ(ir::find_symbol(image, "count")->data, kCount);
  EXPECT_TRUE(ir::find_symbol(image, "count")->retain);
  EXPECT_EQ(ir::find_symbol(image, "Main.fb.n")->data, 384 + kN);
  EXPECT_EQ(ir::find_symbol(image, "Main.fbs[1].n")->data, 416 + kN);
  EXPECT_EQ(ir::find_symbol(image, "Main.fbs[1]")->data, 416u);
  EXPECT_EQ(ir::find_symbol(image, "Main.numbers[ 3 ]")->data, kMainData + kNumbers + 4);
  EXPECT_EQ(ir::find_symbol(image, "Main.pair.a")->data, kMainData + kPair);
  EXPECT_EQ(ir::find_symbol(image, "shared.n")->data, 432 + kN);
  EXPECT_TRUE(ir::find_symbol(image, "in")->input);
  EXPECT_TRUE(ir::find_symbol(image, "limit")->constant);
}

TEST_F(Symbols, WrongPathsSayWhy) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "neither a program"},
      {"nothing", "neither a program"},
      {"Main.z", "no member"},
      {"Main.x.y", "has no members"},
      {"Main.numbers[5]", "outside 1..4"},
      {"Main.numbers[1,2]", "dimensions"},
      {"Main.numbers[", "whole number"},
      {"Main.x[1]", "only arrays"},
      {"Main.fb.io", "in-out"},
      {"Main.", "no member"},
      {"Main.numbers[-99999999999999999999]", "outside 1..4"},
  };
  for (const auto& [path, why] : cases) {
    const auto found = ir::find_symbol(image, path);
    ASSERT_FALSE(found.ok()) << path;
    EXPECT_EQ(found.error().refusal, base::Refusal::kNoSuchVariable);
    EXPECT_NE(found.error().text.find(why), std::string::npos) << found.error().text;
  }
}

TEST_F(Symbols, ValuesAsText) {
  memory[kMainData + kNumbers] = 0xff;
  memory[kMainData + kNumbers + 1] = 0xff;
  std::memcpy(&memory[kMainData + kText], "a'b", 4);
  memory[kMainData + kWtext] = 'w';
  EXPECT_EQ(value("Main.x"), "10");
  EXPECT_EQ(value("count"), "5");
  EXPECT_EQ(value("Main.flag"), "FALSE");
  EXPECT_EQ(value("Main.numbers"), "[-1, 0, 0, 0]");
  EXPECT_EQ(value("Main.text"), "'a$'b'");
  EXPECT_EQ(value("Main.wtext"), "\"w\"");
  EXPECT_EQ(value("Main.pair"), "(a := 0, t := '')");
  EXPECT_EQ(value("Main.fb"), "(run := FALSE, n := 0)");
}

TEST_F(Symbols, TextAsValues) {
  const Types t = types_of(image);
  const auto integer = image.types.elementary(ir::Kind::kInt);
  EXPECT_EQ(*ir::parse_value(image, integer, "-2"), (base::Bytes{0xfe, 0xff}));
  EXPECT_FALSE(ir::parse_value(image, integer, "70000").ok());
  EXPECT_EQ(*ir::parse_value(image, t.text5, "'ab'"), (base::Bytes{'a', 'b', 0, 0, 0, 0}));
  EXPECT_EQ(ir::parse_value(image, t.text5, "'abcdef'").error().refusal, base::Refusal::kBadValue);
  EXPECT_EQ(ir::parse_value(image, t.wtext, "\"a\"")->size(), 8u);
  EXPECT_FALSE(ir::parse_value(image, t.pair, "1").ok());
}

TEST_F(Symbols, LeavesInDeclarationOrder) {
  const std::string state = ir::state_text(image, memory);
  const std::string expected =
      "count=5\nin=FALSE\nout=FALSE\nlimit=0\nshared.run=FALSE\nshared.n=0\nMain.x=10\n";
  EXPECT_EQ(state.substr(0, expected.size()), expected);
  EXPECT_NE(state.find("Main.fbs[1].n=0\nMain.long=0\n"), std::string::npos);
  EXPECT_EQ(state.find(".io"), std::string::npos);
}

TEST_F(Symbols, HashIgnoresPlacesAndWhatFollowsAStringsEnd) {
  const base::Digest before = ir::state_hash(image, memory);
  memory[kMainData + kText + 5] = 'z';
  EXPECT_EQ(ir::state_hash(image, memory), before);
  memory[kMainData + kX] = 11;
  EXPECT_NE(ir::state_hash(image, memory), before);
  memory[kMainData + kX] = 10;
  // The same state with Main's area elsewhere.
  ir::Image moved = image;
  moved.instances[kMainInstance].data = 640;
  for (ir::DataRun& run : moved.data) {
    if (run.offset >= kMainData) run.offset += 640 - kMainData;
  }
  std::vector<uint8_t> other(moved.data_capacity);
  ir::read_initial(moved, 0, other);
  EXPECT_EQ(ir::state_hash(moved, other), before);
}

// One array of BOOLs, `a`.
ir::Image with_array(std::vector<ir::Dimension> dims) {
  ir::Image big;
  const auto bit = big.types.elementary(ir::Kind::kBool);
  const auto array = big.types.own().array(bit, std::move(dims));
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  ir::Member member;
  member.name = "a";
  member.type = array;
  globals.members = {member};
  big.globals = big.types.own().declare(globals);
  big.layouts.own().of.resize(big.types.size());
  big.layouts.own().of[bit.index].size = 1;
  big.layouts.own().of[big.globals.index].member_offsets = {0};
  big.instances.resize(1);
  big.instances[0].data = 64;
  return big;
}

TEST_F(Symbols, AMillionLeavesAreWalkedInLinearTime) {
  const ir::Image big = with_array({{1, 1'000'000}});
  uint64_t count = 0;
  uint32_t last = 0;
  ir::for_each_leaf(big, [&](const std::string&, const ir::Symbol& symbol) {
    ++count;
    last = symbol.data;
  });
  EXPECT_EQ(count, 1'000'000u);
  EXPECT_EQ(last, 64u + 999'999u);
}

using Leaves = std::vector<std::pair<std::string, uint32_t>>;

Leaves leaves_from(const ir::Image& image, uint64_t first, size_t most) {
  Leaves out;
  ir::for_each_leaf_from(image, first, [&](const std::string& path, const ir::Symbol& symbol) {
    out.emplace_back(path, symbol.data);
    return out.size() < most;
  });
  return out;
}

TEST_F(Symbols, PagesAreWhatTheWholeWalkVisits) {
  for (const ir::Image& one : {image, with_array({{-1, 1}, {0, 4}, {7, 8}})}) {
    Leaves all;
    ir::for_each_leaf(one, [&](const std::string& path, const ir::Symbol& symbol) {
      all.emplace_back(path, symbol.data);
    });
    ASSERT_GT(all.size(), 10u);
    for (size_t first = 0; first <= all.size() + 1; ++first) {
      for (const size_t most : {size_t{1}, size_t{3}, all.size() + 1}) {
        const size_t begin = std::min(first, all.size());
        const size_t end = std::min(begin + most, all.size());
        const Leaves wanted(all.begin() + static_cast<std::ptrdiff_t>(begin),
                            all.begin() + static_cast<std::ptrdiff_t>(end));
        ASSERT_EQ(leaves_from(one, first, most), wanted) << first << ", " << most;
      }
    }
  }
}

// Or this takes minutes.
TEST_F(Symbols, APageOfALargeArrayCostsWhatIsOnIt) {
  const ir::Image large = with_array({{1, 3'000'000'000}, {1, 2}});
  const Leaves last = leaves_from(large, 5'999'999'999, 10);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].first, "a[3000000000,2]");
}

}  // namespace
