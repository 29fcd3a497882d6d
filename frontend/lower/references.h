// Phase: pointers, references and interfaces in bodies, by the shapes of "References" in
// ir/program/ir.h (reference.cc, distance.cc), and assignments that depend on what an instance is
// (type_test.cc).
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"
#include "frontend/lower/handles.h"

namespace frontend {

class References : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  ir::Place dereferenced_place(const Expr& expr);
  ir::ValueId index_of_elements(ir::ValueId index, ir::Scalar from);
  ir::Place addressable_place(ExprId id);
  ir::ValueId handle_of(ExprId id);
  ir::ValueId raw_reference(ExprId id);
  ir::ValueId reference_value(ExprId id, ir::TypeId target);
  void bind_reference(const Stmt& stmt);
  ir::ValueId interface_value(ExprId id, ir::TypeId target);
  ir::ValueId constant_reference(ExprId id);
  // Warns of a number that goes into a pointer, but has too few bits for one.
  void check_address(ir::TypeId number, base::SourceSpan span);
  ir::ValueId convert_reference(Typed from, ir::TypeId to, base::SourceSpan span);
  // distance.cc
  bool is_distance(ExprId id);
  ir::ValueId distance(ExprId id, ir::TypeId target, base::SourceSpan span);
  ir::TypeId compared_distance(ExprId distance, ExprId other);
  bool is_of_two_pointers(ExprId id, ir::TypeId target);
  ir::ValueId emit_reference_call(const Expr& expr, ReferenceCall call, ir::TypeId own);
  ir::ValueId emit_pointer_arithmetic(BinaryOp op, ExprId left, ExprId right, ir::TypeId own);
  Attempt attempt(ExprId left, ExprId right, base::SourceSpan span);

 private:
  ir::ValueId holds_address(ir::ValueId number);
  ir::ValueId flat_number(Typed number);
  MovedPointer moved_pointer(BinaryOp op, ExprId left, ExprId right);
  MovedPointer pointer_of_sum(ExprId id);
  std::optional<ir::ValueId> object_handle(ExprId id);
};

}  // namespace frontend
