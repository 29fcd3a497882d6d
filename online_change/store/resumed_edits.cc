#include "online_change/store/resumed_edits.h"

#include "online_change/package/package.h"
#include "online_change/store/retained_values.h"

namespace online_change {

std::optional<std::vector<ResumedEdit>> follow_edits(const std::vector<StoredEdit>& edits,
                                                     const ir::VerifiedImage& first,
                                                     ir::VerifiedImage& last) {
  std::vector<ResumedEdit> out;
  ir::VerifiedImage image = first;
  for (const StoredEdit& edit : edits) {
    const base::Result<uint64_t> retained = retained_bytes(image.image());
    if (!retained.ok() || *retained != edit.retained.size()) return std::nullopt;
    base::Result<Package> package = decode(edit.package, image.encoded());
    if (!package.ok()) return std::nullopt;
    base::Result<ir::VerifiedImage> next = ir::verify(std::move(package->image));
    if (!next.ok() || next->digest() != edit.to) return std::nullopt;
    out.push_back({edit, image});
    image = *next;
  }
  last = image;
  return out;
}

base::Bytes encode_trial(const std::vector<ResumedEdit>& edits) {
  if (edits.empty()) return {};
  std::vector<StoredEdit> stored;
  for (const ResumedEdit& edit : edits) stored.push_back(edit.stored);
  base::ByteWriter out;
  out.blob(edits.front().before.encoded());
  out.blob(encode(stored));
  return out.take();
}

std::optional<std::vector<ResumedEdit>> decode_trial(base::ByteSpan bytes,
                                                     const base::Digest& last) {
  base::ByteReader in(bytes);
  const base::ByteSpan image = in.blob();
  const std::optional<std::vector<StoredEdit>> edits = decode_edits(in.blob());
  if (!in.done() || !edits) return std::nullopt;
  base::Result<ir::VerifiedImage> first = ir::verify(base::Bytes(image.begin(), image.end()));
  if (!first.ok()) return std::nullopt;
  ir::VerifiedImage made = *first;
  auto out = follow_edits(*edits, *first, made);
  if (!out || made.digest() != last) return std::nullopt;
  return out;
}

}  // namespace online_change
