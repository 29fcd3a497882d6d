#include "online_change/plan/fate_rows.h"

namespace online_change {

uint32_t FateRows::find(const std::string& key) const {
  auto found = by_key_.find(key);
  return found == by_key_.end() ? kNoRow : found->second;
}

uint32_t FateRows::add(const std::string& key, const FateRow& row) {
  auto number = static_cast<uint32_t>(rows_.size());
  by_key_.emplace(key, number);
  rows_.push_back(row);
  places_.push_back(1);
  return number;
}

std::vector<FateRow> FateRows::take() {
  for (size_t i = 0; i < rows_.size(); ++i) {
    if (places_[i] > 1) {
      rows_[i].reason += "; and " + std::to_string(places_[i] - 1) + std::string(kMoreLikeIt);
    }
  }
  return std::move(rows_);
}

}  // namespace online_change
