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
uint64_t length(NativeArg* args) {
  return Source<Unit>(args[0]).length();
}

template <typename Unit>
uint64_t left(NativeArg* args) {
  const Source<Unit> text(args[1]);
  Sink<Unit>(args[0]).put(text, 0, clamp_count(int_of(args[2]), text.length()));
  return 0;
}

template <typename Unit>
uint64_t right(NativeArg* args) {
  const Source<Unit> text(args[1]);
  const uint32_t count = clamp_count(int_of(args[2]), text.length());
  Sink<Unit>(args[0]).put(text, text.length() - count, count);
  return 0;
}

template <typename Unit>
uint64_t mid(NativeArg* args) {
  const Source<Unit> text(args[1]);
  const uint32_t first = characters_before(int_of(args[3]), text.length());
  Sink<Unit>(args[0]).put(text, first, clamp_count(int_of(args[2]), text.length() - first));
  return 0;
}

template <typename Unit>
uint64_t concat(NativeArg* args) {
  const Source<Unit> first(args[1]);
  const Source<Unit> second(args[2]);
  Sink<Unit> sink(args[0]);
  sink.put(first, 0, first.length());
  sink.put(second, 0, second.length());
  return 0;
}

// `text` with the characters [from, to) replaced by `middle`.
template <typename Unit>
void splice(const NativeArg& destination, const Source<Unit>& text, uint32_t from, uint32_t to,
            const Source<Unit>& middle) {
  Sink<Unit> sink(destination);
  sink.put(text, 0, from);
  sink.put(middle, 0, middle.length());
  sink.put(text, to, text.length() - to);
}

template <typename Unit>
uint64_t insert(NativeArg* args) {
  const Source<Unit> text(args[1]);
  const uint32_t at = clamp_count(int_of(args[3]), text.length());
  splice(args[0], text, at, at, Source<Unit>(args[2]));
  return 0;
}

template <typename Unit>
uint64_t erase(NativeArg* args) {
  const Source<Unit> text(args[1]);
  const uint32_t from = characters_before(int_of(args[3]), text.length());
  const uint32_t count = clamp_count(int_of(args[2]), text.length() - from);
  splice(args[0], text, from, from + count, Source<Unit>(NativeArg{}));
  return 0;
}

template <typename Unit>
uint64_t replace(NativeArg* args) {
  const Source<Unit> text(args[1]);
  const uint32_t from = characters_before(int_of(args[4]), text.length());
  const uint32_t count = clamp_count(int_of(args[3]), text.length() - from);
  splice(args[0], text, from, from + count, Source<Unit>(args[2]));
  return 0;
}

template <typename Unit>
bool occurs_at(const Source<Unit>& text, uint32_t first, const Source<Unit>& wanted) {
  return std::memcmp(text.at(first), wanted.at(0), size_t{wanted.length()} * sizeof(Unit)) == 0;
}

// An empty text is found nowhere.
template <typename Unit>
uint64_t find(NativeArg* args) {
  const Source<Unit> text(args[0]);
  const Source<Unit> wanted(args[1]);
  if (wanted.length() == 0 || wanted.length() > text.length()) {
    return 0;
  }
  for (uint32_t first = 0; first <= text.length() - wanted.length(); ++first) {
    if (occurs_at(text, first, wanted)) {
      return uint64_t{first} + 1;
    }
  }
  return 0;
}

template <typename Unit>
uint64_t character(NativeArg* args) {
  const Source<Unit> text(args[0]);
  const int64_t at = int_of(args[1]);
  return at >= 0 && at < text.length() ? text[static_cast<uint32_t>(at)] : 0;
}

// Of the units behind the end nothing is known, so those up to the new one get defined here.
template <typename Unit>
uint64_t set_character(NativeArg* args) {
  const Source<Unit> text(args[0]);
  const int64_t at = int_of(args[1]);
  const Unit unit = static_cast<Unit>(args[2].bits);
  if (at < 0 || at >= args[0].capacity) {
    return 0;
  }
  const auto put = [&](uint32_t index, Unit value) {
    std::memcpy(args[0].data + size_t{index} * sizeof(Unit), &value, sizeof(Unit));
  };
  const uint32_t index = static_cast<uint32_t>(at);
  const uint32_t length = text.length();
  if (index < length) {
    put(index, unit);
  } else if (unit != 0) {
    for (uint32_t i = length; i < index; ++i) {
      put(i, Unit{' '});
    }
    put(index, unit);
    put(index + 1, Unit{0});
  }
  return 0;
}

template <typename Number>
uint64_t order(Number a, Number b) {
  return bits_of(int64_t{a > b} - int64_t{a < b});
}

template <typename Unit>
uint64_t compare(NativeArg* args) {
  const Source<Unit> first(args[0]);
  const Source<Unit> second(args[1]);
  const uint32_t common = std::min(first.length(), second.length());
  for (uint32_t i = 0; i < common; ++i) {
    if (first[i] != second[i]) {
      return order(first[i], second[i]);
    }
  }
  return order(first.length(), second.length());
}

}  // namespace

#define BOTH_KINDS(id, function)                       \
  template <>                                          \
  uint64_t native<NativeId::id##S>(NativeArg * args) { \
    return function<uint8_t>(args);                    \
  }                                                    \
  template <>                                          \
  uint64_t native<NativeId::id##W>(NativeArg * args) { \
    return function<uint16_t>(args);                   \
  }

BOTH_KINDS(kLen, length)
BOTH_KINDS(kLeft, left)
BOTH_KINDS(kRight, right)
BOTH_KINDS(kMid, mid)
BOTH_KINDS(kConcat, concat)
BOTH_KINDS(kInsert, insert)
BOTH_KINDS(kDelete, erase)
BOTH_KINDS(kReplace, replace)
BOTH_KINDS(kFind, find)
BOTH_KINDS(kCompare, compare)
BOTH_KINDS(kCharacter, character)
BOTH_KINDS(kSetCharacter, set_character)

#undef BOTH_KINDS

template <>
uint64_t native<NativeId::kStringToWstring>(NativeArg* args) {
  const Source<uint8_t> text(args[1]);
  Sink<uint16_t> sink(args[0]);
  for (uint32_t i = 0; i < text.length(); ++i) {
    sink.put(text[i]);
  }
  return 0;
}

template <>
uint64_t native<NativeId::kWstringToString>(NativeArg* args) {
  const Source<uint16_t> text(args[1]);
  Sink<uint8_t> sink(args[0]);
  for (uint32_t i = 0; i < text.length(); ++i) {
    sink.put(text[i] <= 0xFF ? static_cast<uint8_t>(text[i]) : uint8_t{'?'});
  }
  return 0;
}

}  // namespace stdlib
