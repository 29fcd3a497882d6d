// Handlers of one instruction. A group (handle_*.cc) includes what its opcodes mean, then
// instantiates their handlers with STC_INSTANTIATE_GROUP.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "vm/exec/handler_numbers.h"
#include "vm/exec/step.h"

namespace vm {

template <ir::Opcode op, ir::Base A, ir::Base B, ir::Base C>
void handle(STC_HANDLER_ARGS) {
  using S = Semantics<op>;
  if constexpr (S::kReads >= 0) {
    Machine m = STC_MACHINE;
    ValueOf<typename S::Result> result;
    constexpr auto kA = static_cast<uint8_t>(A);
    const Flow flow = take_step<op, kA, kA, static_cast<uint8_t>(B), static_cast<uint8_t>(C)>(
        m, std::tuple<>(), result);
    if (stops(flow)) [[unlikely]]
      return leave(m, flow);
    STC_GO(m.pc, m.frame, m.self);
  } else {
    STC_MUST_TAIL return S::template run<A, B, C>(pc, frame, self, mem, consts, ctx);
  }
}

// --- instantiation -------------------------------------------------------------

struct GroupTable {
  Handler of[kHandlerCount];
};

template <class Group, ir::Opcode op, uint32_t... i>
constexpr void add_handlers(GroupTable& table, uint32_t& count,
                            std::integer_sequence<uint32_t, i...>) {
  if constexpr (requires { sizeof(Semantics<op>); }) {
    ((table.of[count++] = &handle<op, base_of_a(op, i), base_of_b(op, i), base_of_c(op, i)>), ...);
  }
}

// Depends on `Group`, a type of the group's own, so that the Semantics are looked for where
// the group ends and not here.
template <class Group>
constexpr GroupTable handlers_of_group() {
  GroupTable table{};
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
  extern const GroupTable name;     \
  constinit const GroupTable name = handlers_of_group<name##Group>()

}  // namespace vm
