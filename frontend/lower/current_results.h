// Phase: the current result of an instruction list (result.cc). Within straight code it is a value,
// at a label a local that every way there assigns. It keeps both in the body (Lowering).
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class CurrentResults : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void infer_results(Range32 list);
  void keep_result(const Stmt& stmt);
  ir::ValueId emit_result(ExprId id);
  ir::Place result_place(const Expr& expr, ir::TypeId type);
};

}  // namespace frontend
