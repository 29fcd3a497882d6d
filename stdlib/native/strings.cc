// Character string functions (IEC 61131-3 table 34). Positions count from 1;
// one template serves STRING and WSTRING.
#include "stdlib/native/implementation.h"
#include "stdlib/native/text.h"

namespace stdlib {
namespace {

// A number of characters, between nothing and all of them.
uint32_t clamp_count(int64_t wanted, uint32_t available) {
  return static_cast<uint32_t>(std::clamp<int64_t>(wanted, 0, available));
}

// Characters before position `position`, which is taken into 1 .. length + 1.
uint32_t characters_before(int64_t position, uint32_t length) {
  return static_cast<uint32_t>(std::clamp<int64_t>(position, 1, int64_t{length} + 1) - 1);
}

template <typename Unit>
int32_t length(Text<Unit> text) {
  return static_cast<int32_t>(Source(text).length());
}

template <typename Unit>
void left(Text<Unit> to, Text<Unit> from, int64_t count) {
  const Source text(from);
  Sink(to).put(text, 0, clamp_count(count, text.length()));
}

template <typename Unit>
void right(Text<Unit> to, Text<Unit> from, int64_t wanted) {
  const Source text(from);
  const uint32_t count = clamp_count(wanted, text.length());
  Sink(to).put(text, text.length() - count, count);
}

template <typename Unit>
void mid(Text<Unit> to, Text<Unit> from, int64_t count, int64_t position) {
  const Source text(from);
  const uint32_t first = characters_before(position, text.length());
  Sink(to).put(text, first, clamp_count(count, text.length() - first));
}

template <typename Unit>
void concat(Text<Unit> to, Text<Unit> a, Text<Unit> b) {
  const Source first(a);
  const Source second(b);
  Sink sink(to);
  sink.put(first, 0, first.length());
  sink.put(second, 0, second.length());
}

template <typename Unit>
void concat3(Text<Unit> to, Text<Unit> a, Text<Unit> b, Text<Unit> c) {
  const Source first(a);
  const Source second(b);
  const Source third(c);
  Sink sink(to);
  sink.put(first, 0, first.length());
  sink.put(second, 0, second.length());
  sink.put(third, 0, third.length());
}

// `text` with the characters [from, to) replaced by `middle`.
template <typename Unit>
void splice(Text<Unit> destination, const Source<Unit>& text, uint32_t from, uint32_t to,
            const Source<Unit>& middle) {
  Sink sink(destination);
  sink.put(text, 0, from);
  sink.put(middle, 0, middle.length());
  sink.put(text, to, text.length() - to);
}

template <typename Unit>
void insert(Text<Unit> destination, Text<Unit> into, Text<Unit> what, int64_t position) {
  const Source text(into);
  const uint32_t at = clamp_count(position, text.length());
  splice(destination, text, at, at, Source(what));
}

template <typename Unit>
void erase(Text<Unit> destination, Text<Unit> of, int64_t wanted, int64_t position) {
  const Source text(of);
  const uint32_t from = characters_before(position, text.length());
  const uint32_t count = clamp_count(wanted, text.length() - from);
  Sink sink(destination);
  sink.put(text, 0, from);
  sink.put(text, from + count, text.length() - from - count);
}

template <typename Unit>
void replace(Text<Unit> destination, Text<Unit> of, Text<Unit> by, int64_t wanted,
             int64_t position) {
  const Source text(of);
  const uint32_t from = characters_before(position, text.length());
  const uint32_t count = clamp_count(wanted, text.length() - from);
  splice(destination, text, from, from + count, Source(by));
}

// The first of `count` units that is `unit`, from `first` on; `count` when there is none.
template <typename Unit>
uint32_t next_unit(const Source<Unit>& text, uint32_t first, uint32_t count, Unit unit) {
  if constexpr (sizeof(Unit) == 1) {
    const void* const found = std::memchr(text.at(first), unit, count - first);
    if (found == nullptr) return count;
    return static_cast<uint32_t>(static_cast<const uint8_t*>(found) - text.at(0));
  }
  while (first < count && text[first] != unit) ++first;
  return first;
}

// An empty text is found nowhere.
template <typename Unit>
int32_t find(Text<Unit> in, Text<Unit> what) {
  const Source text(in);
  const Source wanted(what);
  if (wanted.length() == 0 || wanted.length() > text.length()) {
    return 0;
  }
  const uint32_t places = text.length() - wanted.length() + 1;
  const size_t bytes = size_t{wanted.length()} * sizeof(Unit);
  for (uint32_t first = 0;; ++first) {
    first = next_unit(text, first, places, wanted[0]);
    if (first == places) return 0;
    if (std::memcmp(text.at(first), wanted.at(0), bytes) == 0) {
      return static_cast<int32_t>(first) + 1;
    }
  }
}

// Nobody looks after the position.
template <typename Unit>
uint64_t character(Text<Unit> of, int64_t at) {
  if (at < 0 || at >= of.capacity) return 0;
  const auto index = static_cast<uint32_t>(at);
  const bool is_inside = length_of<Unit>(of.data, index + 1) > index;
  return is_inside ? load<Unit>(of.data + size_t{index} * sizeof(Unit)) : 0;
}

// Nothing is known of the units after the end nothing is known, so those up to the new one get
// defined here.
template <typename Unit>
void set_character(Text<Unit> of, int64_t at, uint64_t code) {
  const Unit unit = static_cast<Unit>(code);
  if (at < 0 || at >= of.capacity) {
    return;
  }
  const auto put = [&](uint32_t index, Unit value) {
    store(of.data + size_t{index} * sizeof(Unit), value);
  };
  const uint32_t index = static_cast<uint32_t>(at);
  const uint32_t length = length_of<Unit>(of.data, index + 1);
  if (index < length) {
    put(index, unit);
  } else if (unit != 0) {
    for (uint32_t i = length; i < index; ++i) {
      put(i, Unit{' '});
    }
    put(index, unit);
    put(index + 1, Unit{0});
  }
}

template <typename Unit>
int32_t compare(Text<Unit> a, Text<Unit> b) {
  return compare_texts<Unit>(a.data, a.capacity, b.data, b.capacity);
}

void string_to_wstring(Wstring to, String from) {
  const Source text(from);
  Sink sink(to);
  for (uint32_t i = 0; i < text.length(); ++i) {
    sink.put(text[i]);
  }
}

void wstring_to_string(String to, Wstring from) {
  const Source text(from);
  Sink sink(to);
  for (uint32_t i = 0; i < text.length(); ++i) {
    sink.put(text[i] <= 0xFF ? static_cast<uint8_t>(text[i]) : uint8_t{'?'});
  }
}

}  // namespace

#define BOTH_KINDS(id, function)       \
  STC_NATIVE(id##S, function<uint8_t>) \
  STC_NATIVE(id##W, function<uint16_t>)

BOTH_KINDS(kLen, length)
BOTH_KINDS(kLeft, left)
BOTH_KINDS(kRight, right)
BOTH_KINDS(kMid, mid)
BOTH_KINDS(kConcat, concat)
BOTH_KINDS(kConcat3, concat3)
BOTH_KINDS(kInsert, insert)
BOTH_KINDS(kDelete, erase)
BOTH_KINDS(kReplace, replace)
BOTH_KINDS(kFind, find)
BOTH_KINDS(kCompare, compare)
BOTH_KINDS(kCharacter, character)
BOTH_KINDS(kSetCharacter, set_character)

#undef BOTH_KINDS

STC_NATIVE(kStringToWstring, string_to_wstring)
STC_NATIVE(kWstringToString, wstring_to_string)

}  // namespace stdlib
