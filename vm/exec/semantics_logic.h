// Moves, boolean logic, bit strings, selection.
#pragma once

#include <bit>

#include "vm/exec/step.h"

namespace vm {

#define MOVE(suffix, T) STC_UNARY(MOV_##suffix, T, T, b)
STC_VALUES(MOVE)
// An addr or string reference is moved whole.
STC_UNARY(MOV_A, uint32_t, uint32_t, b)
STC_UNARY(MOV_S, uint64_t, uint64_t, b)
STC_UNARY(MOV_W, uint64_t, uint64_t, b)

STC_INLINE uint32_t bit(Bool value) { return static_cast<uint32_t>(value); }
STC_BINARY(AND_B, Bool, Bool, uint8_t, bit(b) & bit(c))
STC_BINARY(OR_B, Bool, Bool, uint8_t, bit(b) | bit(c))
STC_BINARY(XOR_B, Bool, Bool, uint8_t, bit(b) ^ bit(c))
STC_BINARY(ANDN_B, Bool, Bool, uint8_t, bit(b) & (bit(c) ^ 1))
STC_BINARY(ORN_B, Bool, Bool, uint8_t, bit(b) | (bit(c) ^ 1))
STC_UNARY(NOT_B, Bool, uint8_t, bit(b) ^ 1)

#define BITS(suffix, T)                                                                       \
  STC_BINARY(AND_##suffix, T, T, T, b& c)                                                     \
  STC_BINARY(OR_##suffix, T, T, T, b | c)                                                     \
  STC_BINARY(XOR_##suffix, T, T, T, b ^ c)                                                    \
  STC_UNARY(NOT_##suffix, T, T, ~b)                                                           \
  STC_BINARY(SHL_##suffix, T, uint32_t, T, c < suffix ? Wide<T>(b) << (c & (suffix - 1)) : 0) \
  STC_BINARY(SHR_##suffix, T, uint32_t, T, c < suffix ? b >> (c & (suffix - 1)) : 0)          \
  STC_BINARY(ROL_##suffix, T, uint32_t, T, std::rotl(b, static_cast<int>(c & (suffix - 1))))  \
  STC_BINARY(ROR_##suffix, T, uint32_t, T, std::rotr(b, static_cast<int>(c & (suffix - 1))))
STC_WORDS(BITS)

template <class T>
struct ConditionalMove : Stepwise<T> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, T& result) {
    const T kept = o.template a<T>();
    const T taken = o.template c<T>();
    result = o.template b<uint8_t>() != 0 ? taken : kept;
    m.pc += 1;
    return Flow::kOn;
  }
};
#define CONDITIONAL_MOVE(suffix, T) \
  template <>                       \
  struct Semantics<ir::Opcode::CMOV_##suffix> : ConditionalMove<T> {};
STC_VALUES(CONDITIONAL_MOVE)

}  // namespace vm
