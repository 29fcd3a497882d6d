// Text of somebody else for a terminal: what would move its cursor, colour it or type for its user
// is shown instead of sent.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace base {

// Control characters (C0, DEL, C1) and bytes that are no UTF-8 become \x1b, those that turn the
// direction of what follows \u202e; all else stays.
std::string visible(std::string_view text);
// The same for text of several lines, which stay lines.
std::string visible_lines(std::string_view text);

// Is one of its characters a control character (C0, DEL, or C1 as UTF-8 writes it)?
bool has_control(std::string_view text);

// The begin of `text`, of at most `limit` bytes, that ends after a whole character of UTF-8. A part
// of `text`; allocates nothing.
std::string_view whole_characters(std::string_view text, size_t limit);

// The character that `text` begins with, where it is one that nobody sees and that changes the
// order in which others are shown (marks, embeddings, overrides and isolates of Unicode's
// bidirectional algorithm): it takes three bytes of UTF-8, or two. 0: another one.
uint32_t direction_control(std::string_view text);
// "\u202e"
std::string code_point_text(uint32_t code);

}  // namespace base
