// Far operands, addresses, loads and stores through them, strings.
//
// Addresses are 32-bit and wrap; 16-bit displacements are added behind that. With
// the guard behind data memory nothing here can touch other memory of the process,
// whatever an address holds.
#include "vm/exec/copies.h"
#include "vm/exec/handle.h"

namespace vm {

template <class T>
struct LoadFar : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<T>(frame + pc->a, load<T>(STC_AT(B, pc->bc())));
    STC_NEXT(1);
  }
};
template <class T>
struct StoreFar : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<T>(STC_AT(B, pc->bc()), load<T>(frame + pc->a));
    STC_NEXT(1);
  }
};
template <class T>
struct LoadAt : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<T>(frame + pc->a, load<T>(mem + load<uint32_t>(frame + pc->b) + pc->c));
    STC_NEXT(1);
  }
};
template <class T>
struct StoreAt : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<T>(mem + load<uint32_t>(frame + pc->a) + pc->c, load<T>(STC_AT(B, pc->b)));
    STC_NEXT(1);
  }
};
#define ACCESS(suffix, T)                                        \
  template <>                                                    \
  struct Semantics<ir::Opcode::LDFAR_##suffix> : LoadFar<T> {};  \
  template <>                                                    \
  struct Semantics<ir::Opcode::STFAR_##suffix> : StoreFar<T> {}; \
  template <>                                                    \
  struct Semantics<ir::Opcode::LD_##suffix> : LoadAt<T> {};      \
  template <>                                                    \
  struct Semantics<ir::Opcode::ST_##suffix> : StoreAt<T> {};
STC_VALUES(ACCESS)

// Offset in data memory of a place.
#define STC_ADDRESS(base, offset) (static_cast<uint32_t>(STC_AT(base, 0) - mem) + (offset))

template <>
struct Semantics<ir::Opcode::LEA> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(frame + pc->a, STC_ADDRESS(B, pc[1].x()));
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::LEA_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(frame + pc->a, load<uint32_t>(frame + pc->b) + pc[1].x());
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::LD_REF> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const auto target = load<uint32_t>(STC_AT(B, pc->bc()));
    if (target == 0) [[unlikely]]
      return raise(ctx, ir::TrapKind::kReference, pc, frame, self);
    store<uint32_t>(frame + pc->a, target);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::LD_REF_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const auto target = load<uint32_t>(mem + load<uint32_t>(frame + pc->b) + pc->c);
    if (target == 0) [[unlikely]]
      return raise(ctx, ir::TrapKind::kReference, pc, frame, self);
    store<uint32_t>(frame + pc->a, target);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::ST_REF_AT> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint32_t>(mem + load<uint32_t>(frame + pc->a) + pc->c, load<uint32_t>(frame + pc->b));
    STC_NEXT(1);
  }
};

#define STC_INDEX(T, array)                                                                        \
  const T index = load<T>(STC_AT(B, pc->b));                                                       \
  const uint32_t number = pc[1].x();                                                               \
  const BoundEntry& bound = ctx->bounds[number];                                                   \
  const uint64_t steps = position<T>(index, bound);                                                \
  if (steps >= bound.count) [[unlikely]] {                                                         \
    return raise(ctx, ir::TrapKind::kIndex, pc, frame, self, static_cast<int64_t>(index), number); \
  }                                                                                                \
  store<uint32_t>(frame + pc->a, (array) + static_cast<uint32_t>(steps) * bound.stride);           \
  STC_NEXT(2)

template <class T>
struct IndexAt : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_INDEX(T, load<uint32_t>(frame + pc->c) + pc[1].y());
  }
};
template <class T>
struct IndexPlace : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    STC_INDEX(T, STC_ADDRESS(C, pc[1].y()));
  }
};
#define INDEX(suffix, T)                                        \
  template <>                                                   \
  struct Semantics<ir::Opcode::INDEX_##suffix> : IndexAt<T> {}; \
  template <>                                                   \
  struct Semantics<ir::Opcode::INDEX_PLACE_##suffix> : IndexPlace<T> {};
STC_SIGNED(INDEX)
STC_UNSIGNED(INDEX)

// x holds the bytes: Generation::build has put them in the place of the type.
template <>
struct Semantics<ir::Opcode::COPY> : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    std::memmove(mem + load<uint32_t>(frame + pc->a), mem + load<uint32_t>(frame + pc->b),
                 pc[1].x());
    STC_NEXT(2);
  }
};

// A reference to a string is {offset:32, capacity:32}.
STC_INLINE uint64_t string_reference(uint32_t offset, uint32_t capacity) {
  return offset | static_cast<uint64_t>(capacity) << 32;
}
struct StringPlace : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    store<uint64_t>(frame + pc->a, string_reference(STC_ADDRESS(B, pc[1].x()), pc[1].y()));
    STC_NEXT(2);
  }
};
struct StringAt : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const uint32_t offset = load<uint32_t>(frame + pc->b) + pc[1].x();
    store<uint64_t>(frame + pc->a, string_reference(offset, pc[1].y()));
    STC_NEXT(2);
  }
};
template <>
struct Semantics<ir::Opcode::STR> : StringPlace {};
template <>
struct Semantics<ir::Opcode::WSTR> : StringPlace {};
template <>
struct Semantics<ir::Opcode::STR_AT> : StringAt {};
template <>
struct Semantics<ir::Opcode::WSTR_AT> : StringAt {};

template <uint64_t (*copy)(uint8_t*, uint64_t, uint64_t, uint64_t, uint64_t, uint64_t)>
struct StringCopy : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    copy(mem, load<uint64_t>(frame + pc->a), load<uint64_t>(frame + pc->b), 0, 0, 0);
    STC_NEXT(1);
  }
};
template <>
struct Semantics<ir::Opcode::SCOPY> : StringCopy<&copy_string> {};
template <>
struct Semantics<ir::Opcode::WCOPY> : StringCopy<&copy_wstring> {};

STC_INSTANTIATE_GROUP(kMemoryHandlers);

}  // namespace vm
