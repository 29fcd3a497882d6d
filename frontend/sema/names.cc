#include "frontend/sema/names.h"

#include <algorithm>

#include "base/name_case.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr size_t kLongestCompared = 64;

// Letters that are other ones, too many, missing or exchanged with the next; given up once there
// are more than `limit`.
uint32_t distance(std::string_view a, std::string_view b, uint32_t limit) {
  std::vector<uint32_t> row(b.size() + 1);
  for (uint32_t j = 0; j < row.size(); ++j) row[j] = j;
  std::vector<uint32_t> before = row;  // the two rows in front of it
  std::vector<uint32_t> earlier = row;
  for (uint32_t i = 1; i <= a.size(); ++i) {
    earlier.swap(before);
    before.swap(row);
    uint32_t smallest = row[0] = i;
    for (uint32_t j = 1; j < row.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({before[j - 1] + (same ? 0 : 1), before[j] + 1, row[j - 1] + 1});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], earlier[j - 2] + 1);
      smallest = std::min(smallest, row[j]);
    }
    if (smallest > limit) return limit + 1;
  }
  return row.back();
}

// "Pump" of "A.B.Pump".
std::string_view last_name(std::string_view name) { return name.substr(name.rfind('.') + 1); }

}  // namespace

size_t FoldHash::operator()(std::string_view name) const {
  const uint64_t hash = base::name_hash(name);
  return static_cast<size_t>(hash ^ (hash >> 32));
}

bool FoldEqual::operator()(std::string_view a, std::string_view b) const noexcept {
  return base::same_name(a, b);
}

NearestName::NearestName(std::string_view written)
    : written_(ir::fold_name(written.substr(0, kLongestCompared))),
      plain_(written.find('.') == std::string_view::npos),
      best_distance_(static_cast<uint32_t>(last_name(written_).size() + 2) / 3 + 1) {}

void NearestName::offer(std::string_view candidate) {
  const std::string_view compared = plain_ ? last_name(candidate) : candidate;
  if (compared.size() > written_.size() + best_distance_ ||
      written_.size() > compared.size() + best_distance_) {
    return;
  }
  uint32_t found = distance(written_, ir::fold_name(compared), best_distance_);
  if (found > best_distance_ || (found == best_distance_ && (best_.empty() || candidate > best_))) {
    return;
  }
  best_distance_ = found;
  best_ = candidate;
}

Fix NearestName::fix() const {
  if (best_.empty()) return {};
  Fix fix("did you mean `" + best_ + "`?");
  fix.name = best_;
  return fix;
}

}  // namespace frontend
