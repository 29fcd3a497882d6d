// Inside of stdlib/native: one specialisation of native<> per row of natives.def, made by
// STC_NATIVE from a function with parameters of C++ types, which must be those of the row's
// signature. A row without a body does not link.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/limits.h"
#include "stdlib/native/natives.h"

namespace stdlib {

#define STC_NATIVE_PARAMETERS \
  uint8_t *memory, uint64_t a, uint64_t b, uint64_t c, uint64_t d, uint64_t e

template <NativeId id>
uint64_t native(STC_NATIVE_PARAMETERS);
template <NativeId id>
inline constexpr std::string_view kSignature;

#define NATIVE(id, name, signature, meaning)            \
  template <>                                           \
  uint64_t native<NativeId::id>(STC_NATIVE_PARAMETERS); \
  template <>                                           \
  inline constexpr std::string_view kSignature<NativeId::id> = signature;
#include "stdlib/native/natives.def"
#undef NATIVE

// A STRING (uint8_t) or WSTRING (uint16_t, little endian) argument; `data` has room for
// capacity + 1 units.
template <typename Unit>
struct Text {
  uint8_t* data = nullptr;
  uint32_t capacity = 0;
};
using String = Text<uint8_t>;
using Wstring = Text<uint16_t>;

template <class T>
inline constexpr char kLetter = '?';
template <>
inline constexpr char kLetter<void> = 'v';
template <>
inline constexpr char kLetter<bool> = 'b';
template <>
inline constexpr char kLetter<int32_t> = 'i';
template <>
inline constexpr char kLetter<int64_t> = 'I';
template <>
inline constexpr char kLetter<uint64_t> = 'U';
template <>
inline constexpr char kLetter<float> = 'f';
template <>
inline constexpr char kLetter<double> = 'F';
template <>
inline constexpr char kLetter<String> = 'S';
template <>
inline constexpr char kLetter<Wstring> = 'W';

template <class T>
T argument(uint8_t* memory, uint64_t bits) {
  if constexpr (kLetter<T> == 'S' || kLetter<T> == 'W') {
    return {memory + static_cast<uint32_t>(bits),
            std::min(static_cast<uint32_t>(bits >> 32), base::kMaxStringCapacity)};
  } else if constexpr (kLetter<T> == 'b') {
    return (bits & 0xFF) != 0;
  } else if constexpr (kLetter<T> == 'f') {
    return std::bit_cast<float>(static_cast<uint32_t>(bits));
  } else if constexpr (kLetter<T> == 'F') {
    return std::bit_cast<double>(bits);
  } else {
    return static_cast<T>(bits);
  }
}

template <class T>
uint64_t result_bits(T value) {
  if constexpr (kLetter<T> == 'F') {
    return std::bit_cast<uint64_t>(value);
  } else if constexpr (kLetter<T> == 'f') {
    return std::bit_cast<uint32_t>(value);
  } else {
    return static_cast<uint64_t>(value);
  }
}

template <auto function>
struct Adapter;
template <class R, class... P, R (*function)(P...)>
struct Adapter<function> {
  static constexpr bool has(std::string_view signature) {
    constexpr std::array<char, sizeof...(P)> kLetters = {kLetter<P>...};
    return signature[0] == kLetter<R> &&
           signature.substr(2) == std::string_view(kLetters.data(), kLetters.size());
  }
  static uint64_t call(uint8_t* memory, const std::array<uint64_t, kDirectArguments>& direct) {
    if constexpr (sizeof...(P) <= kDirectArguments) {
      return by(memory, direct.data(), std::index_sequence_for<P...>());
    } else {
      std::array<uint64_t, sizeof...(P)> all;
      std::memcpy(all.data(), reinterpret_cast<const uint8_t*>(direct[0]), sizeof all);
      return by(memory, all.data(), std::index_sequence_for<P...>());
    }
  }

 private:
  template <size_t... i>
  static uint64_t by(uint8_t* memory, const uint64_t* all, std::index_sequence<i...>) {
    if constexpr (std::is_void_v<R>) {
      function(argument<P>(memory, all[i])...);
      return 0;
    } else {
      return result_bits<R>(function(argument<P>(memory, all[i])...));
    }
  }
};

#define STC_NATIVE(id, ...)                                             \
  template <>                                                           \
  uint64_t native<NativeId::id>(STC_NATIVE_PARAMETERS) {                \
    static_assert(Adapter<__VA_ARGS__>::has(kSignature<NativeId::id>)); \
    return Adapter<__VA_ARGS__>::call(memory, {a, b, c, d, e});         \
  }

}  // namespace stdlib
