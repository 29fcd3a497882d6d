// The archives of messages (base/archive.h). Images and packages have their own, stable formats.
//
// Controllers and tools of different releases talk (protocol.h), so messages only grow: a field
// that comes later stands at the end of its message or row, as `a.added(field)`. An older sender
// does not have it, and it keeps its default; an older reader skips it. A row carries its length
// for that.
#pragma once

#include <string>
#include <vector>

#include "base/archive.h"
#include "base/visible_text.h"
#include "vm/runtime/protocol.h"

namespace vm {

inline constexpr uint32_t kTextBytes = 4;  // of an empty one

class FieldWriter : public base::WriteArchive {
 public:
  template <class T>
  void added(const T& v) {
    (*this)(v);
  }
  // `each(archive, row)` writes the fields of one.
  template <class T, class Each>
  void rows(const std::vector<T>& v, uint32_t, Each&& each) {
    list(v, 0, [&](const T& row) {
      const size_t length_at = out_.size();
      out_.u32(0);
      each(*this, row);
      out_.patch_u32(length_at, static_cast<uint32_t>(out_.size() - length_at - 4));
    });
  }
  void texts(const std::vector<std::string>& v) {
    list(v, 0, [&](const std::string& text) { (*this)(text); });
  }
};

// kVisible: texts are for people, so that whatever they would do to a terminal is shown instead
// (base/visible_text.h); of all answers. kAsSent: of requests.
enum class Texts : uint8_t { kVisible, kAsSent };

class FieldReader : public base::ReadArchive {
 public:
  explicit FieldReader(base::ByteSpan bytes, Texts texts = Texts::kVisible)
      : ReadArchiveOn(bytes), texts_(texts) {}
  using ReadArchiveOn::operator();
  void operator()(std::string& v) {
    const base::ByteSpan bytes = in_.blob();
    if (bytes.size() > kMaxNameBytes) in_.fail();
    v.assign(bytes.begin(), bytes.end());
    if (texts_ == Texts::kVisible) v = base::visible(v);
  }
  template <class T>
  void added(T& v) {
    if (in_.left() != 0) (*this)(v);
  }
  // `min_bytes`: of the fields that every version has.
  template <class T, class Each>
  void rows(std::vector<T>& v, uint32_t min_bytes, Each&& each) {
    constexpr uint32_t kLengthBytes = 4;
    list(v, kLengthBytes + min_bytes, [&](T& row) {
      FieldReader fields(in_.blob(), texts_);
      each(fields, row);
      if (fields.failed()) in_.fail();
    });
  }
  void texts(std::vector<std::string>& v) {
    list(v, kTextBytes, [&](std::string& text) { (*this)(text); });
  }
  // What a newer sender has written after the fields that are known here.
  base::ByteSpan rest() { return in_.raw(in_.left()); }

 private:
  Texts texts_;
};

base::Error not_understood(const char* what);

// `fields(archive, message)` lists them.
template <class T, class Fields>
base::Bytes write_fields(const T& message, Fields&& fields) {
  FieldWriter writer;
  fields(writer, message);
  return writer.take();
}

template <class T, class Fields>
base::Result<T> read_fields(base::ByteSpan bytes, const char* what, Fields&& fields) {
  FieldReader reader(bytes);
  T message;
  fields(reader, message);
  if (reader.failed()) return not_understood(what);
  return message;
}

}  // namespace vm
