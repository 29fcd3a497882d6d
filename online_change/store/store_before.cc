// The version that ran before the last accept (X8), in a file of its own that nothing boots from:
// the digest of the program that followed it, its own digest, its bytes.
#include <algorithm>

#include "online_change/store/store.h"

namespace online_change {
namespace {


}  // namespace

base::Status Store::keep_before(const ImageToStore& image, const base::Digest& next) {
  base::Bytes payload(next.begin(), next.end());
  payload.insert(payload.end(), image.digest.begin(), image.digest.end());
  payload.insert(payload.end(), image.bytes.begin(), image.bytes.end());
  const uint64_t size = record_bytes(payload.size());
  std::lock_guard lock(before_mutex_);
  return replace_record(storage_, kBeforeFile, RecordKind::kImage, 1, payload, size);
}

base::Result<StoredImage> Store::before() const {
  std::lock_guard lock(before_mutex_);
  const base::Result<uint64_t> size = storage_.size(kBeforeFile);
  if (!size.ok() && size.error().refusal == base::Refusal::kFileNotFound) {
    return base::Error{base::Refusal::kNothingToUndo, "no earlier version is stored"};
  }
  Record record = read_record(storage_, kBeforeFile, RecordKind::kImage);
  base::Bytes& payload = record.payload;
  if (record.state != RecordState::kValid || payload.size() < 2 * kDigestBytes) {
    return base::Error{base::Refusal::kStorageFailed,
                       "the earlier version cannot be read, or is damaged"};
  }
  // The record was kept for an accept that a power cut has prevented, or a later one could not be
  // kept.
  const base::Digest boots_now = boots();
  if (!std::equal(boots_now.begin(), boots_now.end(), payload.begin())) {
    return base::Error{base::Refusal::kNothingToUndo,
                       "the stored earlier version is not the one before the program that boots"};
  }
  StoredImage image;
  std::copy_n(payload.begin() + kDigestBytes, kDigestBytes, image.digest.begin());
  image.bytes.assign(payload.begin() + 2 * kDigestBytes, payload.end());
  return image;
}

}  // namespace online_change
