// One line of IR text as tokens: words, numbers, '...' strings, single
// characters. The first thing that does not fit latches `failed()`; later reads
// return zero values, and the caller checks once per line.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/program/ir.h"

namespace ir {

class LineReader {
 public:
  explicit LineReader(std::string_view line);

  bool at_end() const { return at_ == tokens_.size(); }
  bool failed() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }
  void fail(std::string reason);

  // The next token's text without moving; "" at the end.
  std::string_view peek() const;
  bool peek_name() const;
  // Takes the next token when it is exactly `text` (never a quoted one).
  bool take(std::string_view text);
  void expect(std::string_view text);

  std::string name();  // a word, or '...' decoded
  std::string string();
  std::string_view word();
  std::string_view token();  // any
  int64_t signed_number();
  uint64_t number(uint64_t limit = std::numeric_limits<uint64_t>::max());
  uint32_t index() { return static_cast<uint32_t>(number(0xfffffffe)); }
  // "v12", "b3": the number after the letter.
  uint32_t numbered(char letter);
  ConstId constant();  // #N
  // Position of the next word in `words`.
  uint32_t choice(std::span<const std::string_view> words);
  Scalar scalar();
  void policy(TaskPolicy& policy);  // an attribute, with its value if it has one
  Schedule schedule();

 private:
  enum class Kind : uint8_t { kWord, kNumber, kString, kPunctuation };
  struct Token {
    Kind kind;
    std::string_view text;
  };
  void tokenize(std::string_view line);
  size_t token_end(std::string_view line, size_t at, Kind& kind);
  const Token* next(Kind kind, std::string_view what);

  std::vector<Token> tokens_;
  size_t at_ = 0;
  std::string reason_;
};

}  // namespace ir
