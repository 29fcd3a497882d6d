// The table of all handlers. They are instantiated in handle_*.cc; an opcode that
// none of those gives a meaning fails to link.
#include <utility>

#include "vm/exec/context.h"
#include "vm/exec/handler_numbers.h"

namespace vm {

template <ir::Opcode op, ir::Base A, ir::Base B, ir::Base C>
void handle(STC_HANDLER_ARGS);
void resume_native(STC_HANDLER_ARGS);
void stop_helper(STC_HANDLER_ARGS);

namespace {

template <ir::Opcode op, uint32_t... i>
constexpr void fill_opcode(HandlerTable& table, std::integer_sequence<uint32_t, i...>) {
  ((table.of[kFirstHandler[static_cast<uint32_t>(op)] + i] =
        &handle<op, base_of_a(op, i), base_of_b(op, i), base_of_c(op, i)>),
   ...);
}

constexpr HandlerTable all_handlers() {
  HandlerTable table{};
  table.of[kResumeHandler] = &resume_native;
  table.of[kStopHandler] = &stop_helper;
#define OP(name, a, b, c, x, y, flags, meaning) \
  fill_opcode<ir::Opcode::name>(                \
      table, std::make_integer_sequence<        \
                 uint32_t, kBaseCounts[static_cast<uint32_t>(ir::Opcode::name)].product()>());
#include "ir/bytecode/opcodes.def"
#undef OP
  return table;
}

}  // namespace

constinit const HandlerTable kHandlers = all_handlers();

}  // namespace vm
