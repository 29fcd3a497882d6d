// STRING and WSTRING as seen by native functions: one template over the code
// unit (uint8_t, uint16_t little endian). A Source is measured once; a Sink
// drops what its capacity cannot hold and ends with a NUL. Code units are moved
// with memcpy, so nothing is assumed about alignment.
#pragma once

#include <algorithm>
#include <cstring>
#include <string_view>

#include "stdlib/native/natives.h"

namespace stdlib {

template <typename Unit>
class Source {
 public:
  explicit Source(const NativeArg& arg) : data_(arg.data) {
    while (length_ < arg.capacity && (*this)[length_] != 0) {
      ++length_;
    }
  }
  uint32_t length() const { return length_; }
  Unit operator[](uint32_t index) const {
    Unit unit;
    std::memcpy(&unit, data_ + size_t{index} * sizeof(Unit), sizeof(Unit));
    return unit;
  }
  const uint8_t* at(uint32_t index) const { return data_ + size_t{index} * sizeof(Unit); }

 private:
  const uint8_t* data_;
  uint32_t length_ = 0;
};

template <typename Unit>
class Sink {
 public:
  explicit Sink(const NativeArg& arg) : data_(arg.data), capacity_(arg.capacity) {}
  ~Sink() { put_at(used_, 0); }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void put(Unit unit) {
    if (used_ < capacity_) {
      put_at(used_++, unit);
    }
  }
  // `source` from character `first` (from 0), `count` characters that it has.
  void put(const Source<Unit>& source, uint32_t first, uint32_t count) {
    const uint32_t fits = std::min(count, capacity_ - used_);
    if (fits != 0) {
      std::memcpy(data_ + size_t{used_} * sizeof(Unit), source.at(first),
                  size_t{fits} * sizeof(Unit));
      used_ += fits;
    }
  }

 private:
  void put_at(uint32_t index, Unit unit) {
    std::memcpy(data_ + size_t{index} * sizeof(Unit), &unit, sizeof(Unit));
  }

  uint8_t* data_;
  uint32_t capacity_;
  uint32_t used_ = 0;
};

// The text of a STRING argument, up to its NUL or its capacity.
inline std::string_view text_of(const NativeArg& arg) {
  return {reinterpret_cast<const char*>(arg.data), Source<uint8_t>(arg).length()};
}

inline void put_text(const NativeArg& destination, std::string_view text) {
  Sink<uint8_t> sink(destination);
  for (const char character : text) {
    sink.put(static_cast<uint8_t>(character));
  }
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
