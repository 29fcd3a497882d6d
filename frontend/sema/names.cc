#include "frontend/sema/names.h"

#include "base/name_case.h"
#include "base/nearest_name.h"

namespace frontend {

std::string_view last_name(std::string_view name) { return name.substr(name.rfind('.') + 1); }

size_t FoldHash::operator()(std::string_view name) const {
  const uint64_t hash = base::name_hash(name);
  return static_cast<size_t>(hash ^ (hash >> 32));
}

bool FoldEqual::operator()(std::string_view a, std::string_view b) const noexcept {
  return base::same_name(a, b);
}

NearestName::NearestName(std::string_view written)
    : written_(written),
      plain_(written.find('.') == std::string_view::npos),
      best_distance_(base::farthest_name(last_name(written))) {}

void NearestName::offer(std::string_view candidate) {
  const std::string_view compared = plain_ ? last_name(candidate) : candidate;
  base::keep_nearest(written_, compared, candidate, best_, best_distance_);
}

Fix NearestName::fix() const {
  if (best_.empty()) return {};
  Fix fix("did you mean `" + best_ + "`?");
  fix.name = best_;
  return fix;
}

}  // namespace frontend
