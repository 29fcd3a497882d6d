// Jumps, calls, instances, native functions. Safe points are the back edge and the
// entry of a called POU: there the frame memory is all there is to know.

#include "stdlib/native/natives.h"
#include "vm/exec/handle.h"
#include "vm/exec/references.h"
#include "vm/exec/semantics_control.h"
#include "vm/exec/store_aside.h"
#include "vm/native/program.h"

namespace vm {

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
struct Semantics<ir::Opcode::ADVANCE_TIME> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    ctx->task_time_ns = static_cast<int64_t>(static_cast<uint64_t>(ctx->task_time_ns) +
                                             load<uint64_t>(STC_AT(B, pc->b)));
    STC_NEXT(1);
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

const ir::Unit* native_entry(const Context* ctx, const ir::Unit* unit) {
  return ctx->native->entry(ctx->pou, unit);
}

// Runs machine code until its POU returns, or the interpreter is to go on somewhere.
void resume_native(STC_HANDLER_ARGS) {
  uint64_t unit;
  std::memcpy(&unit, pc, sizeof unit);
  const void* const code = reinterpret_cast<const void*>(unit >> 16);
  ++ctx->entries;
  if (ctx->native->enter(code, frame, self, mem, ctx)) {
    if (ctx->call == ctx->calls_begin) {  // as stop() does, which is far away
      ctx->running = false;
      ctx->exit = Exit::kDone;
      return;
    }
    const CallRecord& caller = *--ctx->call;
    ctx->pou = caller.pou;
    ctx->instance = caller.instance;
    STC_GO(caller.resume, caller.frame, caller.self);
  }
  if (!ctx->running) return;
  STC_GO(ctx->pc, ctx->frame, ctx->self);
}

// --- stores of versions beside their code -----------------------------------------------------

void go_aside(STC_HANDLER_ARGS) { STC_GO(aside_of(pc).units, frame, self); }

void restore_forced(STC_HANDLER_ARGS) {
  const StoreAside& aside = aside_of(pc);
  for (const StoreAside::Value& value : aside.values) {
    put_value(mem + value.data, value.bytes, value.size, value.mask);
  }
  STC_GO(aside.back, frame, self);
}

// After the one instruction that a helper executes.
void stop_helper(STC_HANDLER_ARGS) {}

}  // namespace vm
