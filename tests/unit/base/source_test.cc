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

TEST(SourceMap, AnotherTextMovesTheFilesBehindIt) {
  SourceMap sources;
  const SourcePos a = sources.add("a.st", "one\ntwo\n");
  const uint32_t b = sources.add("b.st", "three").offset;
  EXPECT_EQ(sources.locate({a.offset + 4}).line_text, "two");
  sources.replace(0, "one\nand\ntwo more\n");
  EXPECT_EQ(sources.begin(1).offset, b + 9);
  EXPECT_EQ(sources.locate({a.offset + 8}).line_text, "two more");
  EXPECT_EQ(sources.locate(sources.begin(1)).file, "b.st");
  EXPECT_EQ(sources.end().offset, b + 9 + 6);
}

TEST(SourceMap, PiecesOfEarlierTextsAreFoundInTheLastOne) {
  SourceMap sources;
  const uint32_t old = sources.add("a.st", "head\nbody\ntail\n").offset;
  const uint32_t now = sources.add("a.st", "head\n\nother\ntail\n").offset;
  sources.set_pieces({{old, 5, now}, {old + 10, 5, now + 12}});
  EXPECT_EQ(sources.locate({old + 1}).line, 1u);
  EXPECT_EQ(sources.locate({old + 10}).line, 4u);
  EXPECT_EQ(sources.locate({old + 10}).line_text, "tail");
  EXPECT_EQ(sources.current({old + 15}).offset, now + 17);  // the end of a piece
  EXPECT_EQ(sources.current({now + 7}).offset, now + 7);
  EXPECT_FALSE(sources.current({}).valid());
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
