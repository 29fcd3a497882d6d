// What a controller with keys must not forget (F-03): how far each plan has come, so that nothing
// of it comes twice; which keys are revoked; and how late it was at least, so that a clock that is
// set back brings nothing back to life.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"

namespace online_change {

inline constexpr size_t kMostPlans = 256;         // the newest ones
inline constexpr size_t kMostRevokedKept = 1024;  // of several lists

struct PlanMark {
  std::string plan;
  uint64_t sequence = 0;   // the highest that was taken
  int64_t made_s = 0;      // that one was signed then
  base::Digest content{};  // of that one
};

struct TrustRecord {
  int64_t latest_s = 0;   // UTC, since 1970
  int64_t dropped_s = 0;  // a plan that is not here takes only what was signed after this
  std::vector<PlanMark> plans;
  std::vector<base::Digest> revoked;  // keys; never fewer
  // Marks it as taken. Where there is no room the plan that is oldest goes, and `dropped_s` says
  // that what it has taken does not come again.
  void mark(PlanMark mark);
  PlanMark* find(const std::string& plan);
};

base::Bytes encode(const TrustRecord& record);
// Nullopt for what no controller has written.
std::optional<TrustRecord> decode_trust(base::ByteSpan payload);

}  // namespace online_change
