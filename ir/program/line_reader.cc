#include "ir/program/line_reader.h"

#include <array>
#include <charconv>

#include "ir/program/text_names.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

char at(std::string_view text, size_t index) { return index < text.size() ? text[index] : '\0'; }

size_t word_end(std::string_view line, size_t from) {
  while (from < line.size() && is_word_byte(line[from])) {
    ++from;
  }
  return from;
}

// 5, -5, 2.5, 1.0E-05, 16#FF; in 0..10 the points are no part of the number.
size_t number_end(std::string_view line, size_t from) {
  size_t end = word_end(line, from + 1);
  if (at(line, end) == '#') {
    return word_end(line, end + 1);
  }
  if (at(line, end) == '.' && is_decimal_digit(at(line, end + 1))) {
    end = word_end(line, end + 1);
    const char sign = at(line, end);
    if (at(line, end - 1) == 'E' && (sign == '+' || sign == '-')) {
      end = word_end(line, end + 1);
    }
  }
  return end;
}

// After the closing quote; the line's end when there is none. `$` hides a quote.
size_t string_end(std::string_view line, size_t from) {
  for (size_t i = from + 1; i < line.size(); ++i) {
    if (line[i] == '$') {
      ++i;
    } else if (line[i] == '\'') {
      return i + 1;
    }
  }
  return line.size();
}

std::string shown(std::string_view text) {
  return text.empty() ? "the end of the line" : string_text(text.substr(0, 40));
}

}  // namespace

LineReader::LineReader(std::string_view line) { tokenize(line); }

size_t LineReader::token_end(std::string_view line, size_t from, Kind& kind) {
  const char c = line[from];
  const char following = at(line, from + 1);
  const bool sign = (c == '-' || c == '+') && is_word_byte(following);
  if (is_decimal_digit(c) || (sign && is_decimal_digit(following))) {
    kind = Kind::kNumber;
    return number_end(line, from);
  }
  if (is_word_byte(c) || sign) {
    kind = Kind::kWord;
    return word_end(line, from + 1);
  }
  if (c == '\'') {
    kind = Kind::kString;
    return string_end(line, from);
  }
  kind = Kind::kPunctuation;
  return from + 1;
}

void LineReader::tokenize(std::string_view line) {
  for (size_t from = 0; from < line.size();) {
    if (is_space(line[from])) {
      ++from;
      continue;
    }
    if (line.substr(from, 2) == "//") {
      return;
    }
    Kind kind = Kind::kWord;
    const size_t end = token_end(line, from, kind);
    tokens_.push_back({kind, line.substr(from, end - from)});
    from = end;
  }
}

void LineReader::fail(std::string reason) {
  if (reason_.empty()) {
    reason_ = std::move(reason);
  }
}

std::string_view LineReader::peek() const {
  return at_end() || failed() ? std::string_view() : tokens_[at_].text;
}

bool LineReader::peek_name() const {
  return !at_end() && !failed() &&
         (tokens_[at_].kind == Kind::kWord || tokens_[at_].kind == Kind::kString);
}

bool LineReader::take(std::string_view text) {
  if (peek() != text || text.empty() || tokens_[at_].kind == Kind::kString) {
    return false;
  }
  ++at_;
  return true;
}

void LineReader::expect(std::string_view text) {
  if (!take(text)) {
    fail("expected " + shown(text) + ", found " + shown(peek()));
  }
}

const LineReader::Token* LineReader::next(Kind kind, std::string_view what) {
  if (failed() || at_end() || tokens_[at_].kind != kind) {
    fail("expected " + std::string(what) + ", found " + shown(peek()));
    return nullptr;
  }
  return &tokens_[at_++];
}

std::string LineReader::name() {
  if (!at_end() && tokens_[at_].kind == Kind::kString) {
    return string();
  }
  return std::string(word());
}

std::string LineReader::string() {
  const Token* token = next(Kind::kString, "a string");
  if (token == nullptr) {
    return {};
  }
  base::Result<std::string> bytes = parse_string(token->text);
  if (!bytes.ok()) {
    fail(bytes.error().text);
    return {};
  }
  return *std::move(bytes);
}

std::string_view LineReader::word() {
  const Token* token = next(Kind::kWord, "a name");
  return token != nullptr ? token->text : std::string_view();
}

std::string_view LineReader::token() {
  if (failed() || at_end()) {
    fail("the line ends too early");
    return {};
  }
  return tokens_[at_++].text;
}

int64_t LineReader::signed_number() {
  const Token* token = next(Kind::kNumber, "a number");
  int64_t value = 0;
  if (token == nullptr) {
    return 0;
  }
  const char* end = token->text.data() + token->text.size();
  const auto read = std::from_chars(token->text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) {
    fail("expected an integer, found " + shown(token->text));
    return 0;
  }
  return value;
}

uint64_t LineReader::number(uint64_t limit) {
  const Token* token = next(Kind::kNumber, "a number");
  uint64_t value = 0;
  if (token == nullptr) {
    return 0;
  }
  const char* end = token->text.data() + token->text.size();
  const auto read = std::from_chars(token->text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || value > limit) {
    fail("expected a number up to " + std::to_string(limit) + ", found " + shown(token->text));
    return 0;
  }
  return value;
}

uint32_t LineReader::numbered(char letter) {
  const std::string_view text = word();
  uint32_t value = 0;
  if (failed()) {
    return 0;
  }
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + 1, end, value);
  if (text[0] != letter || read.ec != std::errc() || read.ptr != end || value == 0xffffffff) {
    fail("expected " + std::string(1, letter) + " and a number, found " + shown(text));
    return 0;
  }
  return value;
}

ConstId LineReader::constant() {
  expect("#");
  return ConstId(index());
}

uint32_t LineReader::choice(std::span<const std::string_view> words) {
  const std::string_view text = word();
  for (uint32_t i = 0; i < words.size(); ++i) {
    if (words[i] == text) {
      return i;
    }
  }
  fail("unknown word " + shown(text));
  return 0;
}

Scalar LineReader::scalar() {
  constexpr auto kNames = std::to_array<std::string_view>({
#define SCALAR(id, text, bytes) text,
#include "ir/types/scalars.def"
#undef SCALAR
  });
  return static_cast<Scalar>(choice(kNames));
}

void LineReader::policy(TaskPolicy& policy) {
  const std::string_view attribute = word();
  const bool has_value = !at_end() && attribute != kFreewheeling;
  const std::string_view value = has_value ? word() : "";
  if (!apply_policy(policy, attribute, value)) fail("unknown task policy");
}

Schedule LineReader::schedule() {
  const std::optional<Schedule> found = schedule_of(word());
  if (!found) fail("unknown schedule");
  return found.value_or(Schedule::kSendFirst);
}

}  // namespace ir
