// Jumps, calls, instances, native functions. Safe points are the back edge and the
// entry of a called POU: there the frame memory is all there is to know.
#include <algorithm>

#include "base/limits.h"
#include "stdlib/native/natives.h"
#include "vm/exec/handle.h"
#include "vm/exec/references.h"
#include "vm/native/program.h"

namespace vm {

template <>
struct Semantics<ir::Opcode::JMP> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_NEXT(1 + static_cast<int32_t>(pc->bc()));
  }
};
template <>
struct Semantics<ir::Opcode::LOOP> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const ir::Unit* const head = pc + 1 + static_cast<int32_t>(pc->bc());
    if (--ctx->fuel == 0) [[unlikely]]
      return stop(ctx, Exit::kSuspended, head, frame, self);
    STC_GO(head, frame, self);
  }
};
template <>
struct Semantics<ir::Opcode::JT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    if (load<uint8_t>(STC_AT(A, pc->a)) != 0) STC_NEXT(1 + static_cast<int32_t>(pc->bc()));
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::JF> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    if (load<uint8_t>(STC_AT(A, pc->a)) == 0) STC_NEXT(1 + static_cast<int32_t>(pc->bc()));
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::TRAP> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    return raise(ctx, static_cast<ir::TrapKind>(pc->a), pc, frame, self);
  }
};
template <>
struct Semantics<ir::Opcode::TRAP_AGAIN> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const auto kind = load<uint32_t>(STC_AT(B, pc->b));
    if (kind == static_cast<uint32_t>(ctx->caught.kind)) {
      ctx->trap = ctx->caught;
      ctx->trap_has_place = true;
      return stop(ctx, Exit::kTrap, pc, frame, self);
    }
    const bool known = kind < ir::kTrapCount;
    return raise(ctx, known ? static_cast<ir::TrapKind>(kind) : ir::TrapKind::kAssert, pc, frame,
                 self);
  }
};
template <>
struct Semantics<ir::Opcode::TASK_TIME> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<int64_t>(frame + pc->a, ctx->task_time_ns);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::ADVANCE_TIME> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    ctx->task_time_ns = static_cast<int64_t>(static_cast<uint64_t>(ctx->task_time_ns) +
                                             load<uint64_t>(STC_AT(B, pc->b)));
    STC_NEXT(1);
  }
};

// A declared recursion that is as deep as it may be.
[[gnu::noinline]] static bool is_too_deep(const Context* ctx, uint32_t pou) {
  uint32_t active = ctx->pou == pou ? 1 : 0;
  for (const CallRecord* record = ctx->calls_begin; record != ctx->call; ++record) {
    active += record->pou == pou ? 1 : 0;
  }
  return active >= ctx->pous[pou].recursion_depth;
}

// Enters a POU; the record says where and as what the caller goes on. The verifier
// has bounded the depth; the test costs nothing beside the record.
#define STC_CALL(number, callee_instance, callee_self, units)                   \
  if (ctx->call == ctx->calls_end) [[unlikely]] {                               \
    return raise(ctx, ir::TrapKind::kStack, pc, frame, self);                   \
  }                                                                             \
  const PouEntry& callee = ctx->pous[number];                                   \
  if (callee.recursion_depth != 0 && is_too_deep(ctx, number)) [[unlikely]] {   \
    return raise(ctx, ir::TrapKind::kStack, pc, frame, self);                   \
  }                                                                             \
  *ctx->call++ = {pc + (units), frame, self, ctx->pou, ctx->instance};          \
  ctx->pou = (number);                                                          \
  ctx->instance = (callee_instance);                                            \
  uint8_t* const callee_frame = frame + pc->a * 8u;                             \
  if (--ctx->fuel == 0) [[unlikely]] {                                          \
    return stop(ctx, Exit::kSuspended, callee.code, callee_frame, callee_self); \
  }                                                                             \
  STC_GO(callee.entry, callee_frame, callee_self)

template <>
struct Semantics<ir::Opcode::CALL> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_CALL(pc->c, 0, self, 1);
  }
};

template <>
struct Semantics<ir::Opcode::CALL_OWN> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_CALL(pc->c, ctx->instance, self, 1);
  }
};

// A row without data is free; the globals' row is made so as well.
#define STC_FIND_INSTANCE(slot)                                                 \
  const auto id = load<uint32_t>(slot);                                         \
  if (id >= ctx->instance_count || ctx->instances[id].data == 0) [[unlikely]] { \
    return raise(ctx, ir::TrapKind::kInstance, pc, frame, self, id);            \
  }                                                                             \
  const InstanceEntry& entry = ctx->instances[id]

template <>
struct Semantics<ir::Opcode::INST> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(STC_AT(B, pc->bc()));
    store<uint32_t>(frame + pc->a, entry.data);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::INST_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(mem + load<uint32_t>(frame + pc->b) + pc->c);
    store<uint32_t>(frame + pc->a, entry.data);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_INST> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(STC_AT(B, pc->bc()));
    STC_CALL(entry.pou, id, mem + entry.data, 1);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_INST_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(mem + load<uint32_t>(frame + pc->b) + pc->c);
    STC_CALL(entry.pou, id, mem + entry.data, 1);
  }
};
// x is a type number: Generation::build has put it there.
template <>
struct Semantics<ir::Opcode::CALL_REF> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint32_t id = find_instance(ctx, load<uint64_t>(STC_AT(B, pc->b)), pc[1].x());
    if (id == 0) [[unlikely]]
      return raise(ctx, ir::TrapKind::kReference, pc, frame, self);
    const InstanceEntry& entry = ctx->instances[id];
    STC_CALL(entry.pou, id, mem + entry.data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_METHOD> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(STC_AT(B, pc->bc()));
    STC_CALL(pc[1].x(), id, mem + entry.data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_METHOD_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_FIND_INSTANCE(mem + load<uint32_t>(frame + pc->b) + pc->c);
    STC_CALL(pc[1].x(), id, mem + entry.data, 2);
  }
};
// y is the type that the method is of: Generation::build has put it there.
template <>
struct Semantics<ir::Opcode::CALL_METHOD_REF> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint32_t id = find_instance(ctx, load<uint64_t>(STC_AT(B, pc->b)), pc[1].y());
    if (id == 0) [[unlikely]]
      return raise(ctx, ir::TrapKind::kReference, pc, frame, self);
    STC_CALL(pc[1].x(), id, mem + ctx->instances[id].data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_VIRTUAL> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const VirtualCallee found = find_target(ctx, load<uint64_t>(STC_AT(B, pc->b)), pc[1].x());
    if (found.instance == 0) [[unlikely]]
      return raise(ctx, ir::TrapKind::kReference, pc, frame, self);
    STC_CALL(found.pou, found.instance, mem + ctx->instances[found.instance].data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::IS_TYPE> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint32_t id = find_instance(ctx, load<uint64_t>(STC_AT(B, pc->b)), pc[1].x());
    store<Bool>(frame + pc->a, static_cast<Bool>(id != 0));
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::RET> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    if (ctx->call == ctx->exposed) [[unlikely]]
      drop_exposed(*ctx, static_cast<uint32_t>(ctx->call - ctx->calls_begin));
    if (ctx->call == ctx->calls_begin) return stop(ctx, Exit::kDone, pc, frame, self);
    const CallRecord& caller = *--ctx->call;
    ctx->pou = caller.pou;
    ctx->instance = caller.instance;
    STC_GO(caller.resume, caller.frame, caller.self);
  }
};
template <>
struct Semantics<ir::Opcode::NATIVE> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    stdlib::kNativeSlots[pc->c](mem, frame + pc->a * 8u);
    STC_NEXT(1);
  }
};

// --- tries: the verifier has bounded how many are open, and closed them before each return ---

template <>
struct Semantics<ir::Opcode::TRY> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    if (ctx->try_top == ctx->tries_end) [[unlikely]]
      return raise(ctx, ir::TrapKind::kStack, pc, frame, self);
    *ctx->try_top++ = {pc + 1 + static_cast<int32_t>(pc->bc()),
                       static_cast<uint32_t>(frame - mem),
                       static_cast<uint32_t>(self - mem),
                       ctx->pou,
                       ctx->instance,
                       static_cast<uint32_t>(ctx->call - ctx->calls_begin)};
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::END_TRY> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    --ctx->try_top;
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::TRAP_KIND> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(frame + pc->a, static_cast<uint32_t>(ctx->caught.kind));
    STC_NEXT(1);
  }
};

STC_INSTANTIATE_GROUP(kControlHandlers);

// --- side units of native code ----------------------------------------------------------------

// Runs machine code until its POU returns, or the interpreter is to go on somewhere.
void resume_native(STC_HANDLER_ARGS) {
  uint64_t unit;
  std::memcpy(&unit, pc, sizeof unit);
  const void* const code = reinterpret_cast<const void*>(unit >> 16);
  if (ctx->generation->native()->enter(code, frame, self, mem, ctx)) {
    if (ctx->call == ctx->calls_begin) return stop(ctx, Exit::kDone, ctx->pc, frame, self);
    const CallRecord& caller = *--ctx->call;
    ctx->pou = caller.pou;
    ctx->instance = caller.instance;
    STC_GO(caller.resume, caller.frame, caller.self);
  }
  if (!ctx->running) return;
  STC_GO(ctx->pc, ctx->frame, ctx->self);
}

// Behind the one instruction that a helper executes.
void stop_helper(STC_HANDLER_ARGS) {}

}  // namespace vm
