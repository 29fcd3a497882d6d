// Phase: assignments, as statements and as expressions (assignment.cc). It reads facts, reports
// what does not fit, and writes the code that evaluates the left side's indices, then the value.
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"

namespace frontend {

class Assignments : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void assign(const Stmt& stmt);
  std::optional<Target> assign_value(ExprId left, ExprId right, base::SourceSpan span);
  bool refuse_copy(ir::TypeId type, base::SourceSpan span);
  void assign_aggregate(const Target& target, ExprId value);
  // copy_instance.cc: all that an instance, or a value with instances inside, holds.
  void copy_held(const ir::Place& to, const ir::Place& from, ir::TypeId type);
  ir::ValueId emit_assignment(const Expr& expr);
  ir::Place assignment_place(ExprId id, const Expr& expr);

 private:
  void copy_parts(const ir::Place& to, const ir::Place& from, ir::TypeId id);
  void allow_set_or_reset(base::SourceSpan span);
  ir::ValueId set_or_reset(AssignOp op, ExprId left, ExprId right, base::SourceSpan span);
  std::vector<ir::TypeId> copied_;  // what copy_held() is in the middle of
};

}  // namespace frontend
