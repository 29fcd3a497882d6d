#include "base/source.h"

#include <gtest/gtest.h>

namespace base {
namespace {

TEST(SourceMap, LocatesOverSeveralFiles) {
  SourceMap sources;
  SourcePos a = sources.add("a.st", "one\r\ntwo\n");
  SourcePos b = sources.add("b.st", "");
  SourcePos c = sources.add("c.st", "three");
  EXPECT_EQ(sources.file_of(a), 0u);
  EXPECT_EQ(sources.file_of(b), 1u);
  SourceLocation at = sources.locate({a.offset + 6});
  EXPECT_EQ(at.file, "a.st");
  EXPECT_EQ(at.line, 2u);
  EXPECT_EQ(at.column, 2u);
  EXPECT_EQ(at.line_text, "two");
  EXPECT_EQ(sources.locate(a).line_text, "one");
  at = sources.locate({c.offset + 5});
  EXPECT_EQ(at.file, "c.st");
  EXPECT_EQ(at.column, 6u);
}

TEST(SourceMap, PlacesOutsideAreUnknown) {
  SourceMap sources;
  sources.add("a.st", "x");
  EXPECT_EQ(sources.locate({}).line, 0u);
  EXPECT_EQ(sources.locate({1000}).line, 0u);
  EXPECT_EQ(sources.file_of({1000}), sources.file_count());
}

}  // namespace
}  // namespace base
