// The two archives of images (image_fields.h): one writes fields, the other reads them.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/archive.h"
#include "base/visible_text.h"
#include "ir/bytecode/image.h"

namespace ir {

// As base::ByteWriter; the fields of a large image are many, so they are gathered first.
class GatheringWriter {
 public:
  // `expected` bytes, or some more: what is not written takes no memory.
  explicit GatheringWriter(size_t expected) { bytes_.reserve(expected); }
  GatheringWriter(const GatheringWriter&) = delete;
  GatheringWriter& operator=(const GatheringWriter&) = delete;

  void u8(uint8_t v) { fixed(v); }
  void u16(uint16_t v) { fixed(v); }
  void u32(uint32_t v) { fixed(v); }
  void u64(uint64_t v) { fixed(v); }
  void i64(int64_t v) { fixed(v); }
  void boolean(bool v) { u8(v ? 1 : 0); }
  void raw(base::ByteSpan v) {
    if (v.size() > sizeof gathered_ - used_) flush();
    if (v.size() > sizeof gathered_) {
      bytes_.insert(bytes_.end(), v.begin(), v.end());
    } else if (!v.empty()) {
      std::memcpy(gathered_ + used_, v.data(), v.size());
      used_ += v.size();
    }
  }
  void blob(base::ByteSpan v) {
    u32(static_cast<uint32_t>(v.size()));
    raw(v);
  }
  void text(std::string_view v) { blob(base::as_bytes(v)); }
  size_t size() const { return bytes_.size() + used_; }
  void patch_u32(size_t at, uint32_t v) {
    flush();
    std::memcpy(bytes_.data() + at, &v, sizeof v);
  }
  base::Bytes take() {
    flush();
    return std::move(bytes_);
  }

 private:
  template <class T>
  [[gnu::always_inline]] void fixed(T v) {
    if (sizeof v > sizeof gathered_ - used_) flush();
    std::memcpy(gathered_ + used_, &v, sizeof v);
    used_ += sizeof v;
  }
  void flush() {
    bytes_.insert(bytes_.end(), gathered_, gathered_ + used_);
    used_ = 0;
  }

  base::Bytes bytes_;
  uint8_t gathered_[4096];
  size_t used_ = 0;  // of these
};

class ImageWriter : public base::WriteArchiveOn<GatheringWriter> {
 public:
  using WriteArchiveOn::list;
  explicit ImageWriter(size_t expected) : WriteArchiveOn(expected) {}
  void text_bytes(const std::string& v) { (*this)(v); }  // of a STRING: any bytes
  // Two in one byte, the second in its upper half: where that is the first enumerator, the byte is
  // what it was before the format had it.
  template <class L, class U>
  void enumerators(const L& lower, uint32_t, const U& upper, uint32_t) {
    out_.u8(static_cast<uint8_t>(static_cast<uint8_t>(lower) | static_cast<uint8_t>(upper) << 4));
  }
  // At the end of a section: the first enumerator takes no byte, so a section that has it is what
  // it was before the format had this field.
  template <class E>
  void last_enumerator(const E& v, uint32_t) {
    if (v != E{}) out_.u8(static_cast<uint8_t>(v));
  }
  // Likewise: no bytes for no records.
  template <class T, class Each>
  void last_list(const std::vector<T>& v, size_t min_size, Each&& each) {
    if (!v.empty()) list(v, min_size, each);
  }
  template <class T, class Each>
  void last_list(const base::SharedVector<T>& v, size_t min_size, Each&& each) {
    last_list(v.all(), min_size, each);
  }
  template <class T, class Each>
  void list(const base::SharedVector<T>& v, size_t min_size, Each&& each) {
    list(v.all(), min_size, each);
  }
  // Records that are stored as they lie in memory.
  template <class T>
  void plain_list(const std::vector<T>& v) {
    static_assert(std::has_unique_object_representations_v<T>);
    out_.u32(static_cast<uint32_t>(v.size()));
    raw({reinterpret_cast<const uint8_t*>(v.data()), v.size() * sizeof(T)});
  }
  template <class T>
  void plain_list(const base::SharedVector<T>& v) {
    plain_list(v.all());
  }
  // `bytes`: of the same value in another version.
  template <class V>
  bool shares(const V& v, const V& known, base::ByteSpan bytes) {
    if (!v.is_one_with(known)) return false;
    raw(bytes);
    return true;
  }

  void raw(base::ByteSpan v) { out_.raw(v); }
  size_t size() const { return out_.size(); }
  // The same, from the beginning of the section.
  size_t at() const { return size() - section_; }
  void begin_section() { section_ = size(); }
  // What was written before.
  void patch_u32(size_t at, uint32_t v) { out_.patch_u32(at, v); }

 private:
  size_t section_ = 0;  // where it began
};

class ImageReader : public base::ReadArchiveOn<base::ByteReader&> {
  template <class T>
  struct Stored {  // at any address
    uint8_t bytes[sizeof(T)];
    operator T() const {  // NOLINT: that is what it is
      T v;
      std::memcpy(&v, bytes, sizeof v);
      return v;
    }
  };

 public:
  // `content`: all that `in` reads.
  ImageReader(base::ByteReader& in, base::ByteSpan content)
      : ReadArchiveOn(in), content_(content) {}
  using ReadArchiveOn::operator();
  // A name, or a text for people. With control characters it is damage: what shows it to somebody
  // need not ask who made the image.
  void operator()(std::string& v) {
    ReadArchiveOn::operator()(v);
    if (base::has_control(v)) in_.fail();
  }
  void text_bytes(std::string& v) { ReadArchiveOn::operator()(v); }
  template <class L, class U>
  void enumerators(L& lower, uint32_t lower_limit, U& upper, uint32_t upper_limit) {
    const uint8_t both = in_.u8();
    if ((both & 15u) >= lower_limit || both >> 4 >= upper_limit) return in_.fail();
    lower = static_cast<L>(both & 15u);
    upper = static_cast<U>(both >> 4);
  }
  template <class E>
  void last_enumerator(E& v, uint32_t limit) {
    if (in_.left() == 0) return;
    enumerator(v, limit);
    if (v == E{}) in_.fail();  // one image has one stored form
  }
  template <class T, class Each>
  void last_list(std::vector<T>& v, size_t min_size, Each each) {
    if (in_.left() == 0) return;
    list(v, min_size, each);
    if (v.empty()) in_.fail();  // one image has one stored form
  }
  template <class T, class Each>
  void last_list(base::SharedVector<T>& v, size_t min_size, Each each) {
    std::vector<T> all;
    last_list(all, min_size, each);
    v = std::move(all);
  }
  // An image has most records of all that is read: room for them is made at once.
  template <class T, class Each>
  void list(std::vector<T>& v, size_t min_size, Each each) {
    v.resize(in_.count(min_size));
    for (T& item : v) {
      if (in_.failed()) return;
      each(item);
    }
  }
  template <class T, class Each>
  void list(base::SharedVector<T>& v, size_t min_size, Each each) {
    std::vector<T> all;
    list(all, min_size, each);
    v = std::move(all);
  }
  template <class T>
  void plain_list(std::vector<T>& v) {
    const auto count = in_.count(sizeof(T));
    const base::ByteSpan bytes = in_.raw(size_t{count} * sizeof(T));
    const auto* const first = reinterpret_cast<const Stored<T>*>(bytes.data());
    if (!bytes.empty()) v.assign(first, first + count);  // not made empty first, as by resize()
  }
  template <class T>
  void plain_list(base::SharedVector<T>& v) {
    std::vector<T> all;
    plain_list(all);
    v = std::move(all);
  }
  // `bytes`: of `known` in another version. The same bytes are the same value.
  template <class V>
  bool shares(V& v, const V& known, base::ByteSpan bytes) {
    if (!takes(bytes)) return false;
    v = known;
    return true;
  }
  // After bytes that are these; else where it was.
  bool takes(base::ByteSpan bytes) {
    if (in_.left() < bytes.size()) return false;
    if (!std::equal(bytes.begin(), bytes.end(), content_.begin() + in_.at())) return false;
    in_.raw(bytes.size());
    return true;
  }
  size_t at() const { return in_.at(); }
  // A list that goes into `table`, one after the other.
  template <class Table, class Each>
  void each(size_t min_size, Table& table, Each each) {
    uint32_t left = in_.count(min_size);
    for (table.reserve(table.size() + left); left != 0 && !in_.failed(); --left) each();
  }

 private:
  base::ByteSpan content_;
};

}  // namespace ir
