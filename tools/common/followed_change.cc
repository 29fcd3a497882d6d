#include "tools/common/followed_change.h"

#include <algorithm>

#include "base/digest_reader.h"

namespace tools {
namespace {

constexpr uint32_t kEnds = 4;

base::Error not_understood(const char* what) {
  return {base::Refusal::kProtocol,
          std::string("message not understood: ") + what + "; stc and stvm must be of one version"};
}

base::Bytes rest_of(base::ByteReader& in) {
  const base::ByteSpan rest = in.raw(in.left());
  return base::Bytes(rest.begin(), rest.end());
}

}  // namespace

base::Bytes encode(const FollowedChange& change) {
  base::ByteWriter out;
  for (const int64_t time : {change.saved_ns, change.seen_ns, change.built_ns, change.packed_ns}) {
    out.i64(time);
  }
  out.raw(change.base);
  out.raw(change.package);
  return out.take();
}

base::Bytes encode(const FollowedAnswer& answer) {
  base::ByteWriter out;
  out.u8(static_cast<uint8_t>(answer.end));
  out.raw(answer.image);
  return out.take();
}

base::Result<FollowedChange> decode_followed_change(base::ByteSpan bytes) {
  base::ByteReader in(bytes);
  FollowedChange change;
  for (int64_t* time : {&change.saved_ns, &change.seen_ns, &change.built_ns, &change.packed_ns}) {
    *time = in.i64();
  }
  change.base = base::read_digest(in);
  if (in.failed()) return not_understood("change");
  change.package = rest_of(in);
  return change;
}

base::Result<FollowedAnswer> decode_followed_answer(base::ByteSpan bytes) {
  base::ByteReader in(bytes);
  FollowedAnswer answer;
  answer.end = in.enumerator<FollowedEnd>(kEnds);
  if (in.failed()) return not_understood("answer");
  answer.image = rest_of(in);
  return answer;
}

}  // namespace tools
