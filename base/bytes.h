// Little-endian byte writer, and the one bounded reader through which every
// file, image, package and message is decoded (docs/REQUIREMENTS.md, I8).
// A reader never reads past its end: the first bad read latches `failed()`,
// later reads return zero, and the caller checks once per record.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace base {

using Bytes = std::vector<uint8_t>;
using ByteSpan = std::span<const uint8_t>;

class ByteWriter {
 public:
  void u8(uint8_t v) { fixed(v); }
  void u16(uint16_t v) { fixed(v); }
  void u32(uint32_t v) { fixed(v); }
  void u64(uint64_t v) { fixed(v); }
  void i64(int64_t v) { fixed(static_cast<uint64_t>(v)); }
  void boolean(bool v) { u8(v ? 1 : 0); }
  void raw(ByteSpan v) {
    if (!v.empty()) std::memcpy(extend(v.size()), v.data(), v.size());
  }
  void blob(ByteSpan v) {  // u32 length, bytes
    u32(static_cast<uint32_t>(v.size()));
    raw(v);
  }
  void text(std::string_view v) {
    u32(static_cast<uint32_t>(v.size()));
    if (!v.empty()) std::memcpy(extend(v.size()), v.data(), v.size());
  }
  // `count` bytes more, for the caller to fill at once.
  uint8_t* extend(size_t count) {
    if (count > bytes_.size() - size_) grow(count);
    uint8_t* const at = bytes_.data() + size_;
    size_ += count;
    return at;
  }
  // Overwrites a u32 written earlier, for lengths known only afterwards.
  void patch_u32(size_t at, uint32_t v) { std::memcpy(bytes_.data() + at, &v, sizeof v); }
  size_t size() const { return size_; }
  ByteSpan bytes() const { return {bytes_.data(), size_}; }
  Bytes take() {
    bytes_.resize(size_);
    size_ = 0;
    return std::exchange(bytes_, {});
  }

 private:
  template <class T>
  void fixed(T v) {
    std::memcpy(extend(sizeof v), &v, sizeof v);
  }
  void grow(size_t count) {
    constexpr size_t kFirst = 64;
    bytes_.resize(std::max({kFirst, size_ + count, bytes_.size() + bytes_.size() / 2}));
  }

  Bytes bytes_;      // what was written, and room after it
  size_t size_ = 0;  // written
};

class ByteReader {
 public:
  explicit ByteReader(ByteSpan bytes)
      : begin_(bytes.data()), at_(begin_), end_(begin_ + bytes.size()) {}

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
    const ByteSpan out(at_, n);
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
  void fail() {
    failed_ = true;
    end_ = at_;  // nothing is left
  }
  bool failed() const { return failed_; }
  size_t left() const { return static_cast<size_t>(end_ - at_); }
  size_t at() const { return static_cast<size_t>(at_ - begin_); }
  bool done() const { return !failed_ && at_ == end_; }

 private:
  template <class T>
  T fixed() {
    T v{};
    if (sizeof v > left()) {
      fail();
      return T{};
    }
    std::memcpy(&v, at_, sizeof v);
    at_ += sizeof v;
    return v;
  }
  const uint8_t* begin_;
  const uint8_t* at_;
  const uint8_t* end_;
  bool failed_ = false;
};

inline ByteSpan as_bytes(std::string_view s) {
  return {reinterpret_cast<const uint8_t*>(s.data()), s.size()};
}

}  // namespace base
