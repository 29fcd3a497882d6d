// Little-endian byte writer, and the one bounded reader through which every
// file, image, package and message is decoded (architecture.md invariant 8).
// A reader never reads past its end: the first bad read latches `failed()`,
// later reads return zero, and the caller checks once per record.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace base {

using Bytes = std::vector<uint8_t>;
using ByteSpan = std::span<const uint8_t>;

class ByteWriter {
 public:
  void u8(uint8_t v) { bytes_.push_back(v); }
  void u16(uint16_t v) { fixed(v); }
  void u32(uint32_t v) { fixed(v); }
  void u64(uint64_t v) { fixed(v); }
  void i64(int64_t v) { fixed(static_cast<uint64_t>(v)); }
  void boolean(bool v) { u8(v ? 1 : 0); }
  void raw(ByteSpan v) { bytes_.insert(bytes_.end(), v.begin(), v.end()); }
  void blob(ByteSpan v) {  // u32 length, bytes
    u32(static_cast<uint32_t>(v.size()));
    raw(v);
  }
  void text(std::string_view v) {
    u32(static_cast<uint32_t>(v.size()));
    bytes_.insert(bytes_.end(), v.begin(), v.end());
  }
  // Overwrites a u32 written earlier, for lengths known only afterwards.
  void patch_u32(size_t at, uint32_t v) { std::memcpy(bytes_.data() + at, &v, sizeof v); }
  size_t size() const { return bytes_.size(); }
  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  template <class T>
  void fixed(T v) {
    uint8_t raw_bytes[sizeof v];
    std::memcpy(raw_bytes, &v, sizeof v);
    bytes_.insert(bytes_.end(), raw_bytes, raw_bytes + sizeof v);
  }
  Bytes bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(ByteSpan bytes) : bytes_(bytes) {}

  uint8_t u8() { return fixed<uint8_t>(); }
  uint16_t u16() { return fixed<uint16_t>(); }
  uint32_t u32() { return fixed<uint32_t>(); }
  uint64_t u64() { return fixed<uint64_t>(); }
  int64_t i64() { return static_cast<int64_t>(fixed<uint64_t>()); }
  bool boolean() {
    uint8_t v = u8();
    if (v > 1) fail();
    return v == 1;
  }
  ByteSpan raw(size_t n) {
    if (n > left()) {
      fail();
      return {};
    }
    ByteSpan out = bytes_.subspan(at_, n);
    at_ += n;
    return out;
  }
  ByteSpan blob() { return raw(u32()); }
  std::string text() {
    ByteSpan b = blob();
    return std::string(b.begin(), b.end());
  }
  // A count of records that each take at least `min_size` bytes; a count that
  // cannot fit in what is left fails, so no hostile count allocates memory.
  uint32_t count(size_t min_size) {
    uint32_t n = u32();
    if (failed_ || (min_size != 0 && n > left() / min_size)) {
      fail();
      return 0;
    }
    return n;
  }
  // An enumerator below `limit`.
  template <class E>
  E enumerator(uint32_t limit) {
    uint8_t v = u8();
    if (v >= limit) {
      fail();
      return E{};
    }
    return static_cast<E>(v);
  }
  void fail() { failed_ = true; }
  bool failed() const { return failed_; }
  size_t left() const { return failed_ ? 0 : bytes_.size() - at_; }
  size_t at() const { return at_; }
  bool done() const { return !failed_ && at_ == bytes_.size(); }

 private:
  template <class T>
  T fixed() {
    T v{};
    if (sizeof v > left()) {
      fail();
      return T{};
    }
    std::memcpy(&v, bytes_.data() + at_, sizeof v);
    at_ += sizeof v;
    return v;
  }
  ByteSpan bytes_;
  size_t at_ = 0;
  bool failed_ = false;
};

inline ByteSpan as_bytes(std::string_view s) {
  return {reinterpret_cast<const uint8_t*>(s.data()), s.size()};
}

}  // namespace base
