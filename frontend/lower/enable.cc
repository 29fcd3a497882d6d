// EN and ENO, which every function and function block has (IEC 61131-3, 6.6.1.5): with EN
// FALSE nothing is called, ENO is FALSE, outputs keep what they had, and a function's
// result is the default of its type. The same when the call, or an argument of it, traps and ENO is
// connected. Who declares parameters of these names has them.
#include "frontend/lower/enable.h"
#include "frontend/lower/try_code.h"
#include "frontend/sema/calls/calls.h"

namespace frontend {

std::optional<Enable> EnableCode::enable_of(const Expr& call, const Callee& callee) {
  const PouInfo* pou = callee.pou == kNoPou ? nullptr : &sema_.declared.pous[callee.pou];
  Enable enable;
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = tree_.args[call.list.first + i];
    if (!ask<Calls>().is_enable(arg, pou)) continue;
    const Arg*& slot = ir::same_name(arg.name.text, "EN") ? enable.en : enable.eno;
    bool output = &slot == &enable.eno;
    if (arg.output != output || slot != nullptr || (arg.negated && !output)) {
      error(DiagnosticCode::kBadEnable, arg.span, output ? "ENO is an output" : "EN is an input",
            output ? "write `ENO => variable`, once" : "write `EN := condition`, once");
      return std::nullopt;
    }
    if (arg.value.valid()) slot = &arg;
  }
  if (enable.en == nullptr && enable.eno == nullptr) return std::nullopt;
  return enable;
}

void EnableCode::open_enable(Enable& enable) {
  ir::TypeId boolean = elementary(ir::Kind::kBool);
  enable.done = build_.new_block();
  if (enable.eno != nullptr) {
    enable.target = target(enable.eno->value);
    if (enable.target && !traits_of(types(), enable.target->type).boolean) {
      error(DiagnosticCode::kBadEnable, enable.eno->span,
            "ENO is BOOL, its target is `" + sema_.report.type_text(enable.target->type) + "`");
      enable.target.reset();
    }
  }
  if (enable.en != nullptr) {
    enable.skip = build_.new_block();
    ir::BlockId run = build_.new_block();
    build_.branch(value(enable.en->value, boolean), run, enable.skip);
    build_.start(run);
  }
  if (enable.eno == nullptr) return;
  enable.handler = build_.new_block();
  ask<TryCode>().enter_try(enable.handler, {}, enable.eno->span);
  body_.flow.tries.back().eno = true;
}

void EnableCode::store_eno(const Enable& enable, bool good) {
  if (!enable.target) return;
  bool bit = good != enable.eno->negated;
  store(*enable.target, build_.constant(ir::Scalar::kBool, bit ? 1 : 0));
}

void EnableCode::close_enable(Enable& enable, ir::ValueList result, ir::TypeId type,
                              uint64_t otherwise) {
  if (enable.handler.valid()) {
    ir::BlockId good = build_.new_block();
    build_.end_try(good);
    ask<TryCode>().leave_try();
    build_.start(good);
  }
  store_eno(enable, true);
  build_.jump(enable.done, std::move(result));
  for (ir::BlockId failed : {enable.skip, enable.handler}) {
    if (!failed.valid()) continue;
    build_.start(failed);
    if (failed == enable.handler) ask<TryCode>().pass_assertions_on();
    store_eno(enable, false);
    ir::ValueList result_then;
    if (type.valid()) result_then.push_back(build_.constant(scalar(type), otherwise));
    build_.jump(enable.done, std::move(result_then));
  }
  build_.start(enable.done);
}

uint64_t EnableCode::default_bits(ir::TypeId type) const {
  ir::ConstId init;
  for (ir::TypeId at = type; !init.valid() && at.valid(); at = types()[at].base) {
    init = types()[at].init;
  }
  return init.valid() ? sema_.program.constants[init].bits : 0;
}

}  // namespace frontend
