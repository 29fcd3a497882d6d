// The current result of an instruction list: an expression, a kResult, or nothing.
#include "frontend/parse/instruction_list.h"
#include "ir/types/types.h"

namespace frontend {

// The current result for `in`. Unless it is the `last` one to use it, it is kept.
ExprId Parser::InstructionList::use(const Instruction& in, bool last) {
  if (result_.state == Result::State::kNone) {
    p_.note_only(Code::kNoCurrentResult, in.word.span,
                 "`" + std::string(in.word.text) +
                     "` needs a current result, and there is none: " + result_.why,
                 "load one with LD");
    damage(in.word.span);
  }
  if (!last) keep_result();
  ExprId value = result_.value;
  if (result_.state == Result::State::kKept) return p_.copy_of(value, in.word.span);
  if (last) undefine("it was used up");
  return value;
}

void Parser::InstructionList::define(ExprId value, bool literal) {
  result_ = {Result::State::kValue, literal, value, ""};
  if (p_.height(value) > kHighest && !value_only_) keep_result();
}

// Something was reported; what works on it says nothing more.
void Parser::InstructionList::damage(base::SourceSpan span) {
  Expr error;
  error.span = span;
  result_ = {Result::State::kKept, false, p_.add_expression(error), ""};
}

// Nobody needs the current result. It is computed nevertheless: it may trap, call, or be wrong.
void Parser::InstructionList::discard() {
  if (result_.state != Result::State::kValue || result_.literal || value_only_) return;
  if (tree_[result_.value].kind != ExprKind::kCall) return keep_result();
  Stmt call;
  call.kind = StmtKind::kCall;
  call.value = result_.value;
  call.span = tree_[result_.value].span;
  result_.state = Result::State::kNone;
  emit(call);
}

void Parser::InstructionList::keep(Result& result) {
  if (result.state != Result::State::kValue || result.literal) return;
  ExprId kept = p_.add_result(tree_[result.value].span, false);
  p_.set_values(kept, {result.value});
  p_.add_statement(keep_statement(kept, result.value));
  result.state = Result::State::kKept;
  result.value = kept;
}

void Parser::InstructionList::keep_result() {
  if (result_.state != Result::State::kValue || result_.literal) return;
  keep_outer();
  keep(result_);
}

// What stands in front of open parentheses was computed before what follows.
void Parser::InstructionList::keep_outer() {
  while (kept_outer_ < outer_.size()) {
    keep(outer_[kept_outer_++]);
  }
}

void Parser::InstructionList::emit(Stmt stmt) {
  keep_outer();
  stmt.instruction = true;
  p_.add_statement(stmt);
}

Stmt Parser::InstructionList::keep_statement(ExprId result, ExprId value) {
  Stmt assign;
  assign.kind = StmtKind::kAssign;
  assign.span = tree_[value].span;
  assign.target = p_.copy_of(result, assign.span);
  assign.value = value;
  assign.instruction = true;
  return assign;
}

bool Parser::InstructionList::is_literal(ExprId id) const {
  const Expr& expr = tree_[id];
  if (expr.kind == ExprKind::kUnary) return is_literal(expr.operand);
  bool null = expr.kind == ExprKind::kName && ir::same_name(expr.name.text, "NULL");
  return expr.kind == ExprKind::kLiteral || null;
}

// A variable that is found without computing anything.
bool Parser::InstructionList::is_plain(ExprId id) const {
  while (tree_[id].kind == ExprKind::kMember) id = tree_[id].operand;
  return tree_[id].kind == ExprKind::kName || tree_[id].kind == ExprKind::kDirect;
}

}  // namespace frontend
