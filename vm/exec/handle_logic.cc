// Moves, boolean logic, bit strings, selection.
#include <bit>

#include "vm/exec/handle.h"

namespace vm {

#define MOVE(suffix, T) STC_UNARY(MOV_##suffix, T, T, b)
STC_VALUES(MOVE)
// An addr or string reference is moved whole.
STC_UNARY(MOV_A, uint32_t, uint32_t, b)
STC_UNARY(MOV_S, uint64_t, uint64_t, b)
STC_UNARY(MOV_W, uint64_t, uint64_t, b)

STC_BINARY(AND_B, uint8_t, uint8_t, uint8_t, b& c)
STC_BINARY(OR_B, uint8_t, uint8_t, uint8_t, b | c)
STC_BINARY(XOR_B, uint8_t, uint8_t, uint8_t, b ^ c)
STC_BINARY(ANDN_B, uint8_t, uint8_t, uint8_t, b&(c ^ 1))
STC_BINARY(ORN_B, uint8_t, uint8_t, uint8_t, b | (c ^ 1))
STC_UNARY(NOT_B, uint8_t, uint8_t, b ^ 1)

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
struct ConditionalMove : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    uint8_t* const a = STC_AT(A, pc->a);
    const T kept = load<T>(a);
    const T taken = load<T>(STC_AT(C, pc->c));
    store<T>(a, load<uint8_t>(STC_AT(B, pc->b)) != 0 ? taken : kept);
    STC_NEXT(1);
  }
};
#define CONDITIONAL_MOVE(suffix, T) \
  template <>                       \
  struct Semantics<ir::Opcode::CMOV_##suffix> : ConditionalMove<T> {};
STC_VALUES(CONDITIONAL_MOVE)

STC_INSTANTIATE_GROUP(kLogicHandlers);

}  // namespace vm
