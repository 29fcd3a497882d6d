#include "base/name_case.h"

#include <algorithm>
#include <cstring>
#include <optional>

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

// Eight bytes at a time, the missing ones of the last piece being 0.
constexpr size_t kPiece = 8;
constexpr uint64_t kEach = 0x0101010101010101u;

template <class T>
uint64_t read(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// The last piece: fewer than eight bytes, by two readings that overlap, without a loop.
inline uint64_t rest_at(const char* begin, size_t size) {
  if (size >= 4) return read<uint32_t>(begin) | read<uint32_t>(begin + size - 4) << 8 * (size - 4);
  if (size >= 2) return read<uint16_t>(begin) | read<uint16_t>(begin + size - 2) << 8 * (size - 2);
  return static_cast<uint8_t>(*begin);
}

inline uint64_t piece_at(std::string_view name, size_t at) {
  const size_t size = name.size() - at;
  const char* begin = name.data() + at;
  return size >= kPiece ? read<uint64_t>(begin) : rest_at(begin, size);
}

bool is_ascii(uint64_t piece) { return (piece & 0x80 * kEach) == 0; }

// fold_ascii() of each byte; bytes above 0x7F stay.
uint64_t fold_piece(uint64_t piece) {
  const uint64_t low = piece & 0x7f * kEach;
  const uint64_t from_a = low + (0x80 - 'A') * kEach;
  const uint64_t behind_z = low + (0x7f - 'Z') * kEach;
  const uint64_t capital = (from_a ^ behind_z) & ~piece & 0x80 * kEach;
  return piece | capital >> 2;
}

// A hash of the bytes as they are, but for capitals below 0x80; `all` gathers the bits of all
// bytes.
uint64_t hash_pieces(std::string_view name, uint64_t& all) {
  uint64_t hash = 0xcbf29ce484222325u;
  const auto mix = [&](uint64_t piece) {
    all |= piece;
    hash = (hash ^ fold_piece(piece)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  };
  const char* at = name.data();
  size_t left = name.size();
  for (; left >= kPiece; left -= kPiece, at += kPiece) mix(read<uint64_t>(at));
  if (left != 0) mix(rest_at(at, left));
  return hash;
}

}  // namespace

bool same_letters(std::string_view a, std::string_view b) {
  bool plain = true;
  for (size_t at = 0; at < a.size() && plain; at += kPiece) {
    const uint64_t left = piece_at(a, at);
    const uint64_t right = piece_at(b, at);
    plain = is_ascii(left | right);
    if (plain && fold_piece(left) != fold_piece(right)) return false;
  }
  if (plain) return true;
  Folded left(a);
  Folded right(b);
  while (left.more()) {
    if (left.next() != right.next()) return false;
  }
  return true;
}

void fold_name(std::string_view name, char* out) {
  char* to = out;
  for (size_t at = 0; at < name.size(); at += kPiece) {
    const uint64_t piece = piece_at(name, at);
    if (!is_ascii(piece)) {
      to = out;
      for (Folded bytes(name); bytes.more();) *to++ = static_cast<char>(bytes.next());
      return;
    }
    const uint64_t folded = fold_piece(piece);
    const size_t size = std::min(kPiece, name.size() - at);
    std::memcpy(to, &folded, size);
    to += size;
  }
}

std::string fold_name(std::string_view name) {
  std::string folded(name.size(), '\0');
  fold_name(name, folded.data());
  return folded;
}

uint64_t name_hash(std::string_view name) {
  uint64_t all = 0;
  const uint64_t hash = hash_pieces(name, all);
  return is_ascii(all) ? hash : hash_pieces(fold_name(name), all);
}

}  // namespace base
