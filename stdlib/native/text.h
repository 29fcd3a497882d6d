// STRING and WSTRING as seen by native functions: one template over the code
// unit (uint8_t, uint16_t little endian). A Source is measured once; a Sink
// drops what its capacity cannot hold and ends with a NUL.
#pragma once

#include <algorithm>
#include <string_view>

#include "stdlib/native/implementation.h"
#include "stdlib/native/units.h"

namespace stdlib {

template <typename Unit>
class Source {
 public:
  explicit Source(Text<Unit> text)
      : data_(text.data), length_(length_of<Unit>(text.data, text.capacity)) {}
  uint32_t length() const { return length_; }
  Unit operator[](uint32_t index) const { return load<Unit>(at(index)); }
  const uint8_t* at(uint32_t index) const { return data_ + size_t{index} * sizeof(Unit); }

 private:
  const uint8_t* data_;
  uint32_t length_;
};

template <typename Unit>
class Sink {
 public:
  explicit Sink(Text<Unit> text) : data_(text.data), capacity_(text.capacity) {}
  ~Sink() { store(at(used_), Unit{0}); }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void put(Unit unit) {
    if (used_ < capacity_) {
      store(at(used_++), unit);
    }
  }
  // `source` from character `first` (from 0), `count` characters that it has.
  void put(const Source<Unit>& source, uint32_t first, uint32_t count) {
    put(source.at(first), count);
  }
  void put(const uint8_t* units, uint32_t count) {
    const uint32_t fits = std::min(count, capacity_ - used_);
    copy_bytes(at(used_), units, size_t{fits} * sizeof(Unit));
    used_ += fits;
  }

 private:
  uint8_t* at(uint32_t index) { return data_ + size_t{index} * sizeof(Unit); }

  uint8_t* data_;
  uint32_t capacity_;
  uint32_t used_ = 0;
};

// The text of a STRING argument, up to its NUL or its capacity.
inline std::string_view text_of(String text) {
  return {reinterpret_cast<const char*>(text.data), length_of<uint8_t>(text.data, text.capacity)};
}

[[gnu::noinline]] inline void put_text(String destination, std::string_view text) {
  Sink<uint8_t>(destination)
      .put(reinterpret_cast<const uint8_t*>(text.data()), static_cast<uint32_t>(text.size()));
}

inline std::string_view without_leading_spaces(std::string_view text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

inline std::string_view trimmed(std::string_view text) {
  text = without_leading_spaces(text);
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

}  // namespace stdlib
