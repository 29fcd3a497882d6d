// What an instruction does, as a step: it reads its operands, gives a result, and says how to go
// on. A handler is one step (handle.h) or several in a row (fused.h). semantics_*.h give each
// opcode a Semantics; the groups (handle_*.cc) make handlers of them.
#pragma once

#include <bit>
#include <tuple>
#include <type_traits>

#include "vm/exec/context.h"
#include "vm/exec/fusion.h"

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
// Everything else that is a step: a member template step(operands, machine, result), which does not
// store the result. `kUnits` is how many units it takes.
template <class To, uint32_t units = 1>
struct Stepwise {
  static constexpr int kReads = 0;
  static constexpr uint32_t kUnits = units;
  using Result = To;
};
// Handlers of their own: a member template run<A, B, C>(handler arguments).
struct Special {
  static constexpr int kReads = -1;
};

// Where an execution is, for the length of one handler. `pc` is the step's own unit until its end.
struct Machine {
  const ir::Unit* pc;
  uint8_t* frame;
  uint8_t* self;
  uint8_t* mem;
  const uint8_t* consts;
  Context* ctx;
};
#define STC_MACHINE \
  { pc, frame, self, mem, consts, ctx }

enum class Flow : uint8_t {
  kOn,    // with the next step; `pc` is its unit
  kAway,  // at `pc`, whatever steps were to follow
  // The execution stops:
  kDone,
  kSuspended,  // and goes on at `pc`
  kTrapped,    // in the step; the Context says what
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

struct NoValue {};
template <class T>
using ValueOf = std::conditional_t<std::is_void_v<T>, NoValue, T>;

// The operands of a step. A source from operand::v0 on is the result of an earlier step.
template <uint8_t A, uint8_t B, uint8_t C, class Values>
struct Operands {
  static constexpr ir::Base kBaseB = static_cast<ir::Base>(B);
  const Machine& m;
  const Values& values;
  template <class T>
  STC_INLINE_MEMBER T a() const {
    return read<A, T>(m.pc->a);
  }
  template <class T>
  STC_INLINE_MEMBER T b() const {
    return read<B, T>(m.pc->b);
  }
  template <class T>
  STC_INLINE_MEMBER T c() const {
    return read<C, T>(m.pc->c);
  }
  // Places of fields that are a base only, or reach far.
  STC_INLINE_MEMBER uint8_t* place_b(uint32_t offset) const { return place<B>(offset); }
  STC_INLINE_MEMBER uint32_t address_b(uint32_t offset) const { return address<B>(offset); }
  STC_INLINE_MEMBER uint32_t address_c(uint32_t offset) const { return address<C>(offset); }

 private:
  template <uint8_t base>
  STC_INLINE_MEMBER uint8_t* place(uint32_t offset) const {
    return at<static_cast<ir::Base>(base)>(m.frame, m.self, m.mem, m.consts, offset);
  }
  // Offset in data memory.
  template <uint8_t base>
  STC_INLINE_MEMBER uint32_t address(uint32_t offset) const {
    return static_cast<uint32_t>(place<base>(0) - m.mem) + offset;
  }
  template <uint8_t source, class T>
  STC_INLINE_MEMBER T read(uint32_t offset) const {
    if constexpr (source < operand::v0) {
      return load<T>(place<source>(offset));
    } else {
      const auto value = std::get<source - operand::v0>(values);
      if constexpr (std::is_same_v<T, Bool>) {
        return static_cast<Bool>(std::bit_cast<uint8_t>(value) != 0);
      } else {
        return std::bit_cast<T>(value);
      }
    }
  }
};

// No call, and what all exits do is left to the end (leave): handlers keep no frame.
STC_INLINE Flow trap(const Machine& m, ir::TrapKind kind, int64_t operand0 = 0,
                     int64_t operand1 = 0) {
  m.ctx->trap.kind = kind;
  m.ctx->trap.operand[0] = operand0;
  m.ctx->trap.operand[1] = operand1;
  return Flow::kTrapped;
}
template <class S, class T>
STC_INLINE Flow trap_on_value(const Machine& m, T value) {
  int64_t operand = 0;
  if constexpr (requires { S::culprit(value); }) operand = S::culprit(value);
  return trap(m, S::kTrap, operand);
}

constexpr bool stops(Flow flow) { return flow > Flow::kAway; }
STC_INLINE void leave(const Machine& m, Flow flow) {
  Context* const ctx = m.ctx;
  ctx->running = false;
  ctx->exit = flow == Flow::kTrapped     ? Exit::kTrap
              : flow == Flow::kSuspended ? Exit::kSuspended
                                         : Exit::kDone;
  ctx->pc = m.pc;
  ctx->frame = m.frame;
  ctx->self = m.self;
}

// Takes one step. Its result goes into `result`, and to its place in memory, whose base is `to`.
template <ir::Opcode op, uint8_t to, uint8_t A, uint8_t B, uint8_t C, class Values, class Result>
STC_INLINE Flow take_step(Machine& m, const Values& values, [[maybe_unused]] Result& result) {
  using S = Semantics<op>;
  const Operands<A, B, C, Values> operands{m, values};
  Flow flow = Flow::kOn;
  const ir::Unit* const unit = m.pc;
  if constexpr (S::kReads == 0) {
    flow = S::step(operands, m, result);
    if (stops(flow)) [[unlikely]]
      return flow;
  } else if constexpr (S::kReads == 1) {
    const auto b = operands.template b<typename S::Left>();
    if constexpr (requires { S::kTrap; }) {
      if (S::fails(b)) [[unlikely]]
        return trap_on_value<S>(m, b);
    }
    if constexpr (!std::is_void_v<typename S::Result>) result = S::apply(b);
    m.pc += 1;
  } else {
    const auto b = operands.template b<typename S::Left>();
    const auto c = operands.template c<typename S::Right>();
    if constexpr (requires { S::kTrap; }) {
      if (S::fails(b, c)) [[unlikely]]
        return trap_on_value<S>(m, b);
    }
    result = S::apply(b, c);
    m.pc += 1;
  }
  if constexpr (!std::is_void_v<typename S::Result>) {
    store<Result>(at<static_cast<ir::Base>(to)>(m.frame, m.self, m.mem, m.consts, unit->a), result);
  }
  return flow;
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
