// Far operands, addresses, loads and stores through them, strings.
//
// Addresses are 32-bit and wrap; 16-bit displacements are added after that. With
// the guard after data memory nothing here can touch other memory of the process,
// whatever an address holds.
#pragma once

#include "stdlib/native/units.h"
#include "vm/exec/copies.h"
#include "vm/exec/step.h"

namespace vm {

template <class T>
struct LoadFar : Stepwise<T> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, T& result) {
    result = load<T>(o.place_b(m.pc->bc()));
    m.pc += 1;
    return Flow::kOn;
  }
};
template <class T>
struct StoreFar : Stepwise<void> {
  static constexpr bool kStores = true;
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    store<T>(o.place_b(m.pc->bc()), o.template a<T>());
    m.pc += 1;
    return Flow::kOn;
  }
};
template <class T>
struct LoadAt : Stepwise<T> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, T& result) {
    result = load<T>(m.mem + o.template b<uint32_t>() + m.pc->c);
    m.pc += 1;
    return Flow::kOn;
  }
};
template <class T>
struct StoreAt : Stepwise<void> {
  static constexpr bool kStores = true;
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    store<T>(m.mem + o.template a<uint32_t>() + m.pc->c, o.template b<T>());
    m.pc += 1;
    return Flow::kOn;
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

template <>
struct Semantics<ir::Opcode::LEA> : Stepwise<uint32_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    result = o.address_b(m.pc[1].x());
    m.pc += 2;
    return Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::LEA_AT> : Stepwise<uint32_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    result = o.template b<uint32_t>() + m.pc[1].x();
    m.pc += 2;
    return Flow::kOn;
  }
};

// Binds an in-out parameter; nothing is bound to a slot that is 0.
STC_INLINE Flow take_reference(Machine& m, const uint8_t* slot, uint32_t& result) {
  result = load<uint32_t>(slot);
  if (result == 0) [[unlikely]]
    return trap(m, ir::TrapKind::kReference);
  m.pc += 1;
  return Flow::kOn;
}
template <>
struct Semantics<ir::Opcode::LD_REF> : Stepwise<uint32_t> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    return take_reference(m, o.place_b(m.pc->bc()), result);
  }
};
template <>
struct Semantics<ir::Opcode::LD_REF_AT> : Stepwise<uint32_t> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    return take_reference(m, m.mem + o.template b<uint32_t>() + m.pc->c, result);
  }
};
template <>
struct Semantics<ir::Opcode::ST_REF_AT> : StoreAt<uint32_t> {};

template <class T>
STC_INLINE Flow take_element(Machine& m, T index, uint32_t array, uint32_t& result) {
  const uint32_t number = m.pc[1].x();
  const BoundEntry& bound = m.ctx->bounds[number];
  const uint64_t steps = position<T>(index, bound);
  if (steps >= bound.count) [[unlikely]] {
    return trap(m, ir::TrapKind::kIndex, static_cast<int64_t>(index), number);
  }
  result = array + static_cast<uint32_t>(steps) * bound.stride;
  m.pc += 2;
  return Flow::kOn;
}
template <class T>
struct IndexAt : Stepwise<uint32_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    const uint32_t array = o.template c<uint32_t>() + m.pc[1].y();
    return take_element<T>(m, o.template b<T>(), array, result);
  }
};
template <class T>
struct IndexPlace : Stepwise<uint32_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    return take_element<T>(m, o.template b<T>(), o.address_c(m.pc[1].y()), result);
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
struct Semantics<ir::Opcode::COPY> : Stepwise<void, 2> {
  static constexpr bool kStores = true;
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    stdlib::copy_bytes(m.mem + o.template a<uint32_t>(), m.mem + o.template b<uint32_t>(),
                       m.pc[1].x());
    m.pc += 2;
    return Flow::kOn;
  }
};

// A reference to a string is {offset:32, capacity:32}.
STC_INLINE uint64_t string_reference(uint32_t offset, uint32_t capacity) {
  return offset | static_cast<uint64_t>(capacity) << 32;
}
struct StringPlace : Stepwise<uint64_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint64_t& result) {
    result = string_reference(o.address_b(m.pc[1].x()), m.pc[1].y());
    m.pc += 2;
    return Flow::kOn;
  }
};
struct StringAt : Stepwise<uint64_t, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint64_t& result) {
    result = string_reference(o.template b<uint32_t>() + m.pc[1].x(), m.pc[1].y());
    m.pc += 2;
    return Flow::kOn;
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
struct StringCopy : Stepwise<void> {
  static constexpr bool kStores = true;
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    copy(m.mem, o.template a<uint64_t>(), o.template b<uint64_t>(), 0, 0, 0);
    m.pc += 1;
    return Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::SCOPY> : StringCopy<&copy_string> {};
template <>
struct Semantics<ir::Opcode::WCOPY> : StringCopy<&copy_wstring> {};

}  // namespace vm
