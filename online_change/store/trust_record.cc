// The stored form, in a record (record.h): u32 version, the time, the plans, the revoked keys.
#include "online_change/store/trust_record.h"

#include <algorithm>

#include "base/digest_reader.h"
#include "online_change/package/signed_file.h"
#include "online_change/store/store.h"

namespace online_change {
namespace {

constexpr uint32_t kTrustVersion = 1;

}  // namespace

PlanMark* TrustRecord::find(const std::string& plan) {
  const auto found = std::ranges::find(plans, plan, &PlanMark::plan);
  return found == plans.end() ? nullptr : &*found;
}

void TrustRecord::mark(PlanMark mark) {
  if (PlanMark* const known = find(mark.plan)) {
    *known = std::move(mark);
    return;
  }
  if (plans.size() >= kMostPlans) {
    const auto oldest = std::ranges::min_element(plans, {}, &PlanMark::made_s);
    dropped_s = std::max(dropped_s, oldest->made_s);
    plans.erase(oldest);
  }
  plans.push_back(std::move(mark));
}

base::Bytes encode(const TrustRecord& record) {
  base::ByteWriter out;
  out.u32(kTrustVersion);
  out.i64(record.latest_s);
  out.i64(record.dropped_s);
  out.u32(static_cast<uint32_t>(record.plans.size()));
  for (const PlanMark& mark : record.plans) {
    out.text(mark.plan);
    out.u64(mark.sequence);
    out.i64(mark.made_s);
    out.raw(mark.content);
  }
  out.u32(static_cast<uint32_t>(record.revoked.size()));
  for (const base::Digest& key : record.revoked) out.raw(key);
  return out.take();
}

std::optional<TrustRecord> decode_trust(base::ByteSpan payload) {
  base::ByteReader in(payload);
  if (in.u32() != kTrustVersion) return std::nullopt;
  TrustRecord out;
  out.latest_s = in.i64();
  out.dropped_s = in.i64();
  const uint32_t plans = in.count(sizeof(base::Digest) + 20);
  if (plans > kMostPlans) return std::nullopt;
  for (uint32_t left = plans; left != 0; --left) {
    PlanMark mark;
    mark.plan = in.text();
    mark.sequence = in.u64();
    mark.made_s = in.i64();
    mark.content = base::read_digest(in);
    if (!is_signed_name(mark.plan)) return std::nullopt;
    out.plans.push_back(std::move(mark));
  }
  const uint32_t revoked = in.count(sizeof(base::Digest));
  if (revoked > kMostRevokedKept) return std::nullopt;
  for (uint32_t left = revoked; left != 0; --left) out.revoked.push_back(base::read_digest(in));
  if (!in.done()) return std::nullopt;
  return out;
}

base::Status Store::keep_trust(const TrustRecord& record) {
  const base::Bytes payload = encode(record);
  std::lock_guard lock(before_mutex_);
  return replace_record(storage_, kTrustFile, RecordKind::kTrust, 1, payload,
                        record_bytes(payload.size()));
}

base::Result<TrustRecord> Store::trust() const {
  std::lock_guard lock(before_mutex_);
  const Record record = read_record(storage_, kTrustFile, RecordKind::kTrust);
  if (record.state == RecordState::kEmpty) return TrustRecord{};
  std::optional<TrustRecord> out;
  if (record.state == RecordState::kValid) out = decode_trust(record.payload);
  if (out) return std::move(*out);
  return failed(
      "the file `trust` of the state folder is damaged: nobody knows what was taken "
      "before, so nothing signed is taken. Remove that file once old signed files have "
      "expired");
}

}  // namespace online_change
