// Phase: what code may write, and what others may be led to (writable.cc). It reads declarations
// and facts, reports what may not be written, and marks variables as written; it writes no code.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class WriteChecks : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  bool has_address(ExprId expr);
  bool check_writable(ExprId expr);

 private:
  bool check_writable_name(const Expr& expr);
  bool check_writable_variable(const Expr& expr, VarId variable);
  bool check_writable_field(const Expr& expr);
  bool is_input_field(const Expr& expr);
};

}  // namespace frontend
