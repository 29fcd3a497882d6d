// Text of a literal token -> its value. Pure functions over bounded text. What is
// wrong with a literal comes back as a LiteralProblem with a place inside the
// text; the value is then a usable stand-in, so that one mistake gives one message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "ir/types/types.h"

namespace frontend {

struct LiteralProblem {
  base::DiagnosticCode code;
  uint32_t at = 0;      // within the literal's text
  uint32_t length = 0;  // 0: the whole literal
  std::string text;
  std::string fix;
};
using MaybeProblem = std::optional<LiteralProblem>;

struct DecodedInteger {
  uint64_t value = 0;
  bool based = false;
  bool too_large = false;
  MaybeProblem problem;
};
// 12, 1_000, 2#1010, 8#17, 16#FF
DecodedInteger decode_integer(std::string_view text);

struct DecodedReal {
  double value = 0;
  MaybeProblem problem;
};
// 1.5, 1_000.5, 1E6, 2.5e-3
DecodedReal decode_real(std::string_view text);

struct DecodedTime {
  uint64_t ns = 0;  // magnitude
  bool negative = false;
  bool is_long = false;
  MaybeProblem problem;
};
// T#1h30m, TIME#-1.5s, LT#3us_20ns. Digits below one nanosecond are dropped.
DecodedTime decode_duration(std::string_view text);

enum class DateForm : uint8_t { kDate, kTimeOfDay, kDateAndTime };
struct DecodedDate {
  DateForm form = DateForm::kDate;
  DecodedTime time;  // since 1970-01-01 or midnight
};
// D#2024-02-29, TOD#12:30:15.25, DT#2024-02-29-12:30:15, and their long forms
DecodedDate decode_date(std::string_view text);

struct DecodedString {
  std::string bytes;
  MaybeProblem problem;
};
// How the bytes above 0x7F of a source are read, and what a string makes of its characters.
enum class StringCharset : uint8_t {
  kLatin1Source,     // bytes stay as they are
  kUtf8Source,       // one Latin-1 byte for each character; U+0100 and above is a problem
  kUtf8SourceBytes,  // USTRING#'...', UTF8#'...': the UTF-8 bytes stay
  kLatin1ToUtf8,     // the same in a Latin-1 source
};
// '...' with its quotes; escapes resolved. $N and $L are LF, $R is CR, $P is FF, $T is TAB.
// STRING counts characters of the source's charset: 'grün' fits STRING[4] in every file.
DecodedString decode_string(std::string_view text, StringCharset charset);
// "..." -> UTF-16LE. `latin1` tells how the source's bytes above 0x7F are read.
DecodedString decode_wide_string(std::string_view text, bool latin1);

// Is a source text Latin-1, that is, not valid UTF-8?
bool is_latin1(std::string_view source);

struct DecodedAddress {
  ir::DirectAddress address;     // no area: relative to a structure, %B4
  bool incomplete = false;       // %I*, %QW*
  std::vector<uint32_t> levels;  // of a hierarchical address, %IW2.5.7.1; else empty
  MaybeProblem problem;
};
// %IX0.3, %QW4, %MD8, %I2.0
DecodedAddress decode_address(std::string_view text);

struct DecodedModule {
  ir::DirectArea area = ir::DirectArea::kNone;
  std::vector<uint32_t> levels;
  MaybeProblem problem;
};
// %I2.5.7: what hierarchical addresses begin with.
DecodedModule decode_module(std::string_view text);

struct DecodedPart {
  uint32_t number = 0;
  uint8_t bit_size = 1;
  MaybeProblem problem;
};
// %X3 %B1 %W1 %D0 after a dot
DecodedPart decode_part(std::string_view text);

}  // namespace frontend
