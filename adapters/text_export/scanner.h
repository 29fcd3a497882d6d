// A place in the text of an export that moves over blanks, comments, words and lines.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

namespace text_export {

class Scanner {
 protected:
  explicit Scanner(std::string_view text) : text_(text) {}
  ~Scanner() = default;

  bool at_end() const { return at_ >= text_.size(); }
  std::string_view rest() const { return text_.substr(at_); }
  uint32_t size() const { return static_cast<uint32_t>(text_.size()); }
  uint32_t line_end() const {
    return static_cast<uint32_t>(std::min(text_.find('\n', at_), text_.size()));
  }
  void skip_line() { at_ = std::min<uint32_t>(line_end() + 1, size()); }
  void skip_blanks();
  void skip_comment();
  void skip_blanks_and_comments();
  std::string_view word();       // that stands here; takes it
  std::string_view next_word();  // behind what is no word; takes it. Empty: the end
  // Up to in front of `wanted`: a word of Structured Text, or at the begin of a line of a drawing.
  bool seek_word(std::string_view wanted);
  bool seek_line(std::string_view wanted);

  std::string_view text_;
  uint32_t at_ = 0;
  bool nested_ = true;  // comments nest
  // Where a comment began that does not end.
  std::optional<uint32_t> open_comment_;
};

}  // namespace text_export
