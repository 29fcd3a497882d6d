// Phase: binary operators, and the types in which their operands meet (infer_operators.cc,
// infer_reference.cc). Reads expressions; writes messages only.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class OperatorTypes : public Phase {
 public:
  using Phase::Phase;

  // Type of the operands of a binary operator that have to agree.
  Note unify(const Note& a, const Note& b, base::SourceSpan span);
  Note unify_arguments(const std::vector<ExprId>& args, uint32_t first);
  // Type in which all arguments meet.
  Note infer_common(const std::vector<ExprId>& args) { return unify_arguments(args, 0); }
  Note infer_binary(const Expr& expr);
  Note infer_arithmetic(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  Note infer_bitwise(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  Note infer_comparison(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  bool reference_fits(ir::TypeId from, ir::TypeId to) const;

 private:
  Note infer_time_arithmetic(BinaryOp op, const Note& left, const Note& right,
                             base::SourceSpan span);
  Note infer_pointer_arithmetic(BinaryOp op, const Note& left, const Note& right,
                                base::SourceSpan span);
  ir::TypeId common_reference(const Note& a, const Note& b);
  // The message.
  void report_not_defined(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
};

}  // namespace frontend
