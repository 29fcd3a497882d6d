#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"
#include "ir/types/time_units.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

constexpr uint64_t kLargest = uint64_t{1} << 63;  // magnitude of the most negative value

class DurationDecoder {
 public:
  explicit DurationDecoder(std::string_view text) : text_(text) {}

  DecodedTime run() {
    out_.is_long = !text_.empty() && to_upper(text_[0]) == 'L';
    at_ = text_.find('#') + 1;
    if (peek() == '-' || peek() == '+') {
      out_.negative = peek() == '-';
      ++at_;
    }
    while (at_ < text_.size() && !out_.problem) component();
    if (!out_.problem && (out_.ns > kLargest || (out_.ns == kLargest && !out_.negative))) {
      overflow();
    }
    return out_;
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void component() {
    size_t begin = at_;
    uint64_t whole = digits();
    if (at_ == begin) return bad(begin, 1, "a number belongs here");
    size_t fraction_at = at_ + 1;
    size_t fraction_end = fraction_at;
    if (peek() == '.') {
      ++at_;
      while (is_digit(peek()) || peek() == '_') ++at_;
      fraction_end = at_;
    }
    size_t unit_at = at_;
    while (is_name_start(peek()) && peek() != '_') ++at_;
    size_t unit = unit_index(text_.substr(unit_at, at_ - unit_at));
    if (unit == ir::kTimeUnits.size()) {
      return bad(unit_at, at_ - unit_at, "a unit d, h, m, s, ms, us or ns belongs after a number");
    }
    if (unit < next_unit_)
      return bad(begin, at_ - begin, "units go from large to small, each once");
    next_unit_ = unit + 1;
    add(whole, ir::kTimeUnits[unit].ns);
    bool has_fraction = fraction_end > fraction_at;
    if (has_fraction) add_fraction(text_.substr(fraction_at, fraction_end - fraction_at), unit);
    while (peek() == '_') ++at_;
    if (has_fraction && at_ < text_.size() && !out_.problem) {
      bad(begin, unit_at - begin, "only the last part of a duration has a fraction");
    }
  }

  // Saturates: add() refuses what does not fit.
  uint64_t digits() {
    uint64_t value = 0;
    for (; is_digit(peek()) || (peek() == '_' && at_ + 1 < text_.size()); ++at_) {
      if (peek() == '_') continue;
      uint64_t digit = digit_value(peek());
      value = value > (kLargest - digit) / 10 ? UINT64_MAX : value * 10 + digit;
    }
    return value;
  }

  static size_t unit_index(std::string_view text) {
    for (size_t i = 0; i < ir::kTimeUnits.size(); ++i) {
      if (ir::same_name(text, ir::kTimeUnits[i].text)) return i;
    }
    return ir::kTimeUnits.size();
  }

  void add(uint64_t count, uint64_t unit_ns) {
    if (count > (kLargest - out_.ns) / unit_ns) return overflow();
    out_.ns += count * unit_ns;
  }

  // Exact: a unit is divisible by ten until what is left is below one nanosecond.
  void add_fraction(std::string_view fraction, size_t unit) {
    uint64_t place_ns = ir::kTimeUnits[unit].ns;
    for (char c : fraction) {
      if (c == '_') continue;
      uint64_t digit_ns = place_ns / 10;
      if (digit_ns * 10 != place_ns) return;
      place_ns = digit_ns;
      add(digit_value(c), place_ns);
    }
  }

  void bad(size_t at, size_t length, std::string text) {
    out_.problem = {DiagnosticCode::kBadDuration, static_cast<uint32_t>(at),
                    static_cast<uint32_t>(length), std::move(text),
                    "write it like T#1h30m or T#2.5s"};
  }
  void overflow() {
    out_.ns = 0;
    out_.problem = {DiagnosticCode::kDurationTooLarge,
                    0,
                    0,
                    "this duration does not fit into 64 bits of nanoseconds",
                    {}};
  }

  std::string_view text_;
  size_t at_ = 0;
  size_t next_unit_ = 0;
  DecodedTime out_;
};

}  // namespace

DecodedTime decode_duration(std::string_view text) { return DurationDecoder(text).run(); }

}  // namespace frontend
