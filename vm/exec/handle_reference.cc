// Handles: made, moved, resolved.
#include "vm/exec/handle.h"
#include "vm/exec/references.h"

namespace vm {
namespace {

// Apart from their handlers, whose frames must not outlive the jump to the next one.
[[gnu::noinline]] bool make_handle_of(Context* ctx, const uint8_t* mem, const uint8_t* frame,
                                      uint32_t address, uint8_t* result) {
  const std::optional<uint64_t> handle =
      handle_of(*ctx, static_cast<uint32_t>(frame - mem), address);
  if (handle) store<uint64_t>(result, *handle);
  return handle.has_value();
}
[[gnu::noinline]] uint64_t move_slowly(const Context* ctx, uint64_t handle, uint64_t bytes,
                                       KnownReach* known) {
  return move_handle(*ctx, handle, bytes, *known);
}
[[gnu::noinline]] uint32_t resolve_slowly(const Context* ctx, uint64_t handle, bool exactly,
                                          uint32_t x, KnownReach* known) {
  return exactly ? resolve_exactly(*ctx, handle, x) : resolve_bytes(*ctx, handle, x, *known);
}
[[gnu::noinline]] uint64_t resolve_text(const Context* ctx, uint64_t handle, uint32_t capacity,
                                        uint32_t unit) {
  return resolve_string(*ctx, handle, capacity, unit);
}
// The operands say what did not resolve, and why (describe.cc).
STC_COLD void raise_reference(Context* ctx, const ir::Unit* pc, uint8_t* frame, uint8_t* self,
                              uint64_t handle, uint32_t size) {
  raise(ctx, ir::TrapKind::kReference, pc, frame, self, static_cast<int64_t>(handle),
        has_left(*ctx, handle, size) ? 1 : 0);
}
[[gnu::noinline]] uint32_t flatten(const Context* ctx, uint64_t handle) {
  return flat_of(*ctx, handle);
}
[[gnu::noinline]] uint64_t unflatten(const Context* ctx, uint32_t address) {
  return unflat(*ctx, address);
}

STC_INLINE KnownReach& known_at(Context* ctx, const ir::Unit* pc) {
  return ctx->reaches[reinterpret_cast<uintptr_t>(pc) / sizeof(ir::Unit) % kKnownReaches];
}
// Where `handle` lies in the known variable; its size or more: somewhere else, or outside of it.
STC_INLINE uint32_t position_in(const KnownReach& known, uint64_t handle) {
  const bool same = static_cast<uint32_t>(handle >> 32) == known.segment;
  return same ? ir::handle_offset(handle) - known.begin : UINT32_MAX;
}
STC_INLINE uint64_t signed_part(uint32_t bytes) {
  return static_cast<uint64_t>(int64_t{static_cast<int32_t>(bytes)});
}
STC_INLINE uint64_t move_at(Context* ctx, const ir::Unit* pc, uint64_t handle, uint64_t bytes) {
  KnownReach& known = known_at(ctx, pc);
  const uint64_t position = position_in(known, handle);  // with all bits of `bytes`
  if (position < known.size && position + bytes < known.size) [[likely]]
    return ir::move_offset(handle, bytes);
  return move_slowly(ctx, handle, bytes, &known);
}
STC_INLINE uint32_t resolve_at(Context* ctx, const ir::Unit* pc, uint64_t handle, uint32_t bytes,
                               uint32_t size) {
  const KnownReach& known = known_at(ctx, pc);
  const uint32_t position = position_in(known, handle);
  const bool inside =
      position < known.size && uint64_t{position} + bytes + size <= known.size && known.home != 0;
  return inside ? known.home + ir::handle_offset(handle) + bytes : 0;
}

}  // namespace

template <>
struct Semantics<ir::Opcode::HANDLE> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const std::vector<AreaEntry>& areas = ctx->generation->areas();
    const uint32_t offset = pc[1].x();
    if constexpr (B == ir::Base::kSelf) {
      store<uint64_t>(frame + pc->a, ir::make_handle(areas[ctx->instance].segment, offset));
    } else if constexpr (B == ir::Base::kGlobal) {
      store<uint64_t>(frame + pc->a, ir::make_handle(areas[0].segment, offset - areas[0].data));
    } else {
      const uint32_t address = static_cast<uint32_t>(frame - mem) + offset;
      if (!make_handle_of(ctx, mem, frame, address, frame + pc->a)) [[unlikely]]
        return raise(ctx, ir::TrapKind::kStack, pc, frame, self);
    }
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::HANDLE_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint32_t address = load<uint32_t>(frame + pc->b) + pc[1].x();
    if (!make_handle_of(ctx, mem, frame, address, frame + pc->a)) [[unlikely]]
      return raise(ctx, ir::TrapKind::kStack, pc, frame, self);
    STC_NEXT(2);
  }
};

#define STC_HANDLE_OF_INSTANCE(slot)                                                        \
  const auto id = load<uint32_t>(slot);                                                     \
  if (id >= ctx->instance_count || ctx->instances[id].data == 0) [[unlikely]] {             \
    return raise(ctx, ir::TrapKind::kInstance, pc, frame, self, id);                        \
  }                                                                                         \
  store<uint64_t>(frame + pc->a, ir::make_handle(ctx->generation->areas()[id].segment, 0)); \
  STC_NEXT(1)

template <>
struct Semantics<ir::Opcode::HANDLE_INST> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_HANDLE_OF_INSTANCE(STC_AT(B, pc->bc()));
  }
};
template <>
struct Semantics<ir::Opcode::HANDLE_INST_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_HANDLE_OF_INSTANCE(mem + load<uint32_t>(frame + pc->b) + pc->c);
  }
};

template <>
struct Semantics<ir::Opcode::HANDLE_ADD> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const auto handle = load<uint64_t>(STC_AT(B, pc->b));
    const auto bytes = load<uint64_t>(STC_AT(C, pc->c));
    store<uint64_t>(frame + pc->a, move_at(ctx, pc, handle, bytes));
    STC_NEXT(1);
  }
};

template <>
struct Semantics<ir::Opcode::HANDLE_STEP> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const auto handle = load<uint64_t>(STC_AT(B, pc->b));
    store<uint64_t>(frame + pc->a, move_at(ctx, pc, handle, signed_part(pc[1].x())));
    STC_NEXT(2);
  }
};

template <class T>
struct HandleIndex : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const T index = load<T>(STC_AT(B, pc->b));
    const uint32_t number = pc[1].x();
    const BoundEntry& bound = ctx->bounds[number];
    const uint64_t steps = position<T>(index, bound);
    if (steps >= bound.count) [[unlikely]] {
      return raise(ctx, ir::TrapKind::kIndex, pc, frame, self, static_cast<int64_t>(index), number);
    }
    const auto handle = load<uint64_t>(STC_AT(C, pc->c));
    const uint64_t bytes = pc[1].y() + steps * bound.stride;
    store<uint64_t>(frame + pc->a, move_at(ctx, pc, handle, bytes));
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::HANDLE_INDEX_I64> : HandleIndex<int64_t> {};
template <>
struct Semantics<ir::Opcode::HANDLE_INDEX_U64> : HandleIndex<uint64_t> {};

// c and x: Generation::build has put them there.
template <>
struct Semantics<ir::Opcode::RESOLVE> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    uint64_t handle = load<uint64_t>(STC_AT(B, pc->b));
    const bool exactly = pc->c != 0;
    uint32_t found = exactly ? 0 : resolve_at(ctx, pc, handle, pc[1].y(), pc[1].x());
    if (found == 0) [[unlikely]] {
      KnownReach& known = known_at(ctx, pc);
      if (pc[1].y() != 0) handle = move_slowly(ctx, handle, signed_part(pc[1].y()), &known);
      found = resolve_slowly(ctx, handle, exactly, pc[1].x(), &known);
      if (found == 0) [[unlikely]]
        return raise_reference(ctx, pc, frame, self, handle, exactly ? 0 : pc[1].x());
    }
    store<uint32_t>(frame + pc->a, found);
    STC_NEXT(2);
  }
};

template <uint32_t unit>
struct ResolveString : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint64_t handle =
        move_at(ctx, pc, load<uint64_t>(STC_AT(B, pc->b)), signed_part(pc[1].y()));
    const uint64_t found = resolve_text(ctx, handle, pc[1].x(), unit);
    if (found == 0) [[unlikely]]
      return raise_reference(ctx, pc, frame, self, handle, unit);
    store<uint64_t>(frame + pc->a, found);
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::RESOLVE_S> : ResolveString<1> {};
template <>
struct Semantics<ir::Opcode::RESOLVE_W> : ResolveString<2> {};

template <>
struct Semantics<ir::Opcode::FLAT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(frame + pc->a, flatten(ctx, load<uint64_t>(STC_AT(B, pc->b))));
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::UNFLAT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint64_t>(frame + pc->a, unflatten(ctx, load<uint32_t>(STC_AT(B, pc->b))));
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::SIZE_OF> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(frame + pc->a, pc[1].x());
    STC_NEXT(2);
  }
};

STC_INSTANTIATE_GROUP(kReferenceHandlers);

}  // namespace vm
