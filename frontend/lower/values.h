// Phase: the values of expressions (value.cc, operator.cc, width.cc, character.cc). It reads facts,
// folds what is constant, and writes the code that computes the rest.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class Values : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  // The scalar value of `expr` as `target`, converted and checked.
  ir::ValueId value(ExprId expr, ir::TypeId target);
  Typed natural(ExprId expr);  // in its own type; literals take their default type
  ir::ValueId condition(ExprId expr);
  ir::ValueId emit(ExprId expr, ir::TypeId own);
  ir::ValueId loaded(ExprId expr);  // what stands at its place
  ir::ValueId computed_in(ExprId id, ir::TypeId type);
  ir::TypeId own_type(ExprId id, ir::TypeId target);
  ir::ValueId emit_arithmetic(BinaryOp op, ExprId left, ExprId right, ir::TypeId own);

 private:
  ir::ValueId stored(ExprId sum, ir::TypeId target);  // width.cc: an intermediate result
  ir::ValueId emit_bit(ExprId id);
  ir::ValueId emit_character(const Expr& expr);
  ir::ValueId emit_unary(const Expr& expr, ir::TypeId own);
  ir::ValueId emit_binary(const Expr& expr, ir::TypeId own);
  ir::ValueId emit_lazy(const Expr& expr);
  ir::ValueId emit_comparison(BinaryOp op, ExprId left, ExprId right);
  ir::ValueId compare_strings(BinaryOp op, ExprId left, ExprId right);
};

}  // namespace frontend
