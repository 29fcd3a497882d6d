// One list of fields for each message serves writing and reading: FieldWriter and FieldReader
// have the same calls. Only for messages; images have their own, stable format.
#pragma once

#include <string>
#include <type_traits>
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
  void list(const std::vector<T>& rows, uint32_t) {
    out_.u32(static_cast<uint32_t>(rows.size()));
    for (const T& row : rows) fields(*this, row);
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
  // Every row takes at least `least_bytes`, so a hostile count cannot ask for much memory.
  template <class T>
  void list(std::vector<T>& rows, uint32_t least_bytes) {
    uint32_t count = in_.count(least_bytes);
    for (uint32_t i = 0; i < count && !in_.failed(); ++i) fields(*this, rows.emplace_back());
  }
  bool done() const { return in_.done(); }
  void fail() { in_.fail(); }

 private:
  base::ByteReader in_;
  Texts texts_;
};

inline void fields(FieldWriter& a, const std::string& v) { a(v); }
inline void fields(FieldReader& a, std::string& v) { a(v); }

base::Error not_understood(const char* what);

template <class T>
base::Bytes write_fields(const T& message) {
  FieldWriter writer;
  fields(writer, message);
  return writer.take();
}

// The whole of `bytes` must be one message.
template <class T>
base::Result<T> read_fields(base::ByteSpan bytes, const char* what) {
  FieldReader reader(bytes);
  T message;
  fields(reader, message);
  if (!reader.done()) return not_understood(what);
  return message;
}

}  // namespace vm
