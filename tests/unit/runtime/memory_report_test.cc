// What is left of data memory, as status shows it.
#include "vm/runtime/memory_report.h"

#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

TEST(MemoryReport, A6_EveryByteIsUsedSlackOrFree) {
  const char* const source =
      "FUNCTION_BLOCK B VAR n : ARRAY[1..10] OF INT; END_VAR n[1] := 1; END_FUNCTION_BLOCK\n"
      "VAR_GLOBAL g : LINT; END_VAR\n"
      "PROGRAM P VAR a : ARRAY[1..5] OF B; t : TON; END_VAR a[1](); END_PROGRAM";
  Plant plant(source);
  ASSERT_TRUE(plant.ok());
  const vm::MemoryReport report = vm::memory_report(plant->image());
  EXPECT_EQ(report.globals.areas, 1u);
  EXPECT_EQ(report.programs.areas, 1u);
  EXPECT_EQ(report.instances.areas, 6u);
  EXPECT_GE(report.globals.used, 8u);
  EXPECT_GE(report.instances.used, 5u * 20u);
  EXPECT_GT(report.instances.slack, 0u);
  uint64_t sum = ir::kDataBegin + report.free;
  for (const vm::AreaRoom& room : {report.globals, report.programs, report.instances}) {
    sum += room.used + room.slack;
  }
  EXPECT_EQ(sum, report.capacity);
  EXPECT_EQ(report.largest_free, report.free) << "one piece, behind all areas";

  // Growth inside the slack takes from it; beyond it an area moves, and leaves a second free piece.
  auto grown =
      build(std::string(source).replace(std::string(source).find("g : LINT"), 8, "g, h : LINT"),
            &plant->image());
  ASSERT_TRUE(grown.has_value());
  const vm::MemoryReport after = vm::memory_report(grown->image());
  EXPECT_EQ(after.globals.used, report.globals.used + 8);
  EXPECT_EQ(after.globals.slack, report.globals.slack - 8);
  EXPECT_EQ(after.free, report.free);
}

}  // namespace
}  // namespace runtime_test
