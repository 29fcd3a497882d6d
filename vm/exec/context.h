// What handlers share while an execution runs, and how one handler goes on to the next.
//
// A handler is one opcode with one base for each operand. It ends by calling the next
// one as a sibling call with the same six arguments, which stay in registers; the
// compiler makes that a jump (docs/adr/0001-tail-call-interpreter.md). Where it would
// not (sanitizers, no optimiser), handlers return instead and a loop calls the next one.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "ir/bytecode/code.h"
#include "vm/exec/execution.h"
#include "vm/exec/handler_numbers.h"

#ifndef STC_TAIL_CALLS
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define STC_TAIL_CALLS 0
#endif
#endif
#endif
#ifndef STC_TAIL_CALLS
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define STC_TAIL_CALLS 1
#else
#define STC_TAIL_CALLS 0
#endif
#endif

#if defined(__clang__)
#define STC_MUST_TAIL [[clang::musttail]]
#else
#define STC_MUST_TAIL
#endif
#define STC_INLINE [[gnu::always_inline]] static inline
#define STC_INLINE_MEMBER [[gnu::always_inline]]
#define STC_COLD [[gnu::noinline, gnu::cold]]

namespace vm {
namespace native {
class Program;
}

// The variable that a handle was found in last, by the instruction that used it: so loops over a
// buffer look it up once. It holds until the generation or what is exposed is another one.
struct KnownReach {
  // In this order they are the handle of its first byte, from which machine code takes the distance
  // of others: it is less than the size inside of the variable alone.
  uint32_t begin = 0;    // offset
  uint32_t segment = 0;  // the upper half of the handles that are inside; 0: none
  uint64_t size = 0;
  uint32_t home = 0;  // data offset of offset 0; 0: there are slots inside
};
inline constexpr uint32_t kKnownReaches = 16;
inline constexpr uint32_t kLoopReaches = 4;  // of pointers that a loop in machine code walks with

// A BOOL in memory. Bytes that came in as another type may be anything; not zero is TRUE.
enum class Bool : uint8_t {};

struct Context {
  uint64_t fuel = 0;
  CallRecord* call = nullptr;  // next free record
  CallRecord* calls_begin = nullptr;
  CallRecord* calls_end = nullptr;
  const PouEntry* pous = nullptr;
  const InstanceEntry* instances = nullptr;
  const AreaEntry* areas = nullptr;  // as many as instances
  uint32_t instance_count = 0;
  uint32_t pou = 0;
  uint32_t instance = 0;
  // Exposed locals (references.h), by depth; `exposed` is the call record of the deepest POU that
  // has some, and null when none has.
  const CallRecord* exposed = nullptr;
  Exposure* exposures = nullptr;
  uint32_t exposure_count = 0;
  uint32_t exposures_made = 0;
  uint32_t task = 0;
  const Generation* generation = nullptr;
  const native::Program* native = nullptr;  // of the generation; null: none
  uint64_t entries = 0;                     // into machine code
  uint8_t* memory = nullptr;
  const uint8_t* consts = nullptr;
  void* native_stack = nullptr;  // of the machine, where native code was entered
  const BoundEntry* bounds = nullptr;
  const RangeEntry* ranges = nullptr;
  // Generation::override_table()
  const OverrideEntry* overrides = nullptr;
  uint64_t override_mask = 0;
  uint64_t override_factor = 0;
  int64_t task_time_ns = 0;
  // Where it stopped; without tail calls: where it is.
  bool running = true;
  Exit exit = Exit::kDone;
  const ir::Unit* pc = nullptr;
  uint8_t* frame = nullptr;
  uint8_t* self = nullptr;
  Trap trap;
  // Open tries; what ordinary calls use comes first.
  TryRecord* tries_begin = nullptr;
  TryRecord* try_top = nullptr;  // next free record
  TryRecord* tries_end = nullptr;
  Trap caught;                  // last
  bool trap_has_place = false;  // `trap` says already where it was
  bool trapped = false;         // since it began: `trap` or `caught` is not empty
  // By the place of the instruction, then those of loops.
  KnownReach reaches[kKnownReaches + kLoopReaches];
};

// What machine code asks where the variable at reaches[site] is another one. The data offset of
// `size_and_bytes >> 32` bytes that the handle names, moved by the lower half; 0: they are not
// there. And the handle moved by the lower half of `bytes`.
uint64_t resolve_for_code(Context* ctx, uint64_t handle, uint64_t size_and_bytes, uint64_t site);
uint64_t move_for_code(Context* ctx, uint64_t handle, uint64_t bytes, uint64_t site);
// How far behind the first byte of its variable the handle is, at most one past the end. Where
// there is none that can be walked over, 2^32 behind the first byte of one without any.
uint64_t reach_for_code(Context* ctx, uint64_t handle, uint64_t, uint64_t site);

#define STC_HANDLER_ARGS                                                \
  [[maybe_unused]] const ir::Unit *pc, [[maybe_unused]] uint8_t *frame, \
      [[maybe_unused]] uint8_t *self, [[maybe_unused]] uint8_t *mem,    \
      [[maybe_unused]] const uint8_t *consts, [[maybe_unused]] vm::Context *ctx

using Handler = void (*)(const ir::Unit*, uint8_t*, uint8_t*, uint8_t*, const uint8_t*, Context*);

// By handler number; Generation::build puts these numbers into the op fields. After those of the
// opcodes come the two of side units (vm/native/emit.h) and the fused ones (fusion.h).
struct HandlerTable {
  Handler of[kHandlerLimit];
};
extern const HandlerTable kHandlers __attribute__((visibility("hidden")));

#if STC_TAIL_CALLS
#define STC_GO(next, next_frame, next_self)                                                     \
  do {                                                                                          \
    const ir::Unit* const go = (next);                                                          \
    STC_MUST_TAIL return vm::kHandlers.of[go->op](go, next_frame, next_self, mem, consts, ctx); \
  } while (false)
#else
#define STC_GO(next, next_frame, next_self) \
  do {                                      \
    ctx->pc = (next);                       \
    ctx->frame = (next_frame);              \
    ctx->self = (next_self);                \
    return;                                 \
  } while (false)
#endif
#define STC_NEXT(units) STC_GO(pc + (units), frame, self)

STC_COLD inline void stop(Context* ctx, Exit exit, const ir::Unit* pc, uint8_t* frame,
                          uint8_t* self) {
  ctx->running = false;
  ctx->exit = exit;
  ctx->pc = pc;
  ctx->frame = frame;
  ctx->self = self;
}

STC_COLD inline void raise(Context* ctx, ir::TrapKind kind, const ir::Unit* pc, uint8_t* frame,
                           uint8_t* self, int64_t operand0 = 0, int64_t operand1 = 0) {
  ctx->trap.kind = kind;
  ctx->trap.operand[0] = operand0;
  ctx->trap.operand[1] = operand1;
  stop(ctx, Exit::kTrap, pc, frame, self);
}

// Where the POU that is executed goes on at `unit`: in machine code, if that can be entered there.
const ir::Unit* native_entry(const Context* ctx, const ir::Unit* unit);

// Values lie at any address; these compile to plain loads and stores.
template <class T>
STC_INLINE T load(const uint8_t* at) {
  if constexpr (std::is_same_v<T, Bool>) return static_cast<Bool>(*at != 0);
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}
template <class T>
STC_INLINE void store(uint8_t* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

}  // namespace vm
