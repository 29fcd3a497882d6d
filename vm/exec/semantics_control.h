// What jumps, calls and instances mean. Safe points are the back edge and the entry of a called
// POU: there the frame memory is all there is to know.
#pragma once

#include <algorithm>

#include "vm/exec/references.h"
#include "vm/exec/step.h"

namespace vm {

STC_INLINE const ir::Unit* jump_target(const Machine& m) {
  return m.pc + 1 + static_cast<int32_t>(m.pc->bc());
}
template <>
struct Semantics<ir::Opcode::JMP> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, NoValue&) {
    m.pc = jump_target(m);
    return Flow::kOn;
  }
};
// Left in the middle of a POU, machine code is entered again at the next place that allows it.
STC_INLINE bool goes_on_in_machine_code(Machine& m) {
  if (m.ctx->native == nullptr) [[likely]]
    return false;
  const ir::Unit* const entry = native_entry(m.ctx, m.pc);
  const bool there = entry != m.pc;
  m.pc = entry;
  return there;
}
template <>
struct Semantics<ir::Opcode::LOOP> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, NoValue&) {
    m.pc = jump_target(m);
    if (--m.ctx->fuel == 0) [[unlikely]]
      return Flow::kSuspended;
    return goes_on_in_machine_code(m) ? Flow::kAway : Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::JT> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    if (o.template a<uint8_t>() != 0) {
      m.pc = jump_target(m);
      return Flow::kAway;
    }
    m.pc += 1;
    return Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::JF> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    if (o.template a<uint8_t>() == 0) {
      m.pc = jump_target(m);
      return Flow::kAway;
    }
    m.pc += 1;
    return Flow::kOn;
  }
};
// Takes the JMP of the table along.
template <class T>
struct Switch : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    const ir::Unit& table = m.pc[1];
    const auto low = static_cast<T>(static_cast<int32_t>(table.x()));
    const uint64_t entry = static_cast<T>(o.template b<T>() - low);
    m.pc += 2 + std::min(entry, uint64_t{table.y()});
    if (entry < table.y()) m.pc = jump_target(m);
    return Flow::kAway;
  }
};
#define SWITCH(suffix, T) \
  template <>             \
  struct Semantics<ir::Opcode::SWITCH_##suffix> : Switch<T> {};
STC_WORDS(SWITCH)
#undef SWITCH
template <>
struct Semantics<ir::Opcode::TASK_TIME> : Stepwise<int64_t> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, int64_t& result) {
    result = m.ctx->task_time_ns;
    m.pc += 1;
    return Flow::kOn;
  }
};

// A declared recursion that is as deep as it may be.
[[gnu::noinline]] inline bool is_too_deep(const Context* ctx, uint32_t pou) {
  uint32_t active = ctx->pou == pou ? 1 : 0;
  for (const CallRecord* record = ctx->calls_begin; record != ctx->call; ++record) {
    active += record->pou == pou ? 1 : 0;
  }
  return active >= ctx->pous[pou].recursion_depth;
}

// Enters a POU; the record says where and as what the caller goes on. The verifier
// has bounded the depth; the test costs nothing beside the record.
STC_INLINE Flow enter(Machine& m, uint32_t number, uint32_t instance, uint8_t* self,
                      uint32_t units) {
  Context* const ctx = m.ctx;
  if (ctx->call == ctx->calls_end) [[unlikely]]
    return trap(m, ir::TrapKind::kStack);
  const PouEntry& callee = ctx->pous[number];
  if (callee.recursion_depth != 0 && is_too_deep(ctx, number)) [[unlikely]]
    return trap(m, ir::TrapKind::kStack);
  const ir::Unit* resume = m.pc + units;
  if (ctx->native != nullptr) [[unlikely]]
    resume = native_entry(ctx, resume);
  *ctx->call++ = {resume, m.frame, m.self, ctx->pou, ctx->instance};
  ctx->pou = number;
  ctx->instance = instance;
  m.frame += m.pc->a * 8u;
  m.self = self;
  m.pc = callee.entry;
  if (--ctx->fuel != 0) [[likely]]
    return Flow::kAway;
  m.pc = callee.code;
  return Flow::kSuspended;
}
template <>
struct Semantics<ir::Opcode::CALL> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, NoValue&) {
    return enter(m, m.pc->c, 0, m.self, 1);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_OWN> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, NoValue&) {
    return enter(m, m.pc->c, m.ctx->instance, m.self, 1);
  }
};

// A row without data is free; the globals' row is made so as well.
#define STC_FIND_INSTANCE(slot)                                                     \
  const auto id = load<uint32_t>(slot);                                             \
  if (id >= m.ctx->instance_count || m.ctx->instances[id].data == 0) [[unlikely]] { \
    return trap(m, ir::TrapKind::kInstance, id);                                    \
  }                                                                                 \
  const InstanceEntry& entry = m.ctx->instances[id]

template <>
struct Semantics<ir::Opcode::INST> : Stepwise<uint32_t> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    STC_FIND_INSTANCE(o.place_b(m.pc->bc()));
    result = entry.data;
    m.pc += 1;
    return Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::INST_AT> : Stepwise<uint32_t> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, uint32_t& result) {
    STC_FIND_INSTANCE(m.mem + o.template b<uint32_t>() + m.pc->c);
    result = entry.data;
    m.pc += 1;
    return Flow::kOn;
  }
};
template <>
struct Semantics<ir::Opcode::CALL_INST> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    STC_FIND_INSTANCE(o.place_b(m.pc->bc()));
    return enter(m, entry.pou, id, m.mem + entry.data, 1);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_INST_AT> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    STC_FIND_INSTANCE(m.mem + o.template b<uint32_t>() + m.pc->c);
    return enter(m, entry.pou, id, m.mem + entry.data, 1);
  }
};
// x is a type number: Generation::build has put it there.
template <>
struct Semantics<ir::Opcode::CALL_REF> : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    const uint32_t id = find_instance(m.ctx, o.template b<uint64_t>(), m.pc[1].x());
    if (id == 0) [[unlikely]]
      return trap(m, ir::TrapKind::kReference);
    const InstanceEntry& entry = m.ctx->instances[id];
    return enter(m, entry.pou, id, m.mem + entry.data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_METHOD> : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    STC_FIND_INSTANCE(o.place_b(m.pc->bc()));
    return enter(m, m.pc[1].x(), id, m.mem + entry.data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_METHOD_AT> : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    STC_FIND_INSTANCE(m.mem + o.template b<uint32_t>() + m.pc->c);
    return enter(m, m.pc[1].x(), id, m.mem + entry.data, 2);
  }
};
// y is the type that the method is of: Generation::build has put it there.
template <>
struct Semantics<ir::Opcode::CALL_METHOD_REF> : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    const uint32_t id = find_instance(m.ctx, o.template b<uint64_t>(), m.pc[1].y());
    if (id == 0) [[unlikely]]
      return trap(m, ir::TrapKind::kReference);
    return enter(m, m.pc[1].x(), id, m.mem + m.ctx->instances[id].data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::CALL_VIRTUAL> : Stepwise<void, 2> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    const VirtualCallee found = find_target(m.ctx, o.template b<uint64_t>(), m.pc[1].x());
    if (found.instance == 0) [[unlikely]]
      return trap(m, ir::TrapKind::kReference);
    return enter(m, found.pou, found.instance, m.mem + m.ctx->instances[found.instance].data, 2);
  }
};
template <>
struct Semantics<ir::Opcode::RET> : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O&, Machine& m, NoValue&) {
    Context* const ctx = m.ctx;
    if (ctx->call == ctx->exposed) [[unlikely]]
      drop_exposed(*ctx, static_cast<uint32_t>(ctx->call - ctx->calls_begin));
    if (ctx->call == ctx->calls_begin) return Flow::kDone;
    const CallRecord& caller = *--ctx->call;
    ctx->pou = caller.pou;
    ctx->instance = caller.instance;
    m.pc = caller.resume;
    m.frame = caller.frame;
    m.self = caller.self;
    return Flow::kAway;
  }
};

}  // namespace vm
