// Collects fate rows so that what many instances or elements have in common is
// one row with a count.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "online_change/diff/fates.h"

namespace online_change {

class FateRows {
 public:
  // Rows with equal keys are one; the first gives path and text. Returns its number. The key must
  // be new.
  uint32_t add(const std::string& key, const FateRow& row);
  // One more variable or instance with the same fate; or more of the same one.
  void repeat(uint32_t row, uint64_t count) {
    rows_[row].count += count;
    ++places_[row];
  }
  void add_count(uint32_t row, uint64_t count) { rows_[row].count += count; }
  uint32_t find(const std::string& key) const;  // kNoRow when there is none
  std::vector<FateRow> take();

  static constexpr uint32_t kNoRow = 0xffffffffu;

 private:
  std::map<std::string, uint32_t> by_key_;
  std::vector<FateRow> rows_;
  std::vector<uint64_t> places_;  // how many variables or instances share the row
};

}  // namespace online_change
