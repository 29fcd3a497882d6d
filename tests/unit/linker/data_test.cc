// Initial data (A15), I/O bindings, retained ranges.
#include "tests/unit/linker/linked.h"

namespace linker {
namespace {

std::vector<uint8_t> memory_of(const ir::Image& image) {
  std::vector<uint8_t> memory(image.data_capacity, 0);
  for (const ir::DataRun& run : image.data) {
    std::copy(run.bytes.begin(), run.bytes.end(), memory.begin() + run.offset);
  }
  return memory;
}

template <class T>
T value_at(const ir::Image& image, uint32_t offset) {
  T value;
  std::memcpy(&value, memory_of(image).data() + offset, sizeof value);
  return value;
}

constexpr std::string_view kTypes = R"(type %25 = string 5
type Speed = subrange INT 0..100 init #1
type %27 = array Speed [0..3]
type S = struct
  member local a : INT init #0
  member local b : Speed
  member local t : %25 init #2
type F = function_block
  member local s : S
  member local x : INT init #0
  member local table : %27
type %30 = array F [1..2]
const #0 = 7
const #1 = 50
const #2 = 'abcdefgh'
const #3 = {0 = #0}
const #4 = {0 * 2 = #0}
const #5 = {1 = #1, 2 = #4}
const #6 = {1 = #5}
const #7 = {0 = #3}
)";

ir::Image example() {
  return linked(simple("  member global g : S init #3\n  member global plain : S\n",
                       "  member local fs : %30 init #6\n  member local f : F init #7\n", kTypes,
                       empty_pou("function_block", "F")));
}

TEST(InitialData, A15TypesDefaultWhereNothingElseIsSaid) {
  const ir::Image image = example();
  const uint32_t s = image.instances[0].data + offset_of(image, "G", "plain");
  EXPECT_EQ(value_at<int16_t>(image, s + offset_of(image, "S", "a")), 7);
  EXPECT_EQ(value_at<int16_t>(image, s + offset_of(image, "S", "b")), 50);
  const std::string text = std::string(
      reinterpret_cast<const char*>(memory_of(image).data() + s + offset_of(image, "S", "t")), 6);
  EXPECT_EQ(text, std::string("abcde\0", 6));
}

TEST(InitialData, InstancesTakeTheirDeclarationsValuesAndElseTheTypes) {
  const ir::Image image = example();
  const uint32_t one = area_of(image, "Main.fs[1]");
  const uint32_t two = area_of(image, "Main.fs[2]");
  const uint32_t x = offset_of(image, "F", "x");
  const uint32_t table = offset_of(image, "F", "table");
  EXPECT_EQ(value_at<int16_t>(image, one + x), 7);
  EXPECT_EQ(value_at<int16_t>(image, two + x), 50);
  EXPECT_EQ(value_at<int16_t>(image, one + table), 50);
  EXPECT_EQ(value_at<int16_t>(image, two + table), 7);
  EXPECT_EQ(value_at<int16_t>(image, two + table + 2), 7);
  EXPECT_EQ(value_at<int16_t>(image, two + table + 4), 50);
}

TEST(InitialData, SlotsHoldTheirInstancesIds) {
  const ir::Image image = example();
  const uint32_t slots = area_of(image, "Main") + offset_of(image, "Main", "fs");
  EXPECT_EQ(value_at<uint32_t>(image, slots), id_of(image, "Main.fs[1]"));
  EXPECT_EQ(value_at<uint32_t>(image, slots + 4), id_of(image, "Main.fs[2]"));
}

TEST(InitialData, BindsInputsAndOutputsAndSizesTheProcessImage) {
  const ir::Image image = linked(
      simple("  member global i : BOOL at input 19 1\n  member global q : WORD at output 64 16\n"
             "  member global m : WORD at marker 0 16\n",
             "  member local o : BOOL at output 3 1\n"));
  ASSERT_EQ(image.io.size(), 4u);
  EXPECT_EQ(image.input_bytes, 3u);
  EXPECT_EQ(image.output_bytes, 10u);
  EXPECT_EQ(image.io[1].data, image.instances[0].data + offset_of(image, "G", "q"));
  EXPECT_EQ(image.io[2].data, image.instances[0].data + offset_of(image, "G", "m"));
  EXPECT_EQ(image.io[3].data, area_of(image, "Main") + offset_of(image, "Main", "o"));
}

TEST(InitialData, LargestProcessImage) {
  const auto inputs = [](uint64_t bytes) {
    const std::string bit = std::to_string(bytes * 8 - 8);
    return try_link(simple("  member global i : BYTE at input " + bit + " 8\n", ""));
  };
  const auto largest = inputs(base::kMaxDeviceBytes);
  ASSERT_TRUE(largest.ok());
  EXPECT_EQ(largest->input_bytes, base::kMaxDeviceBytes);
  EXPECT_EQ(inputs(base::kMaxDeviceBytes + 1).error().refusal, base::Refusal::kTooMany);
}

TEST(InitialData, RetainsVariablesAndWholeInstances) {
  const ir::Image image =
      linked(simple("  member global a : INT retain\n  member global b : INT retain\n"
                    "  member global c : INT\n",
                    "  member local f : F retain\n",
                    "type T = function_block\n  member local x : LREAL\n"
                    "type F = function_block\n  member local y : DINT\n  member local t : T\n",
                    empty_pou("function_block", "T") + empty_pou("function_block", "F")));
  ASSERT_EQ(image.retain.size(), 3u);
  EXPECT_EQ(image.retain[0].data, image.instances[0].data);
  EXPECT_EQ(image.retain[0].size, 4u);
  EXPECT_EQ(image.retain[1].data, area_of(image, "Main.f"));
  EXPECT_EQ(image.retain[1].size, 4u);
  EXPECT_EQ(image.retain[2].data, area_of(image, "Main.f.t"));
  EXPECT_EQ(image.retain[2].size, 8u);
}

}  // namespace
}  // namespace linker
