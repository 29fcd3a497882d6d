// Phase: the type of an expression from the inside out, before its context has spoken, and what
// else is known of it (infer.cc, infer_access.cc, infer_reference.cc, infer_result.cc). Reads
// declarations; writes Sema::facts, once for each expression and scope. Phase::infer() asks it.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Expressions : public Phase {
 public:
  using Phase::Phase;

  // infer*.cc
  const Note& infer_now(ExprId id, Note& note);
  Note infer_literal(const Expr& expr);
  Note variable_note(VarId id);
  // Has the value that an instruction list keeps the type of its result? (infer_result.cc)
  bool check_result(const Stmt& assignment);

 private:
  Note infer_kind(ExprId id, const Expr& expr);
  Note infer_name(const Expr& expr);
  std::optional<Note> infer_list_member(const Expr& expr);
  Note infer_enum_name(const Expr& expr);
  Note infer_qualified(const Expr& expr);
  Note infer_literal_of(std::string_view type, base::SourceSpan span, const Name& wanted);
  Note infer_member(const Expr& expr);
  Note infer_bit(const Expr& expr);
  bool check_part(ir::TypeId whole, uint32_t number, uint8_t size, base::SourceSpan span);
  Note part_note(const Note& whole, uint32_t number, uint8_t size) const;
  std::string_view enumeration_named(const Expr& head);
  bool refuse_any_part(const Expr& expr, const Note& operand);
  std::optional<Note> infer_named_bit(const Expr& expr, const Note& operand);
  Note infer_index(const Expr& expr);
  Note infer_pointer_index(const Expr& expr, const Note& operand);
  Note infer_assign(const Expr& expr);
  Note infer_result(const Expr& expr);
  Note infer_unary(const Expr& expr);
  Note infer_character(const Expr& expr, Note note);
  void check_index_list(const Expr& expr, const ir::Type& array);
  // infer_reference.cc
  Note infer_deref(const Expr& expr);
};

}  // namespace frontend
