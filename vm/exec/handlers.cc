// The table of all handlers. They are instantiated in handle_*.cc and fused_*.cc; an
// opcode that none of those gives a meaning fails to link.
#include <utility>

#include "vm/exec/context.h"
#include "vm/exec/fusion.h"
#include "vm/exec/handler_numbers.h"

namespace vm {

template <ir::Opcode op, ir::Base A, ir::Base B, ir::Base C>
void handle(STC_HANDLER_ARGS);
template <class... S>
void fused(STC_HANDLER_ARGS);
void resume_native(STC_HANDLER_ARGS);
void stop_helper(STC_HANDLER_ARGS);
void go_aside(STC_HANDLER_ARGS);
void restore_forced(STC_HANDLER_ARGS);
void take_truth_tables(STC_HANDLER_ARGS);

namespace {

template <ir::Opcode op, uint32_t... i>
constexpr void fill_opcode(Handler* table, std::integer_sequence<uint32_t, i...>) {
  ((table[kFirstHandler[static_cast<uint32_t>(op)] + i] =
        &handle<op, base_of_a(op, i), base_of_b(op, i), base_of_c(op, i)>),
   ...);
}

}  // namespace

namespace fusion_rows {

constexpr void fill([[maybe_unused]] HandlerTable& table) {
  [[maybe_unused]] uint32_t next = kFirstFused;
#define FUSION(part, ...) table.of[next++] = &fused<__VA_ARGS__>;
#include "vm/exec/fusions.def"
#undef FUSION
}

}  // namespace fusion_rows

namespace {

constexpr HandlerTable all_handlers() {
  HandlerTable table{};
  table.of[kResumeHandler] = &resume_native;
  table.of[kStopHandler] = &stop_helper;
  table.of[kAsideHandler] = &go_aside;
  table.of[kRestoreHandler] = &restore_forced;
  table.of[kTruthTables] = &take_truth_tables;
#define OP(name, a, b, c, x, y, flags, meaning) \
  fill_opcode<ir::Opcode::name>(                \
      table.of, std::make_integer_sequence<     \
                    uint32_t, kBaseCounts[static_cast<uint32_t>(ir::Opcode::name)].product()>());
#include "ir/bytecode/opcodes.def"
#undef OP
  fusion_rows::fill(table);
  return table;
}

}  // namespace

constinit const HandlerTable kHandlers = all_handlers();

}  // namespace vm
