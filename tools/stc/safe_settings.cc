#include "tools/stc/safe_settings.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "frontend/lex/literals.h"
#include "ir/types/address_text.h"
#include "ir/types/longest_time.h"
#include "ir/types/types.h"

namespace stc {
namespace {

constexpr const char* kForms =
    "write `%QX0.0 = TRUE`, `%QW2 = 16#1234`, `%QB4 = hold` or `%QX0.1 = hold 500ms then FALSE`";

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// Digits of any base, or digits, a point, digits and perhaps an exponent.
bool is_number_text(std::string_view text) {
  if (text.empty() || text.front() < '0' || text.front() > '9') return false;
  if (text.find('.') == std::string_view::npos) {
    return text.find_first_not_of("0123456789abcdefABCDEF#_") == std::string_view::npos;
  }
  const auto digits = [&] {
    const size_t count = std::min(text.find_first_not_of("0123456789_"), text.size());
    text.remove_prefix(count);
    return count != 0;
  };
  if (!digits() || !text.starts_with('.')) return false;
  text.remove_prefix(1);
  if (!digits()) return false;
  if (text.empty()) return true;
  if (text.front() != 'e' && text.front() != 'E') return false;
  text.remove_prefix(1);
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return digits() && text.empty();
}

// A number with a point for REAL and LREAL; negative ones in two's complement.
std::optional<uint64_t> value_of(std::string_view text, uint32_t bits) {
  if (ir::same_name(text, "TRUE")) return bits == 1 ? std::optional(uint64_t{1}) : std::nullopt;
  if (ir::same_name(text, "FALSE")) return bits == 1 ? std::optional(uint64_t{0}) : std::nullopt;
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (!is_number_text(text)) return std::nullopt;
  if (text.find('.') != std::string_view::npos) {
    const frontend::DecodedReal real = frontend::decode_real(text);
    if (real.problem || bits < 32) return std::nullopt;
    const double value = negative ? -real.value : real.value;
    if (bits == 32 && real.value > std::numeric_limits<float>::max()) return std::nullopt;
    if (bits == 32) return std::bit_cast<uint32_t>(static_cast<float>(value));
    return std::bit_cast<uint64_t>(value);
  }
  const frontend::DecodedInteger number = frontend::decode_integer(text);
  if (number.problem || number.too_large) return std::nullopt;
  const uint64_t limit = bits == 64 ? UINT64_MAX : (uint64_t{1} << bits) - 1;
  if (!negative) return number.value <= limit ? std::optional(number.value) : std::nullopt;
  if (bits == 1 || number.value > limit / 2 + 1) return std::nullopt;
  return (0 - number.value) & limit;
}

// `500ms` is T#500ms.
std::optional<int64_t> duration_of(const std::string& text) {
  const frontend::DecodedTime time =
      frontend::decode_duration(text.find('#') == std::string::npos ? "T#" + text : text);
  if (time.problem || time.negative || time.ns > ir::kLongestTimeNs) return std::nullopt;
  return static_cast<int64_t>(time.ns);
}

// Nothing when it has no meaning.
std::optional<ir::SafeOutput> parse_entry(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  if (words.size() < 3 || words[1] != "=") return std::nullopt;
  const std::optional<ir::DirectAddress> at = ir::parse_address(words[0]);
  if (!at || at->area != ir::DirectArea::kOutput) return std::nullopt;
  ir::SafeOutput row{at->bit_offset, at->bit_size, ir::SafeKind::kValue, 0, 0};
  std::optional<uint64_t> value = uint64_t{0};
  if (!ir::same_name(words[2], "hold")) {
    value = value_of(words[2], row.bits);
    if (words.size() != 3) return std::nullopt;
  } else if (words.size() == 3) {
    row.kind = ir::SafeKind::kHold;
  } else {
    row.kind = ir::SafeKind::kHoldThenValue;
    const std::optional<int64_t> hold = duration_of(words[3]);
    const bool then = words.size() == 6 && ir::same_name(words[4], "then");
    if (!hold || (!then && words.size() != 4)) return std::nullopt;
    row.hold_ns = *hold;
    if (then) value = value_of(words[5], row.bits);
  }
  if (!value) return std::nullopt;
  row.value = *value;
  return row;
}

std::string byte_text(uint32_t bit_offset) { return "%QB" + std::to_string(bit_offset / 8); }

}  // namespace

base::Result<SafeSettings> parse_safe_settings(const std::string& file,
                                               const tools::TomlValue& value) {
  const auto wrong = [&](tools::TomlPlace place, std::string what) {
    return tools::toml_error(file, place.line, place.column, std::move(what));
  };
  const auto* list = std::get_if<std::vector<std::string>>(&value.data);
  if (list == nullptr) return wrong(value.place, "`outputs.safe` must be a list of texts");
  std::vector<std::pair<ir::SafeOutput, tools::TomlPlace>> entries;
  for (size_t i = 0; i < list->size(); ++i) {
    const std::string& text = (*list)[i];
    const std::optional<ir::SafeOutput> row = parse_entry(text);
    if (!row) return wrong(value.places[i], "`" + text + "` is no safe value; " + kForms);
    entries.emplace_back(*row, value.places[i]);
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.first.bit_offset < b.first.bit_offset;
  });
  SafeSettings settings{file, {}, {}};
  for (const auto& [row, place] : entries) {
    const bool meets = !settings.rows.empty() &&
                       settings.rows.back().bit_offset + settings.rows.back().bits > row.bit_offset;
    if (meets) return wrong(place, "two safe values for a bit of " + byte_text(row.bit_offset));
    settings.rows.push_back(row);
    settings.places.push_back(place);
  }
  return settings;
}

std::vector<ir::SafeOutput> safe_rows_inside(const SafeSettings& settings, uint32_t output_bytes) {
  std::vector<ir::SafeOutput> rows;
  for (const ir::SafeOutput& row : settings.rows) {
    if (uint64_t{row.bit_offset} + row.bits <= uint64_t{output_bytes} * 8) rows.push_back(row);
  }
  return rows;
}

base::Status check_safe_settings(const SafeSettings& settings, uint32_t output_bytes) {
  for (size_t i = 0; i < settings.rows.size(); ++i) {
    const ir::SafeOutput& row = settings.rows[i];
    if (uint64_t{row.bit_offset} + row.bits <= uint64_t{output_bytes} * 8) continue;
    return tools::toml_error(settings.file, settings.places[i].line, settings.places[i].column,
                             "a safe value at " + byte_text(row.bit_offset) +
                                 ", but the outputs of this program end before %QB" +
                                 std::to_string(output_bytes));
  }
  return base::Ok{};
}

}  // namespace stc
