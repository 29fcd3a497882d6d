// The library's ExceptionCode is the table of traps, counted from 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "ir/program/ir.h"
#include "stdlib/sources.h"

namespace {

TEST(ExceptionCode, HasEveryTrap) {
  const auto sources = stdlib::library_sources();
  const auto found = std::find_if(sources.begin(), sources.end(), [](const auto& source) {
    return source.name.find("exceptions") != std::string_view::npos;
  });
  ASSERT_NE(found, sources.end());
  const std::string text(found->text);
  const char* const names[] = {
      "DivisionByZero",   "ArrayIndex",      "Subrange",  "Conversion", "ForStepZero",
      "InvalidReference", "MissingInstance", "OutOfFuel", "Watchdog",   "CallDepth",
      "StringRange",      "AssertionFailed", "Overrun",   "NotANumber", "IoLost"};
  ASSERT_EQ(std::size(names), ir::kTrapCount);
  for (uint32_t kind = 0; kind < ir::kTrapCount; ++kind) {
    const std::string line = std::string(names[kind]) + " := " + std::to_string(kind + 1);
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
  EXPECT_STREQ(ir::trap_name(ir::TrapKind::kDivisionByZero), "division-by-zero");
  EXPECT_EQ(static_cast<uint32_t>(ir::TrapKind::kIndex), 1u);
  EXPECT_EQ(static_cast<uint32_t>(ir::TrapKind::kReference), 5u);
  EXPECT_EQ(static_cast<uint32_t>(ir::TrapKind::kString), 10u);
}

}  // namespace
