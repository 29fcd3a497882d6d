// EN and ENO, which every function and function block has (IEC 61131-3, 6.6.1.5): with EN
// FALSE nothing is called, ENO is FALSE, outputs keep what they had, and a function's
// result is the default of its type. The same when the call, or an argument of it, traps and ENO is
// connected. Who declares parameters of these names has them.
#include "frontend/lower/body.h"
#include "frontend/sema/calls.h"

namespace frontend {

std::optional<Enable> Body::enable_of(const Expr& call, const Callee& callee) {
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

void Body::open_enable(Enable& enable) {
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
  enter_try(enable.handler, {}, enable.eno->span);
  body_.flow.tries.back().eno = true;
}

void Body::store_eno(const Enable& enable, bool good) {
  if (!enable.target) return;
  bool bit = good != enable.eno->negated;
  store(*enable.target, build_.constant(ir::Scalar::kBool, bit ? 1 : 0));
}

void Body::close_enable(Enable& enable, ir::ValueList result, ir::TypeId type, uint64_t otherwise) {
  if (enable.handler.valid()) {
    ir::BlockId good = build_.new_block();
    build_.end_try(good);
    leave_try();
    build_.start(good);
  }
  store_eno(enable, true);
  build_.jump(enable.done, std::move(result));
  for (ir::BlockId failed : {enable.skip, enable.handler}) {
    if (!failed.valid()) continue;
    build_.start(failed);
    store_eno(enable, false);
    ir::ValueList result_then;
    if (type.valid()) result_then.push_back(build_.constant(scalar(type), otherwise));
    build_.jump(enable.done, std::move(result_then));
  }
  build_.start(enable.done);
}

uint64_t Body::default_bits(ir::TypeId type) const {
  ir::ConstId init;
  for (ir::TypeId at = type; !init.valid() && at.valid(); at = types()[at].base) {
    init = types()[at].init;
  }
  return init.valid() ? sema_.program.constants[init].bits : 0;
}

ir::ValueId Body::emit_call(const Expr& expr, ir::TypeId own) {
  Callee callee = ask<Calls>().callee(expr);
  auto enable = enable_of(expr, callee);
  if (!enable) return emit_call(expr, callee, own);
  open_enable(*enable);
  ir::ValueId result = build_.add_param(enable->done, scalar(own));
  ir::ValueId value = emit_call(expr, callee, own);
  uint64_t otherwise = default_bits(own);
  if (callee.kind == Callee::Kind::kFunction && sema_.declared.pous[callee.pou].result.valid()) {
    const Variable& declared = resolve(sema_.declared.pous[callee.pou].result);
    otherwise = declared.init.valid() ? sema_.program.constants[declared.init].bits
                                      : default_bits(declared.type);
  }
  close_enable(*enable, {value}, own, otherwise);
  return result;
}

// A result that is no scalar.
ir::Place Body::call_place(ExprId id, const Expr& expr) {
  ir::TypeId type = infer(id).type;
  Callee callee = ask<Calls>().callee(expr);
  auto enable = enable_of(expr, callee);
  if (!enable) return call_place(expr, callee, type);
  ir::Place result = temporary_place(type);
  build_.init(result, {});
  open_enable(*enable);
  build_.copy(result, call_place(expr, callee, type));
  close_enable(*enable, {}, {});
  return result;
}

void Body::call_statement(const Stmt& stmt) {
  const Expr& call = tree_[stmt.value];
  if (call.kind != ExprKind::kCall) return bare_call(stmt.value);
  Callee callee = ask<Calls>().callee(call);
  auto enable = enable_of(call, callee);
  if (!enable) return call_statement(stmt.value, callee);
  open_enable(*enable);
  call_statement(stmt.value, callee);
  close_enable(*enable, {}, {});
}

}  // namespace frontend
