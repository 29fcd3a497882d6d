// What a hostile name may do to a terminal: nothing.
#include "base/visible_text.h"

#include <gtest/gtest.h>

namespace base {
namespace {

TEST(VisibleText, KeepsWhatPeopleRead) {
  for (const char* text : {"", "Line.Filler.Count", "16#00FF 'ab$'c' \\ ~", "Füllstand µ € 漢 😀"}) {
    EXPECT_EQ(visible(text), text);
  }
}

TEST(VisibleText, ShowsControlCharacters) {
  EXPECT_EQ(visible("\x1b[2Jx\x1b]0;title\x07"), "\\x1b[2Jx\\x1b]0;title\\x07");
  EXPECT_EQ(visible("a\nb\r\tc\x7f"), "a\\x0ab\\x0d\\x09c\\x7f");
  EXPECT_EQ(visible(std::string("\0", 1)), "\\x00");
  EXPECT_EQ(visible("\xc2\x9b" "31m"), "\\xc2\\x9b31m") << "CSI as one character";
  EXPECT_EQ(visible("\x9b" "31m"), "\\x9b31m") << "CSI as one byte";
}

// A text that shows its characters in another order than it has them.
TEST(VisibleText, ShowsWhatTurnsTheDirection) {
  EXPECT_EQ(visible("a\u202e" "b\u2066" "c"), "a\\u202eb\\u2066c");
  std::string all;
  for (const char* one : {"\u061c", "\u200e", "\u200f", "\u202a", "\u202b", "\u202c", "\u202d",
                          "\u202e", "\u2066", "\u2067", "\u2068", "\u2069"}) {
    EXPECT_NE(direction_control(one), 0u);
    EXPECT_EQ(visible(one), code_point_text(direction_control(one)));
    all += one;
  }
  EXPECT_EQ(visible(all).size(), 12 * 6u);
  for (const char* other : {"\u061b", "\u200d", "\u2010", "\u2029", "\u202f", "\u2065", "\u206a"}) {
    EXPECT_EQ(visible(other), other);
  }
  EXPECT_EQ(visible("\xe2\x80"), "\\xe2\\x80") << "cut off";
}

TEST(VisibleText, KeepsLines) {
  EXPECT_EQ(visible_lines("a\x1b\n\nb\r\n"), "a\\x1b\n\nb\\x0d\n");
  EXPECT_EQ(visible_lines(""), "");
  EXPECT_EQ(visible_lines("c\x9b"), "c\\x9b");
}

TEST(VisibleText, ShowsWhatIsNoUtf8) {
  EXPECT_EQ(visible("\xc3"), "\\xc3");
  EXPECT_EQ(visible("\xc0\x9b"), "\\xc0\\x9b");
  EXPECT_EQ(visible("\xe0\x82\x9b"), "\\xe0\\x82\\x9b") << "longer than need be";
  EXPECT_EQ(visible("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(visible("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(visible("\xf0\x9f\x98"), "\\xf0\\x9f\\x98");
  EXPECT_EQ(visible("\xff\xfe"), "\\xff\\xfe");
}

}  // namespace
}  // namespace base
