#include "base/hash.h"

#include <algorithm>
#include <bit>

#include "base/sha256.h"

namespace base {
namespace {

// Whole blocks at once; bytes of a block that is not whole are kept.
class Sha256 {
 public:
  Sha256() = default;
  // After `length` bytes, which are whole blocks.
  Sha256(const Sha256State& state, uint64_t length) : state_(state), length_(length) {}

  const Sha256State& state() const { return state_; }

  void add(ByteSpan bytes) {
    length_ += bytes.size();
    if (rest_ != 0) bytes = fill(bytes);
    const size_t whole = bytes.size() / 64 * 64;
    sha256_blocks(state_, bytes.data(), whole / 64);
    keep(bytes.subspan(whole));
  }

  Digest finish() {
    tail_[rest_] = 0x80;
    std::memset(tail_ + rest_ + 1, 0, sizeof tail_ - rest_ - 1);
    const size_t size = rest_ < 56 ? 64 : 128;
    const uint64_t bits = length_ * 8;
    for (int i = 0; i < 8; ++i) tail_[size - 1 - i] = static_cast<uint8_t>(bits >> (8 * i));
    sha256_blocks(state_, tail_, size / 64);
    Digest out;
    for (int i = 0; i < 32; ++i) out[i] = static_cast<uint8_t>(state_[i / 4] >> (24 - i % 4 * 8));
    return out;
  }

 private:
  // A block that was begun; the bytes after it.
  ByteSpan fill(ByteSpan bytes) {
    const size_t more = std::min(64 - rest_, bytes.size());
    keep(bytes.first(more));
    if (rest_ == 64) sha256_blocks(state_, tail_, 1);
    rest_ %= 64;
    return bytes.subspan(more);
  }

  void keep(ByteSpan bytes) {
    if (!bytes.empty()) std::memcpy(tail_ + rest_, bytes.data(), bytes.size());
    rest_ += bytes.size();
  }

  Sha256State state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  uint8_t tail_[128];
  size_t rest_ = 0;  // of the tail
  uint64_t length_ = 0;
};

}  // namespace

Digest sha256(ByteSpan bytes) { return sha256(bytes, {}); }

Digest sha256(ByteSpan first, ByteSpan second) {
  Sha256 sum;
  sum.add(first);
  sum.add(second);
  return sum.finish();
}

Digest sha256(ByteSpan bytes, const Sha256Trail& known, size_t same, Sha256Trail& trail) {
  constexpr size_t kStep = Sha256Trail::kStep;
  const size_t known_steps = std::min(std::min(same, bytes.size()) / kStep, known.states.size());
  trail.states.assign(known.states.begin(), known.states.begin() + known_steps);
  Sha256 sum;
  if (known_steps != 0) sum = Sha256(trail.states.back(), known_steps * kStep);
  for (bytes = bytes.subspan(known_steps * kStep); bytes.size() >= kStep;
       bytes = bytes.subspan(kStep)) {
    sum.add(bytes.first(kStep));
    trail.states.push_back(sum.state());
  }
  sum.add(bytes);
  return sum.finish();
}

std::string to_hex(const Digest& digest) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (uint8_t byte : digest) {
    out += kHex[byte >> 4];
    out += kHex[byte & 15];
  }
  return out;
}

std::string short_hex(const Digest& digest) { return to_hex(digest).substr(0, 12); }

bool digest_from_hex(std::string_view hex, Digest& out) {
  auto nibble = [](char c) -> int {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  if (hex.size() != 64) return false;
  for (size_t i = 0; i < 32; ++i) {
    int high = nibble(hex[i * 2]);
    int low = nibble(hex[i * 2 + 1]);
    if (high < 0 || low < 0) return false;
    out[i] = static_cast<uint8_t>(high << 4 | low);
  }
  return true;
}

uint64_t hash64(ByteSpan bytes, uint64_t seed) {
  uint64_t h = seed ^ 0x9e3779b97f4a7c15ull ^ (bytes.size() * 0xff51afd7ed558ccdull);
  size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + at, 8);
    h = std::rotl(h ^ word * 0xc4ceb9fe1a85ec53ull, 29) * 0x9fb21c651e98df25ull;
  }
  uint64_t last = 0;
  if (at < bytes.size()) std::memcpy(&last, bytes.data() + at, bytes.size() - at);
  h = (h ^ last) * 0xff51afd7ed558ccdull;
  return h ^ (h >> 32);
}

}  // namespace base
