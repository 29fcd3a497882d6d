// The shapes that handlers have. A group (handle_*.cc) specialises Semantics for its
// opcodes, then instantiates their handlers with STC_INSTANTIATE_GROUP.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "vm/exec/context.h"
#include "vm/exec/handler_numbers.h"

namespace vm {

template <ir::Opcode op>
struct Semantics;

// a := apply(b) and a := apply(b, c). With a member `fails` (the same arguments) and a
// kTrap, the operands are checked first; `culprit` says which value the trap reports.
template <class From, class To>
struct Unary {
  static constexpr int kReads = 1;
  using Left = From;
  using Result = To;
};
template <class B, class C, class To>
struct Binary {
  static constexpr int kReads = 2;
  using Left = B;
  using Right = C;
  using Result = To;
};
// Everything else: a member template run<A, B, C>(handler arguments).
struct Special {
  static constexpr int kReads = 0;
};

template <ir::Base base>
STC_INLINE uint8_t* at(uint8_t* frame, uint8_t* self, uint8_t* mem, const uint8_t* consts,
                       uint32_t offset) {
  if constexpr (base == ir::Base::kFrame) return frame + offset;
  if constexpr (base == ir::Base::kSelf) return self + offset;
  if constexpr (base == ir::Base::kGlobal) return mem + offset;
  if constexpr (base == ir::Base::kConst) return const_cast<uint8_t*>(consts) + offset;
}
#define STC_AT(base, offset) vm::at<base>(frame, self, mem, consts, offset)

template <class S, class... Operands>
STC_INLINE bool operands_fail(Operands... operands) {
  if constexpr (requires { S::fails(operands...); }) {
    return S::fails(operands...);
  } else {
    return false;
  }
}

template <class S, class T>
STC_INLINE void raise_value(Context* ctx, const ir::Unit* pc, uint8_t* frame, uint8_t* self,
                            [[maybe_unused]] T value) {
  if constexpr (requires { S::kTrap; }) {
    int64_t operand = 0;
    if constexpr (requires { S::culprit(value); }) operand = S::culprit(value);
    raise(ctx, S::kTrap, pc, frame, self, operand);
  }
}

template <ir::Opcode op, ir::Base A, ir::Base B, ir::Base C>
void handle(STC_HANDLER_ARGS) {
  using S = Semantics<op>;
  if constexpr (S::kReads == 1) {
    const auto b = load<typename S::Left>(STC_AT(B, pc->b));
    if (operands_fail<S>(b)) [[unlikely]]
      return raise_value<S>(ctx, pc, frame, self, b);
    if constexpr (!std::is_void_v<typename S::Result>) {
      store<typename S::Result>(STC_AT(A, pc->a), S::apply(b));
    }
    STC_NEXT(1);
  } else if constexpr (S::kReads == 2) {
    const auto b = load<typename S::Left>(STC_AT(B, pc->b));
    const auto c = load<typename S::Right>(STC_AT(C, pc->c));
    if (operands_fail<S>(b, c)) [[unlikely]]
      return raise_value<S>(ctx, pc, frame, self, b);
    store<typename S::Result>(STC_AT(A, pc->a), S::apply(b, c));
    STC_NEXT(1);
  } else {
    STC_MUST_TAIL return S::template run<A, B, C>(pc, frame, self, mem, consts, ctx);
  }
}

// Position of an index in its dimension; the caller compares it with the count. An
// index beyond int64 is outside whatever the lower bound is.
template <class T>
STC_INLINE uint64_t position(T index, const BoundEntry& bound) {
  if constexpr (std::is_same_v<T, uint64_t>) {
    if (index > static_cast<uint64_t>(INT64_MAX)) [[unlikely]]
      return UINT64_MAX;
  }
  return static_cast<uint64_t>(static_cast<int64_t>(index)) - static_cast<uint64_t>(bound.low);
}

// --- instantiation -------------------------------------------------------------

template <class Group, ir::Opcode op, uint32_t... i>
constexpr void add_handlers(HandlerTable& table, uint32_t& count,
                            std::integer_sequence<uint32_t, i...>) {
  if constexpr (requires { sizeof(Semantics<op>); }) {
    ((table.of[count++] = &handle<op, base_of_a(op, i), base_of_b(op, i), base_of_c(op, i)>), ...);
  }
}

// Depends on `Group`, a type of the group's own, so that the Semantics are looked for where
// the group ends and not here.
template <class Group>
constexpr HandlerTable handlers_of_group() {
  HandlerTable table{};
  uint32_t count = 0;
#define OP(name, a, b, c, x, y, flags, meaning) \
  add_handlers<Group, ir::Opcode::name>(        \
      table, count,                             \
      std::make_integer_sequence<               \
          uint32_t, kBaseCounts[static_cast<uint32_t>(ir::Opcode::name)].product()>());
#include "ir/bytecode/opcodes.def"
#undef OP
  return table;
}

// At the end of a group: emits the handlers of every opcode that has Semantics there.
#define STC_INSTANTIATE_GROUP(name) \
  struct name##Group;               \
  extern const HandlerTable name;   \
  constinit const HandlerTable name = handlers_of_group<name##Group>()

// --- families of opcodes ---------------------------------------------------------

#define STC_WORDS(M) M(8, uint8_t) M(16, uint16_t) M(32, uint32_t) M(64, uint64_t)
#define STC_FLOATS(M) M(F32, float) M(F64, double)
#define STC_SIGNED(M) M(I8, int8_t) M(I16, int16_t) M(I32, int32_t) M(I64, int64_t)
#define STC_UNSIGNED(M) M(U8, uint8_t) M(U16, uint16_t) M(U32, uint32_t) M(U64, uint64_t)
#define STC_VALUES(M) M(B, Bool) STC_WORDS(M) STC_FLOATS(M)

#define STC_UNARY(name, From, To, expression)                       \
  template <>                                                       \
  struct Semantics<ir::Opcode::name> : Unary<From, To> {            \
    static To apply(From b) { return static_cast<To>(expression); } \
  };
#define STC_BINARY(name, B_, C_, To, expression)                        \
  template <>                                                           \
  struct Semantics<ir::Opcode::name> : Binary<B_, C_, To> {             \
    static To apply(B_ b, C_ c) { return static_cast<To>(expression); } \
  };

// Arithmetic that wraps: small types would be promoted to int, which must not overflow.
template <class T>
using Wide = std::conditional_t<std::is_floating_point_v<T>, T,
                                std::conditional_t<sizeof(T) == 8, uint64_t, uint32_t>>;

}  // namespace vm
