// ADR 0024: where BOOLs are 0 or 1 in memory, and that everything which comes from outside is made
// so.
#include "ir/bytecode/bools.h"
#include "ir/types/plain_data.h"
#include "tests/unit/runtime/plant.h"
#include "vm/runtime/shared_globals.h"

namespace runtime_test {
namespace {

bool stay_clean(const std::string& source) {
  const auto image = build(source);
  return image && ir::Bools(image->image()).stay_clean();
}

TEST(CleanBools, StayCleanUnlessTheirBytesCanBeWrittenAsAnotherType) {
  EXPECT_TRUE(stay_clean(R"(
TYPE Pair : STRUCT a, b : BOOL; n : INT; END_STRUCT; Bits : UNION w : WORD; b : BYTE; END_UNION; END_TYPE
FUNCTION_BLOCK Base METHOD run : BOOL run := TRUE; END_METHOD END_FUNCTION_BLOCK
PROGRAM P VAR p, q : Pair; u : Bits; f : Base; x : BOOL; i AT %IX0.0 : BOOL; t : STRING; END_VAR
  p := q; x := f.run() AND i; u.w := 7; t := CONCAT(t, 'x');
END_PROGRAM)"));
  EXPECT_FALSE(stay_clean(R"(
PROGRAM P VAR x : BOOL; p : POINTER TO BYTE; END_VAR p := ADR(x); p^ := 16#AA; END_PROGRAM)"));
  EXPECT_FALSE(stay_clean(R"(
TYPE Bits : UNION w : BYTE; b : BOOL; END_UNION; END_TYPE
PROGRAM P VAR u : Bits; END_VAR u.w := 16#AA; END_PROGRAM)"));
  EXPECT_FALSE(stay_clean(R"(
TYPE Part : STRUCT on : ARRAY[0..1] OF BOOL; END_STRUCT; Bits : UNION w : WORD; p : Part; END_UNION; END_TYPE
PROGRAM P VAR a : ARRAY[0..3] OF Bits; END_VAR a[1].w := 16#AA; END_PROGRAM)"));
  EXPECT_FALSE(stay_clean(R"(
PROGRAM P VAR x : BOOL; p : POINTER TO STRING; END_VAR p := ADR(x); p^ := 'a'; END_PROGRAM)"));
}

constexpr const char* kParts = R"(
TYPE Part : STRUCT n : INT; on : ARRAY[0..2] OF BOOL; last : BOOL; END_STRUCT; END_TYPE
FUNCTION_BLOCK Cell VAR RETAIN x : BOOL; parts : ARRAY[1..2] OF Part; END_VAR END_FUNCTION_BLOCK
VAR_GLOBAL RETAIN g : BOOL := TRUE; END_VAR
PROGRAM P VAR c : ARRAY[0..1] OF Cell; b : BOOL := TRUE; word : UINT := 16#5A5A; END_VAR
  word := word;
END_PROGRAM)";

uint8_t byte_at(const Plant& plant, const std::string& path) {
  const auto symbol = ir::find_symbol(plant.controller->image(), path);
  return symbol.ok() ? plant.controller->memory().data()[symbol->data] : uint8_t{0xee};
}

TEST(CleanBools, EveryBoolOfDataMemoryAndNothingElseIsNormalised) {
  Plant plant(kParts);
  ASSERT_TRUE(plant.ok());
  const ir::Bools bools(plant->image());
  EXPECT_EQ(bools.count(), 2u * (1 + 2 * 4) + 2);
  const char* const kPaths[] = {"g",
                                "P.b",
                                "P.c[0].x",
                                "P.c[1].x",
                                "P.c[0].parts[1].on[0]",
                                "P.c[1].parts[2].on[2]",
                                "P.c[1].parts[1].last"};
  uint8_t* const memory = plant->memory().data();
  for (const char* path : kPaths) {
    const auto symbol = ir::find_symbol(plant->image(), path);
    ASSERT_TRUE(symbol.ok()) << path;
    memory[symbol->data] = 0x80;
  }
  bools.normalise_all(memory);
  for (const char* path : kPaths) EXPECT_EQ(byte_at(plant, path), 1) << path;
  EXPECT_EQ(plant.get("P.word"), "23130");
  EXPECT_EQ(byte_at(plant, "P.c[0].parts[2].on[1]"), 0);
}

TEST(CleanBools, InitialValuesOfAnImage) {
  const auto image = build(kParts);
  ASSERT_TRUE(image);
  ir::Image other = image->image();
  const auto symbol = ir::find_symbol(other, "P.b");
  ASSERT_TRUE(symbol.ok());
  for (ir::DataRun& run : other.data) {
    if (symbol->data < run.offset || symbol->data - run.offset >= run.bytes.size()) continue;
    run.bytes[symbol->data - run.offset] = 0x55;
  }
  const auto verified = ir::verify(ir::encode(other));
  ASSERT_TRUE(verified.ok());
  vm::VirtualClock clock;
  vm::SimulatedIo io;
  auto started = vm::Controller::start(*verified, {}, clock, io);
  ASSERT_TRUE(started.ok());
  const uint8_t* const at = (*started)->memory().data() + symbol->data;
  EXPECT_EQ(*at, 1);
  ASSERT_TRUE((*started)->restart(vm::Restart::kCold, kMs).ok());
  EXPECT_EQ(*at, 1);
}

TEST(CleanBools, RetainedValuesFromStorage) {
  const auto image = build(kParts);
  ASSERT_TRUE(image);
  size_t bytes = 0;
  for (const ir::RetainRange& range : image->image().retain) bytes += range.size;
  ASSERT_NE(bytes, 0u);
  vm::VirtualClock clock;
  vm::SimulatedIo io;
  auto started = vm::Controller::start(*image, {}, clock, io, base::Bytes(bytes, 0xff));
  ASSERT_TRUE(started.ok());
  const auto symbol = ir::find_symbol(image->image(), "g");
  EXPECT_EQ((*started)->memory().data()[symbol->data], 1);
}

// Version 1 may write anything into a BOOL, and version 2 takes each for 0 or 1.
TEST(CleanBools, AVersionThatTrustsThemFindsThemSo) {
  Plant plant("PROGRAM P VAR x, y : BOOL; p : POINTER TO BYTE; END_VAR p := ADR(x); p^ := 16#AA; "
              "END_PROGRAM");
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  EXPECT_EQ(byte_at(plant, "P.x"), 0xaa);
  const auto next = build("PROGRAM P VAR x, y : BOOL; END_VAR y := x; END_PROGRAM", &plant->image());
  ASSERT_TRUE(next);
  auto old = plant->publish(*plant->prepare(*next));
  EXPECT_EQ(byte_at(plant, "P.x"), 1);
  plant.cycles(1);
  EXPECT_EQ(byte_at(plant, "P.y"), 1);
}

TEST(CleanBools, ValuesOfOtherResources) {
  const auto image = build(kParts);
  ASSERT_TRUE(image);
  const ir::Image& i = image->image();
  ir::TypeId part;
  for (uint32_t t = 0; t < i.types.size(); ++t) {
    if (i.types[ir::TypeId(t)].name == "Part") part = ir::TypeId(t);
  }
  ASSERT_TRUE(part.valid());
  const std::vector<ir::PlainRun> runs = ir::plain_runs(i.types, i.layouts, part);
  const std::vector<uint8_t> sent(64, 0xff);
  std::vector<uint8_t> memory(64, 0);
  vm::scatter(runs, sent.data(), memory.data());
  const std::vector<uint32_t>& offsets = i.layouts[part].member_offsets;
  EXPECT_EQ(memory[offsets[0]], 0xff);
  EXPECT_EQ(memory[offsets[0] + 1], 0xff);
  for (uint32_t k = 0; k < 3; ++k) EXPECT_EQ(memory[offsets[1] + k], 1);
  EXPECT_EQ(memory[offsets[2]], 1);
}

TEST(CleanBools, InputsThatAreWholeBytes) {
  Plant plant(R"(
TYPE Part : STRUCT n : BYTE; on : BOOL; END_STRUCT; END_TYPE
PROGRAM P VAR i AT %IB0 : Part; bit AT %IX2.3 : BOOL; END_VAR END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  for (uint32_t i = 0; i < 3; ++i) plant.io.set_input(i, 0xff);
  plant.cycles(1);
  EXPECT_EQ(plant.get("P.i.n"), "16#FF");
  EXPECT_EQ(byte_at(plant, "P.i.on"), 1);
  EXPECT_EQ(byte_at(plant, "P.bit"), 1);
}

}  // namespace
}  // namespace runtime_test
