#include "base/name_case.h"

namespace base {
namespace {

constexpr bool between(uint32_t code, uint32_t first, uint32_t last) {
  return code >= first && code <= last;
}

// Capitals of blocks in which capital and small letter alternate, the capital being even.
constexpr bool is_even_capital(uint32_t code) {
  return code % 2 == 0 && (between(code, 0x100, 0x12e) || between(code, 0x132, 0x136) ||
                           between(code, 0x14a, 0x176) || between(code, 0x460, 0x480) ||
                           between(code, 0x48a, 0x4be) || between(code, 0x4d0, 0x52e));
}
constexpr bool is_odd_capital(uint32_t code) {
  return code % 2 == 1 && (between(code, 0x139, 0x147) || between(code, 0x179, 0x17d) ||
                           between(code, 0x4c1, 0x4cd));
}

constexpr uint32_t fold_code(uint32_t code) {
  if (between(code, 0xc0, 0xde) && code != 0xd7) return code + 0x20;
  if (is_even_capital(code) || is_odd_capital(code)) return code + 1;
  if (code == 0x178) return 0xff;
  if (code == 0x386) return 0x3ac;
  if (between(code, 0x388, 0x38a)) return code + 0x25;
  if (code == 0x38c) return 0x3cc;
  if (between(code, 0x38e, 0x38f)) return code + 0x3f;
  if (between(code, 0x391, 0x3ab) && code != 0x3a2) return code + 0x20;
  if (code == 0x3c2) return 0x3c3;  // final sigma
  if (between(code, 0x400, 0x40f)) return code + 0x50;
  if (between(code, 0x410, 0x42f)) return code + 0x20;
  return code;
}

constexpr uint8_t fold_ascii(uint8_t byte) {
  return byte >= 'A' && byte <= 'Z' ? static_cast<uint8_t>(byte + 0x20) : byte;
}

// The folded bytes of a name, one after the other.
class Folded {
 public:
  explicit Folded(std::string_view name) : name_(name) {}
  bool more() const { return at_ < name_.size(); }
  uint8_t next() {
    const auto byte = static_cast<uint8_t>(name_[at_++]);
    if (byte < 0x80) return fold_ascii(byte);
    if (trail_ != 0) {
      const uint8_t trail = trail_;
      trail_ = 0;
      return trail;
    }
    if (byte < 0xc3 || byte > 0xd4 || !more()) return byte;
    const auto second = static_cast<uint8_t>(name_[at_]);
    if ((second & 0xc0) != 0x80) return byte;
    const uint32_t code = fold_code((byte & 0x1fu) << 6 | (second & 0x3fu));
    trail_ = static_cast<uint8_t>(0x80 | (code & 0x3f));
    return static_cast<uint8_t>(0xc0 | code >> 6);
  }

 private:
  std::string_view name_;
  size_t at_ = 0;
  uint8_t trail_ = 0;  // folded second byte of the letter whose first one was given
};

}  // namespace

bool same_name(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  Folded left(a);
  Folded right(b);
  while (left.more()) {
    if (left.next() != right.next()) return false;
  }
  return true;
}

std::string fold_name(std::string_view name) {
  std::string folded;
  folded.reserve(name.size());
  for (Folded bytes(name); bytes.more();) folded.push_back(static_cast<char>(bytes.next()));
  return folded;
}

uint64_t name_hash(std::string_view name) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (Folded bytes(name); bytes.more();) hash = (hash ^ bytes.next()) * 0x100000001b3u;
  return hash;
}

}  // namespace base
