#include "vm/io/csv_inputs.h"

#include <charconv>

#include "ir/types/address_text.h"
#include "ir/types/time_units.h"

namespace vm {
namespace {

constexpr int64_t kMostMs = INT64_MAX / ir::kNsPerMillisecond;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

template <class T>
bool parse_whole(std::string_view text, T& value, int base = 10) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return code == std::errc() && end == text.data() + text.size() && !text.empty();
}

// "12", "12.5": six digits after the point are nanoseconds.
bool parse_time(std::string_view text, int64_t& ns) {
  if (text.starts_with('-')) return false;
  const size_t point = std::min(text.find('.'), text.size());
  int64_t ms = 0;
  if (!parse_whole(text.substr(0, point), ms) || ms < 0 || ms >= kMostMs) return false;
  ns = ms * ir::kNsPerMillisecond;
  if (point == text.size()) return true;
  std::string fraction(text.substr(point + 1));
  int64_t part = 0;
  if (fraction.empty() || fraction.size() > 6) return false;
  fraction.resize(6, '0');
  if (fraction[0] == '-' || !parse_whole(std::string_view(fraction), part)) return false;
  ns += part;
  return true;
}

bool parse_cell(std::string_view text, uint32_t bits, uint64_t& value) {
  if (text == "TRUE" || text == "FALSE") {
    value = text == "TRUE" ? 1 : 0;
    return bits == 1;
  }
  const uint64_t most = bits == 64 ? UINT64_MAX : (uint64_t{1} << bits) - 1;
  if (text.starts_with("16#")) return parse_whole(text.substr(3), value, 16) && value <= most;
  if (!text.starts_with('-')) return parse_whole(text, value) && value <= most;
  int64_t negative = 0;
  if (bits == 1 || !parse_whole(text, negative)) return false;
  if (bits != 64 && negative < -(int64_t{1} << (bits - 1))) return false;
  value = static_cast<uint64_t>(negative) & most;
  return true;
}

}  // namespace

class CsvParser {
 public:
  CsvParser(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  base::Result<CsvInputs> run() {
    while (!text_.empty() && error_.empty()) {
      const size_t end = std::min(text_.find('\n'), text_.size());
      const std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
      if (out_.columns_.empty() && lost_column_ == kNone) {
        header(line);
      } else {
        row(line);
      }
    }
    if (error_.empty() && out_.columns_.empty() && lost_column_ == kNone) {
      fail(0, "no header: time_ms,%IX0.0,%IW2");
    }
    if (!error_.empty()) return base::Error{base::Refusal::kDeviceFailed, error_};
    out_.values_.resize(out_.columns_.size());
    return std::move(out_);
  }

 private:
  static constexpr size_t kNone = SIZE_MAX;
  static constexpr size_t kMostColumns = 4096;

  void fail(size_t column, const std::string& what) {
    if (!error_.empty()) return;
    error_ = file_ + ":" + std::to_string(line_) + ":" + std::to_string(column + 1) + ": " + what;
  }

  template <class Each>
  void cells(std::string_view line, Each each) {
    size_t begin = 0;
    for (size_t number = 0; error_.empty(); ++number) {
      const size_t end = std::min(line.find(',', begin), line.size());
      each(number, begin, trimmed(line.substr(begin, end - begin)));
      if (end == line.size()) return;
      begin = end + 1;
    }
  }

  void header(std::string_view line) {
    cells(line, [&](size_t number, size_t at, std::string_view cell) {
      if (number == 0) {
        if (cell != "time_ms") fail(at, "the first column is `time_ms`");
        return;
      }
      ++cells_;
      if (cell == "lost") {
        if (lost_column_ != kNone) fail(at, "a second column `lost`");
        lost_column_ = number;
        return;
      }
      const auto address = ir::parse_address(cell);
      if (!address || address->area != ir::DirectArea::kInput) {
        fail(at, "`" + std::string(cell) + "` is no input: %IX0.0, %IW2, or `lost`");
      } else if (out_.columns_.size() == kMostColumns) {
        fail(at, "more than " + std::to_string(kMostColumns) + " columns");
      } else {
        out_.columns_.push_back(*address);
      }
    });
    if (cells_ == 0) fail(0, "no column after `time_ms`");
  }

  void row(std::string_view line) {
    CsvInputs::Row row;
    size_t last = 0;
    cells(line, [&](size_t number, size_t at, std::string_view cell) {
      last = number;
      if (number == 0) return time(row, at, cell);
      if (number > cells_) return fail(at, "more cells than the header has");
      value(row, number, at, cell);
    });
    if (last < cells_) fail(line.size(), "fewer cells than the header has");
    out_.rows_.push_back(std::move(row));
  }

  void time(CsvInputs::Row& row, size_t at, std::string_view cell) {
    if (!parse_time(cell, row.time_ns)) return fail(at, "expected a time in ms: 250 or 250.5");
    const bool back = !out_.rows_.empty() && row.time_ns < out_.rows_.back().time_ns;
    if (back) fail(at, "the time goes back");
  }

  void value(CsvInputs::Row& row, size_t number, size_t at, std::string_view cell) {
    uint64_t value = 0;
    const uint32_t bits = number == lost_column_ ? 1 : out_.columns_[row.cells.size()].bit_size;
    if (!cell.empty() && !parse_cell(cell, bits, value)) {
      return fail(at, "`" + std::string(cell) + "` is no value of " + std::to_string(bits) +
                          (bits == 1 ? " bit" : " bits"));
    }
    if (number == lost_column_) {
      if (!cell.empty()) row.lost = value != 0;
    } else {
      row.cells.push_back(cell.empty() ? std::nullopt : std::optional(value));
    }
  }

  std::string file_;
  std::string_view text_;
  size_t line_ = 0;
  size_t cells_ = 0;  // after time_ms
  size_t lost_column_ = kNone;
  std::string error_;
  CsvInputs out_;
};

base::Result<CsvInputs> CsvInputs::parse(const std::string& file, std::string_view text) {
  return CsvParser(file, text).run();
}

void CsvInputs::advance(int64_t now_ns) {
  for (; next_ < rows_.size() && rows_[next_].time_ns <= now_ns; ++next_) {
    const Row& row = rows_[next_];
    for (size_t i = 0; i < row.cells.size(); ++i) values_[i] = row.cells[i].value_or(values_[i]);
    lost_ = row.lost.value_or(lost_);
  }
}

}  // namespace vm
