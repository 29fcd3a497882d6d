// u32 length of the whole; then pieces until there is as much: u32 place in the other bytes, u32
// bytes from there, u32 bytes of its own, those.
#include "online_change/package/delta.h"

#include <algorithm>
#include <cstring>

namespace online_change {
namespace {

constexpr size_t kAlike = 16;         // so many equal bytes are worth a piece
constexpr size_t kKey = 32;           // that is looked for elsewhere
constexpr size_t kExchanged = 64;     // bytes that may have others in their place
constexpr size_t kStep = 64;          // between places that are looked for elsewhere
constexpr size_t kOwn = 4096;         // own bytes between two such places, at most
constexpr size_t kShift = 8192;       // as far as something may have moved
constexpr size_t kMostSearches = 64;  // in vain; after that only what is in its place is found

bool alike(base::ByteSpan a, size_t i, base::ByteSpan b, size_t j) {
  return i + kAlike <= a.size() && j + kAlike <= b.size() &&
         std::memcmp(a.data() + i, b.data() + j, kAlike) == 0;
}

size_t equal_bytes(base::ByteSpan a, base::ByteSpan b) {
  const size_t most = std::min(a.size(), b.size());
  size_t n = 0;
  for (uint64_t x = 0, y = 0; n + sizeof x <= most; n += sizeof x) {
    std::memcpy(&x, a.data() + n, sizeof x);
    std::memcpy(&y, b.data() + n, sizeof y);
    if (x != y) break;
  }
  while (n < most && a[n] == b[n]) ++n;
  return n;
}

class Maker {
 public:
  Maker(base::ByteSpan from, base::ByteSpan to) : from_(from), to_(to) {}

  base::Bytes run() {
    out_.u32(static_cast<uint32_t>(to_.size()));
    while (at_ < to_.size()) {
      const size_t begin = at_;
      const size_t place = std::min(in_, from_.size());
      const size_t same = equal_bytes(from_.subspan(place), to_.subspan(at_));
      at_ += same;
      in_ = place + same;
      const size_t own = at_;
      while (at_ < to_.size() && !alike(from_, in_, to_, at_)) go_on();
      out_.u32(static_cast<uint32_t>(place));
      out_.u32(static_cast<uint32_t>(own - begin));
      out_.u32(static_cast<uint32_t>(at_ - own));
      out_.raw(to_.subspan(own, at_ - own));
    }
    return out_.take();
  }

 private:
  // After bytes that have no equals here.
  void go_on() {
    for (size_t n = 1; n <= kExchanged; ++n) {
      if (alike(from_, in_ + n, to_, at_ + n)) return skip(n, n);
    }
    if (searches_ < kMostSearches && find_moved()) return;
    ++searches_;
    skip(std::min(kOwn, to_.size() - at_), kOwn);
  }

  // What follows in a while is somewhere near: after this place, or else a little before it.
  bool find_moved() {
    const size_t here = std::min(in_, from_.size());
    const base::ByteSpan behind = from_.subspan(here, std::min(kShift, from_.size() - here));
    const size_t back = here - std::min(here, kShift);
    const base::ByteSpan before = from_.subspan(back, here - back);
    for (size_t own = 0; own < kOwn && at_ + own + kKey <= to_.size(); own += kStep) {
      const base::ByteSpan key = to_.subspan(at_ + own, kKey);
      for (const base::ByteSpan near : {behind, before}) {
        if (near.size() < kKey) continue;
        const void* found = ::memmem(near.data(), near.size(), key.data(), key.size());
        if (found == nullptr) continue;
        in_ = static_cast<size_t>(static_cast<const uint8_t*>(found) - from_.data());
        at_ += own;
        return true;
      }
    }
    return false;
  }

  void skip(size_t own, size_t there) {
    at_ += own;
    in_ = std::min(in_ + there, from_.size());
  }

  base::ByteSpan from_;
  base::ByteSpan to_;
  base::ByteWriter out_;
  size_t at_ = 0;  // in to_
  size_t in_ = 0;  // in from_
  size_t searches_ = 0;
};

}  // namespace

base::Bytes make_delta(base::ByteSpan from, base::ByteSpan to) { return Maker(from, to).run(); }

std::optional<base::Bytes> apply_delta(base::ByteSpan from, base::ByteSpan delta, size_t limit,
                                       base::Bytes out) {
  base::ByteReader in(delta);
  const size_t size = in.u32();
  if (size > limit) return std::nullopt;
  const size_t end = out.size() + size;
  out.reserve(end);
  while (!in.failed() && out.size() < end) {
    const size_t place = in.u32();
    const size_t length = in.u32();
    const base::ByteSpan own = in.blob();
    const bool inside = place <= from.size() && length <= from.size() - place;
    if (in.failed() || !inside || length + own.size() > end - out.size()) return std::nullopt;
    if (length + own.size() == 0) return std::nullopt;
    out.insert(out.end(), from.begin() + place, from.begin() + place + length);
    out.insert(out.end(), own.begin(), own.end());
  }
  if (!in.done()) return std::nullopt;
  return out;
}

}  // namespace online_change
