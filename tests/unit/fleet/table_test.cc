// Tables for terminals.
#include <gtest/gtest.h>

#include <string>

#include "tools/common/table.h"

namespace tools {
namespace {

// Names come from controllers and agents, which may be anybody's.
TEST(Table, ControlCharactersAreShownNotSent) {
  Table table({"name"});
  table.row({"a\x1b[2Jb"});
  const std::string text = table.text(80);
  EXPECT_NE(text.find("a\\x1b[2Jb"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace tools
