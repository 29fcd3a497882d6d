// Phase: calls, as values, as places and as statements, with EN and ENO around them (call.cc).
// It asks sema what is called (sema/calls/calls.h), notes the callee (PouInfo::callees), and
// leaves the rest to arguments, methods, standard functions and tests.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class CallCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  ir::ValueId emit_call(const Expr& expr, ir::TypeId own);
  ir::ValueId emit_call(const Expr& expr, const Callee& callee, ir::TypeId own);
  ir::Place call_place(ExprId id, const Expr& expr);
  ir::Place call_place(const Expr& expr, const Callee& callee, ir::TypeId type);
  void call_statement(const Stmt& stmt);
  void call_statement(ExprId id, const Callee& callee);
  CallResult call_function(const Expr& call, const Callee& callee, bool wants_result);

 private:
  void call_instance(const Expr& call, uint32_t pou);
  void call_base(const Expr& call, uint32_t pou);
  void warn_about_use(const Expr& call, const PouInfo& callee);
  void check_result_use(const Expr& call);
  ir::ValueId emit_bound(const Expr& call, bool upper);
};

}  // namespace frontend
