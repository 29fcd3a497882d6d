#include "base/nearest_name.h"

#include <algorithm>
#include <vector>

#include "base/name_case.h"

namespace base {
namespace {

constexpr size_t kLongestCompared = 64;

// Letters that are other ones, too many, missing or exchanged with the next; given up once there
// are more than `limit`.
uint32_t letters_apart(std::string_view a, std::string_view b, uint32_t limit) {
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

}  // namespace

uint32_t farthest_name(std::string_view written) {
  const size_t compared = std::min(written.size(), kLongestCompared);
  return static_cast<uint32_t>(compared + 2) / 3 + 1;
}

void keep_nearest(std::string_view written, std::string_view compared, std::string_view candidate,
                  std::string& best, uint32_t& distance) {
  written = written.substr(0, kLongestCompared);
  if (compared.size() > written.size() + distance || written.size() > compared.size() + distance) {
    return;
  }
  const uint32_t found = letters_apart(fold_name(written), fold_name(compared), distance);
  if (found > distance || (found == distance && (best.empty() || candidate > best))) return;
  distance = found;
  best = candidate;
}

}  // namespace base
