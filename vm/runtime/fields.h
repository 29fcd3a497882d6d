// One list of fields for each message serves writing and reading: FieldWriter and FieldReader
// have the same calls. Only for messages; images have their own, stable format.
//
// Controllers and tools of different releases talk (protocol.h), so lists only grow: a field that
// comes later stands at the end of its message or row, as `a.added(field)`. An older sender does
// not have it, and it keeps its default; an older reader skips it. A row carries its length for
// that. What is an enumeration is a `choice()`.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/visible_text.h"
#include "vm/runtime/protocol.h"

namespace vm {

class FieldWriter {
 public:
  void operator()(const std::string& v) { out_.text(v); }
  void operator()(const base::Bytes& v) { out_.blob(v); }
  void operator()(const base::Digest& v) { out_.raw(v); }
  void operator()(bool v) { out_.boolean(v); }
  void operator()(uint8_t v) { out_.u8(v); }
  void operator()(uint32_t v) { out_.u32(v); }
  void operator()(uint64_t v) { out_.u64(v); }
  void operator()(int64_t v) { out_.i64(v); }
  template <class T>
  void added(const T& v) {
    (*this)(v);
  }
  template <class E>
  void choice(const E& v, E) {
    out_.u8(static_cast<uint8_t>(v));
  }
  template <class T>
  void list(const std::vector<T>& rows, uint32_t) {
    out_.u32(static_cast<uint32_t>(rows.size()));
    for (const T& row : rows) {
      const size_t length_at = out_.size();
      out_.u32(0);
      fields(*this, row);
      out_.patch_u32(length_at, static_cast<uint32_t>(out_.size() - length_at - 4));
    }
  }
  void list(const std::vector<std::string>& texts, uint32_t) {
    out_.u32(static_cast<uint32_t>(texts.size()));
    for (const std::string& text : texts) out_.text(text);
  }
  base::Bytes take() { return out_.take(); }

 private:
  base::ByteWriter out_;
};

// kVisible: texts are for people, so that whatever they would do to a terminal is shown instead
// (base/visible_text.h); of all answers. kAsSent: of requests.
enum class Texts : uint8_t { kVisible, kAsSent };

class FieldReader {
 public:
  explicit FieldReader(base::ByteSpan bytes, Texts texts = Texts::kVisible)
      : in_(bytes), texts_(texts) {}
  void operator()(std::string& v) {
    base::ByteSpan bytes = in_.blob();
    if (bytes.size() > kMaxNameBytes) in_.fail();
    v.assign(bytes.begin(), bytes.end());
    if (texts_ == Texts::kVisible) v = base::visible(v);
  }
  void operator()(base::Bytes& v) {
    base::ByteSpan bytes = in_.blob();
    v.assign(bytes.begin(), bytes.end());
  }
  void operator()(base::Digest& v) {
    base::ByteSpan bytes = in_.raw(v.size());
    if (bytes.size() == v.size()) std::memcpy(v.data(), bytes.data(), v.size());
  }
  void operator()(bool& v) { v = in_.boolean(); }
  void operator()(uint8_t& v) { v = in_.u8(); }
  void operator()(uint32_t& v) { v = in_.u32(); }
  void operator()(uint64_t& v) { v = in_.u64(); }
  void operator()(int64_t& v) { v = in_.i64(); }
  template <class T>
  void added(T& v) {
    if (in_.left() != 0) (*this)(v);
  }
  // An enumerator up to `last`.
  template <class E>
  void choice(E& v, E last) {
    const uint8_t number = in_.u8();
    if (number > static_cast<uint8_t>(last)) return in_.fail();
    v = static_cast<E>(number);
  }
  // The fields of every row take at least `least_bytes`, so a hostile count cannot ask for much
  // memory.
  template <class T>
  void list(std::vector<T>& rows, uint32_t least_bytes) {
    const uint32_t count = in_.count(kLengthBytes + least_bytes);
    for (uint32_t i = 0; i < count && !in_.failed(); ++i) {
      FieldReader row(in_.blob(), texts_);
      fields(row, rows.emplace_back());
      if (row.failed()) in_.fail();
    }
  }
  void list(std::vector<std::string>& texts, uint32_t least_bytes) {
    const uint32_t count = in_.count(least_bytes);
    for (uint32_t i = 0; i < count && !in_.failed(); ++i) (*this)(texts.emplace_back());
  }
  bool failed() const { return in_.failed(); }
  // What a newer sender has written after the fields that are known here.
  base::ByteSpan rest() { return in_.raw(in_.left()); }
  void fail() { in_.fail(); }

 private:
  static constexpr uint32_t kLengthBytes = 4;

  base::ByteReader in_;
  Texts texts_;
};

base::Error not_understood(const char* what);

template <class T>
base::Bytes write_fields(const T& message) {
  FieldWriter writer;
  fields(writer, message);
  return writer.take();
}

template <class T>
base::Result<T> read_fields(base::ByteSpan bytes, const char* what) {
  FieldReader reader(bytes);
  T message;
  fields(reader, message);
  if (reader.failed()) return not_understood(what);
  return message;
}

}  // namespace vm
