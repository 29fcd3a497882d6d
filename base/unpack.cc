#include "base/pack.h"

namespace base {
namespace {

constexpr uint32_t kShorterThanAny = 3;

uint64_t number_of(ByteReader& in) {
  uint64_t number = 0;
  for (uint32_t shift = 0; shift < 35; shift += 7) {
    const uint8_t byte = in.u8();
    number |= uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) return number;
  }
  in.fail();
  return 0;
}

uint64_t count_of(ByteReader& in, uint32_t in_token) {
  return in_token < kInToken ? in_token : kInToken + number_of(in);
}

// All pieces: plain(bytes), copy(length, distance). How many bytes they make.
template <class Plain, class Copy>
std::optional<uint64_t> walk(ByteSpan packed, uint64_t limit, Plain plain, Copy copy) {
  ByteReader in(packed);
  uint64_t made = 0;
  while (in.left() != 0) {
    const uint8_t token = in.u8();
    const ByteSpan bytes = in.raw(count_of(in, token >> 4));
    const uint64_t code = count_of(in, token & kInToken);
    const uint64_t length = code == 0 ? 0 : code + kShorterThanAny;
    const uint64_t distance = code == 0 ? 0 : number_of(in);
    if (in.failed() || bytes.size() + length == 0) return std::nullopt;
    made += bytes.size();
    if (made + length > limit || distance > made || (code != 0 && distance == 0)) {
      return std::nullopt;
    }
    plain(bytes);
    if (length != 0) copy(length, distance);
    made += length;
  }
  if (in.failed()) return std::nullopt;
  return made;
}

}  // namespace

std::optional<uint64_t> unpacked_size(ByteSpan packed, uint64_t limit) {
  return walk(packed, limit, [](ByteSpan) {}, [](uint64_t, uint64_t) {});
}

std::optional<Bytes> unpack(ByteSpan packed, uint64_t limit) {
  const std::optional<uint64_t> size = unpacked_size(packed, limit);
  if (!size) return std::nullopt;
  Bytes out;
  out.reserve(*size);
  walk(
      packed, limit, [&](ByteSpan bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); },
      [&](uint64_t length, uint64_t distance) {
        for (size_t from = out.size() - distance; length != 0; --length) out.push_back(out[from++]);
      });
  return out;
}

}  // namespace base
