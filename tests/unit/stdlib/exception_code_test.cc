// The library's ExceptionCode is the table of traps, counted from 1.
#include <gtest/gtest.h>

#include <algorithm>
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
  EXPECT_EQ(static_cast<uint32_t>(ir::TrapKind::kDivisionByZero) + 1, 1u);
  EXPECT_NE(text.find("DivisionByZero := 1,"), std::string::npos);
  EXPECT_NE(
      text.find("ArrayIndex := " + std::to_string(static_cast<uint32_t>(ir::TrapKind::kIndex) + 1)),
      std::string::npos);
  EXPECT_NE(text.find("InvalidReference := " +
                      std::to_string(static_cast<uint32_t>(ir::TrapKind::kReference) + 1)),
            std::string::npos);
  EXPECT_NE(text.find("StringRange := " +
                      std::to_string(static_cast<uint32_t>(ir::TrapKind::kString) + 1)),
            std::string::npos);
  EXPECT_NE(text.find("AssertionFailed := " + std::to_string(ir::kTrapCount)), std::string::npos);
}

}  // namespace
