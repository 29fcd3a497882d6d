// Inputs of a simulated device over time, from CSV:
//   time_ms,%IX0.0,%IW2,lost
//   0,FALSE,100,
//   250,TRUE,,
// A row holds from its time on; an empty cell leaves the value as it was. `lost` TRUE is a device
// that does not answer. Values: 0, -7, 16#FF, TRUE, FALSE. Lines that begin with # are comments.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/types/types.h"

namespace vm {

class CsvInputs {
 public:
  // kDeviceFailed with `file`, line and column.
  static base::Result<CsvInputs> parse(const std::string& file, std::string_view text);

  const std::vector<ir::DirectAddress>& columns() const { return columns_; }
  // Plays on to `now_ns`, which never goes back.
  void advance(int64_t now_ns);
  // The value of a column, as the last rows say; little endian bits.
  uint64_t value(size_t column) const { return values_[column]; }
  bool lost() const { return lost_; }

 private:
  struct Row {
    int64_t time_ns = 0;
    std::vector<std::optional<uint64_t>> cells;
    std::optional<bool> lost;
  };
  friend class CsvParser;

  std::vector<ir::DirectAddress> columns_;
  std::vector<Row> rows_;
  std::vector<uint64_t> values_;
  size_t next_ = 0;
  bool lost_ = false;
};

}  // namespace vm
