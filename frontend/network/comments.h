// Comments as the text forms keep them: what they say, without marks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frontend::network {

struct Comment {
  size_t begin = 0;  // of its mark in the text
  std::string text;
};

// The comments in a text of Structured Text's tokens; strings are skipped.
std::vector<Comment> comments_in(std::string_view text);

// Where a comment that begins at `at` ends, after its mark; `at` when none begins there. One
// that is never closed ends with the text.
size_t comment_end(std::string_view text, size_t at);

// What stands between the marks of a whole comment: lines without the blanks around them.
std::string comment_text(std::string_view comment);

}  // namespace frontend::network
