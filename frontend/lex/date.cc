#include <chrono>
#include <limits>

#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"
#include "ir/types/time_units.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

// Years whose days all fit into 64 bits of nanoseconds around 1970.
constexpr uint64_t kFirstYear = 1678;
constexpr uint64_t kLastYear = 2261;

class DateDecoder {
 public:
  explicit DateDecoder(std::string_view text) : text_(text) {}

  DecodedDate run() {
    size_t hash = text_.find('#');
    std::string_view prefix = text_.substr(0, hash);
    out_.time.is_long = to_upper(prefix[0]) == 'L';
    if (out_.time.is_long) prefix.remove_prefix(1);
    out_.form = form_of(prefix);
    at_ = hash + 1;
    if (out_.form != DateForm::kTimeOfDay) date();
    if (out_.form == DateForm::kDateAndTime) skip('-', "a time of day belongs after the date");
    if (out_.form != DateForm::kDate) time_of_day();
    if (at_ < text_.size()) bad(at_, "nothing more belongs here");
    if (!out_.time.problem) store();
    return out_;
  }

 private:
  static DateForm form_of(std::string_view prefix) {
    if (ir::same_name(prefix, "D") || ir::same_name(prefix, "DATE")) return DateForm::kDate;
    if (ir::same_name(prefix, "TOD") || ir::same_name(prefix, "TIME_OF_DAY")) {
      return DateForm::kTimeOfDay;
    }
    return DateForm::kDateAndTime;
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  uint64_t number(const char* what, uint64_t low, uint64_t high) {
    size_t begin = at_;
    uint64_t value = 0;
    while (is_digit(peek()) || (peek() == '_' && at_ > begin)) {
      if (peek() != '_') value = std::min<uint64_t>(value * 10 + digit_value(peek()), 1'000'000);
      ++at_;
    }
    if (at_ == begin) {
      bad(begin, std::string(what) + " is missing");
    } else if (value < low || value > high) {
      bad(begin,
          std::string(what) + " is from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return value;
  }

  void skip(char joiner, const char* otherwise) {
    if (peek() == joiner) {
      ++at_;
    } else {
      bad(at_, otherwise);
    }
  }

  void date() {
    uint64_t year = number("the year", kFirstYear, kLastYear);
    skip('-', "`-` and the month belong here");
    uint64_t month = number("the month", 1, 12);
    skip('-', "`-` and the day belong here");
    size_t day_at = at_;
    uint64_t day = number("the day", 1, 31);
    if (out_.time.problem) return;
    std::chrono::year_month_day civil{std::chrono::year(static_cast<int>(year)),
                                      std::chrono::month(static_cast<unsigned>(month)),
                                      std::chrono::day(static_cast<unsigned>(day))};
    if (!civil.ok()) return bad(day_at, "this month has no day " + std::to_string(day));
    ns_ = std::chrono::sys_days(civil).time_since_epoch().count() * ir::kNsPerDay;
  }

  void time_of_day() {
    uint64_t hour = number("the hour", 0, 23);
    skip(':', "`:` and the minute belong here");
    uint64_t minute = number("the minute", 0, 59);
    uint64_t second = 0;
    if (peek() == ':') {
      ++at_;
      second = number("the second", 0, 59);
    }
    ns_ += static_cast<int64_t>((hour * 60 + minute) * 60 + second) * ir::kNsPerSecond;
    if (peek() == '.') fraction();
  }

  void fraction() {
    ++at_;
    for (int64_t place_ns = ir::kNsPerSecond; is_digit(peek()) || peek() == '_'; ++at_) {
      if (peek() == '_') continue;
      place_ns /= 10;
      ns_ += static_cast<int64_t>(digit_value(peek())) * place_ns;
    }
  }

  void store() {
    out_.time.negative = ns_ < 0;
    out_.time.ns = ns_ < 0 ? 0 - static_cast<uint64_t>(ns_) : static_cast<uint64_t>(ns_);
  }

  void bad(size_t at, std::string text) {
    if (out_.time.problem) return;
    const char* form = out_.form == DateForm::kDate        ? "write it like D#2024-12-31"
                       : out_.form == DateForm::kTimeOfDay ? "write it like TOD#23:59:59.5"
                                                           : "write it like DT#2024-12-31-23:59:59";
    uint32_t length = static_cast<uint32_t>(at < text_.size() ? text_.size() - at : 0);
    out_.time.problem = {DiagnosticCode::kBadDate, static_cast<uint32_t>(length == 0 ? 0 : at),
                         length, std::move(text), form};
  }

  std::string_view text_;
  size_t at_ = 0;
  int64_t ns_ = 0;
  DecodedDate out_;
};

}  // namespace

DecodedDate decode_date(std::string_view text) { return DateDecoder(text).run(); }

}  // namespace frontend
