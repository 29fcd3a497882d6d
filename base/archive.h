// One list of fields for both directions: a function template takes an archive and a value, and
// WriteArchive or ReadArchive does the rest, with bounds and enumerators checked in one place.
// Packages, messages and images (ir/bytecode/image_archive.h) are written and read by these.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/ids.h"

namespace base {

// `Out`: a ByteWriter, or what has its functions.
template <class Out>
class WriteArchiveOn {
 public:
  template <class... Args>
  explicit WriteArchiveOn(Args&&... args) : out_(std::forward<Args>(args)...) {}
  void operator()(const bool& v) { out_.boolean(v); }
  void operator()(const uint8_t& v) { out_.u8(v); }
  void operator()(const uint16_t& v) { out_.u16(v); }
  void operator()(const uint32_t& v) { out_.u32(v); }
  void operator()(const uint64_t& v) { out_.u64(v); }
  void operator()(const int64_t& v) { out_.i64(v); }
  void operator()(const std::string& v) { out_.text(v); }
  void operator()(const Bytes& v) { out_.blob(v); }
  void operator()(const Digest& v) { out_.raw(v); }
  template <class Tag>
  void operator()(const Id<Tag>& v) {
    out_.u32(v.index);
  }
  template <class E>
  void enumerator(const E& v, E) {
    out_.u8(static_cast<uint8_t>(v));
  }
  template <class E>
  void enumerator(const E& v, uint32_t) {
    out_.u8(static_cast<uint8_t>(v));
  }
  // `min_bytes`: of the smallest element.
  template <class T, class Each>
  void list(const std::vector<T>& v, size_t, Each&& each) {
    out_.u32(static_cast<uint32_t>(v.size()));
    for (const T& item : v) each(item);
  }
  Bytes take() { return out_.take(); }

 protected:
  Out out_;
};
using WriteArchive = WriteArchiveOn<ByteWriter>;

// `In`: a ByteReader, or a reference to one.
template <class In>
class ReadArchiveOn {
 public:
  explicit ReadArchiveOn(ByteSpan bytes) : in_(bytes) {}
  explicit ReadArchiveOn(ByteReader& in) : in_(in) {}
  void operator()(bool& v) { v = in_.boolean(); }
  void operator()(uint8_t& v) { v = in_.u8(); }
  void operator()(uint16_t& v) { v = in_.u16(); }
  void operator()(uint32_t& v) { v = in_.u32(); }
  void operator()(uint64_t& v) { v = in_.u64(); }
  void operator()(int64_t& v) { v = in_.i64(); }
  void operator()(std::string& v) {
    const ByteSpan bytes = in_.blob();
    if (!bytes.empty()) v.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void operator()(Bytes& v) {
    const ByteSpan bytes = in_.blob();
    v.assign(bytes.begin(), bytes.end());
  }
  void operator()(Digest& v) {
    const ByteSpan bytes = in_.raw(v.size());
    std::copy(bytes.begin(), bytes.end(), v.begin());
  }
  template <class Tag>
  void operator()(Id<Tag>& v) {
    v = Id<Tag>(in_.u32());
  }
  // Up to `last`, or one of the first `count`; everything else is damage.
  template <class E>
  void enumerator(E& v, E last) {
    enumerator(v, static_cast<uint32_t>(last) + 1);
  }
  template <class E>
  void enumerator(E& v, uint32_t count) {
    v = in_.template enumerator<E>(count);
  }
  // Every element takes at least `min_bytes`, so a hostile count asks for no memory.
  template <class T, class Each>
  void list(std::vector<T>& v, size_t min_bytes, Each&& each) {
    const uint32_t count = in_.count(min_bytes);
    for (uint32_t i = 0; i < count && !in_.failed(); ++i) each(v.emplace_back());
  }
  bool done() const { return in_.done(); }
  bool failed() const { return in_.failed(); }
  void fail() { in_.fail(); }

 protected:
  In in_;
};
using ReadArchive = ReadArchiveOn<ByteReader>;

}  // namespace base
