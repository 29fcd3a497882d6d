#include "base/pack.h"

#include <algorithm>
#include <vector>

namespace base {
namespace {

constexpr uint32_t kNone = 0xffffffffu;
constexpr uint32_t kShortest = 4;
constexpr uint32_t kLongest = 1 << 16;
constexpr uint32_t kEnough = 256;  // bytes of a copy that nobody looks for a longer one of
constexpr uint32_t kTries = 48;    // older places that are looked at
constexpr uint32_t kHashBits = 16;

struct Copy {
  uint32_t length = 0;  // 0: none
  uint32_t distance = 0;
  int64_t gain = 0;  // bytes
};

class Packer {
 public:
  explicit Packer(ByteSpan bytes)
      : bytes_(bytes), newest_(size_t{1} << kHashBits, kNone), older_(bytes.size(), kNone) {}

  Bytes run() {
    size_t at = 0;
    while (at < bytes_.size()) {
      const Copy copy = best_at(at);
      enter(at);
      if (copy.length == 0 || best_at(at + 1).gain > copy.gain + 1) {
        ++at;
        continue;
      }
      write(at, copy);
      for (size_t i = 1; i < copy.length; ++i) enter(at + i);
      at += copy.length;
      written_ = at;
    }
    if (written_ < at) write(at, {});
    return out_.take();
  }

 private:
  uint32_t hash_at(size_t at) const {
    uint32_t word = 0;
    std::memcpy(&word, bytes_.data() + at, kShortest);
    return word * 2654435761u >> (32 - kHashBits);
  }
  void enter(size_t at) {
    if (at + kShortest > bytes_.size()) return;
    uint32_t& newest = newest_[hash_at(at)];
    older_[at] = newest;
    newest = static_cast<uint32_t>(at);
  }
  Copy best_at(size_t at) const {
    Copy best;
    if (at + kShortest > bytes_.size()) return best;
    uint32_t from = newest_[hash_at(at)];
    for (uint32_t left = kTries; left != 0 && from != kNone && best.length < kEnough; --left) {
      const uint32_t length = same_at(from, at);
      const auto distance = static_cast<uint32_t>(at - from);
      const int64_t gain = int64_t{length} - bytes_of(distance) - 1;
      if (length >= kShortest && gain > best.gain) best = {length, distance, gain};
      from = older_[from];
    }
    return best;
  }
  uint32_t same_at(size_t from, size_t at) const {
    const size_t most = std::min<size_t>(kLongest, bytes_.size() - at);
    uint32_t same = 0;
    while (same < most && bytes_[from + same] == bytes_[at + same]) ++same;
    return same;
  }
  static int64_t bytes_of(uint32_t number) {
    int64_t bytes = 1;
    for (; number >= 0x80; number >>= 7) ++bytes;
    return bytes;
  }

  // What lies before `at` and is not written, then the copy.
  void write(size_t at, const Copy& copy) {
    const auto plain = static_cast<uint32_t>(at - written_);
    const uint32_t code = copy.length == 0 ? 0 : copy.length - (kShortest - 1);
    out_.u8(static_cast<uint8_t>(std::min(plain, kInToken) << 4 | std::min(code, kInToken)));
    if (plain >= kInToken) number(plain - kInToken);
    out_.raw(bytes_.subspan(written_, plain));
    if (code >= kInToken) number(code - kInToken);
    if (code != 0) number(copy.distance);
  }
  void number(uint32_t v) {
    for (; v >= 0x80; v >>= 7) out_.u8(static_cast<uint8_t>(v | 0x80));
    out_.u8(static_cast<uint8_t>(v));
  }

  ByteSpan bytes_;
  std::vector<uint32_t> newest_;  // place by hash
  std::vector<uint32_t> older_;   // the one before, of the same hash
  size_t written_ = 0;            // so many bytes are in `out_`
  ByteWriter out_;
};

}  // namespace

Bytes pack(ByteSpan bytes) { return Packer(bytes).run(); }

}  // namespace base
