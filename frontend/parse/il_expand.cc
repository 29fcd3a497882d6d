// Instruction lists: instructions -> statements.
#include <algorithm>

#include "frontend/parse/instruction_list.h"

namespace frontend {

void Parser::InstructionList::expand() {
  find_needs();
  for (size_t i = 0; i < list_.size(); ++i) expand(i);
  if (!value_only_) discard();
}

void Parser::InstructionList::expand(size_t i) {
  const Instruction& in = list_[i];
  switch (in.kind) {
    case Kind::kOperator:
      return expand_operator(i);
    case Kind::kOpen:
      if (result_.state == Result::State::kNone) use(in, false);
      outer_.push_back(result_);
      opens_.push_back(i);
      return undefine("nothing is loaded yet after the parenthesis");
    case Kind::kClose:
      return close(i);
    case Kind::kFunction:
      return call_function(i);
    case Kind::kCall:
      discard();
      return define(in.operand, false);
    case Kind::kLabel:
      return label(i);
    case Kind::kDamaged:
      discard();
      return damage(in.span);
  }
}

void Parser::InstructionList::expand_operator(size_t i) {
  const Instruction& in = list_[i];
  bool last = !needed_behind(i);
  switch (in.op->action) {
    case IlAction::kLoad: {
      discard();
      bool literal = is_literal(in.operand);
      return define(in.op->negated ? p_.negated(in.operand, in.span) : in.operand, literal);
    }
    case IlAction::kStore:
      return store(in, last);
    case IlAction::kSet:
      return set(in, last);
    case IlAction::kInput:
    case IlAction::kValue:
      return input(in, last);
    case IlAction::kBinary: {
      bool literal = result_.literal && is_literal(in.operand);
      ExprId left = use(in, true);
      ExprId right = in.op->negated ? p_.negated(in.operand, in.span) : in.operand;
      return apply(in, left, right, literal);
    }
    case IlAction::kNot: {
      bool literal = result_.literal;
      return define(p_.negated(use(in, true), in.span), literal);
    }
    case IlAction::kJump:
      return jump(i);
    case IlAction::kCall:
      return call(i);
    case IlAction::kReturn:
      return leave(i);
  }
}

// The value is computed before the place where it goes.
void Parser::InstructionList::store(const Instruction& in, bool last) {
  if (!is_plain(in.operand)) keep_result();
  ExprId value = use(in, last);
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.target = in.operand;
  stmt.value = in.op->negated ? p_.negated(value, in.span) : value;
  stmt.span = in.span;
  emit(stmt);
}

// S x, R x: of a BOOL. When x is an instance, S and R are its inputs.
void Parser::InstructionList::set(const Instruction& in, bool last) {
  if (!is_plain(in.operand)) keep_result();
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.assign = in.word.text == "S" || in.word.text == "s" ? AssignOp::kSet : AssignOp::kReset;
  stmt.target = in.operand;
  stmt.value = use(in, last);
  stmt.span = in.span;
  stmt.from = input_call(in, stmt.value);
  emit(stmt);
}

// instance(CU := result): the block runs. PT and PV only wait for it.
void Parser::InstructionList::input(const Instruction& in, bool last) {
  ExprId value = use(in, last);
  Stmt stmt;
  stmt.span = in.span;
  if (in.op->action == IlAction::kInput) {
    stmt.kind = StmtKind::kCall;
    stmt.value = input_call(in, value);
    return emit(stmt);
  }
  Expr member;
  member.kind = ExprKind::kMember;
  member.operand = in.operand;
  member.name = in.word;
  member.op = in.span.begin;
  member.span = in.span;
  stmt.kind = StmtKind::kAssign;
  stmt.target = p_.add_expression(member);
  stmt.value = value;
  emit(stmt);
}

ExprId Parser::InstructionList::input_call(const Instruction& in, ExprId value) {
  Arg arg;
  arg.name = in.word;
  arg.value = value;
  arg.span = in.span;
  Expr expr;
  expr.kind = ExprKind::kCall;
  expr.operand = in.operand;
  expr.op = in.span.begin;
  expr.span = in.span;
  expr.list = {static_cast<uint32_t>(tree_.args.size()), 1};
  tree_.args.push_back(arg);
  return p_.add_expression(expr);
}

void Parser::InstructionList::apply(const Instruction& in, ExprId left, ExprId right,
                                    bool literal) {
  Expr expr;
  expr.kind = ExprKind::kBinary;
  expr.binary = in.op->binary;
  expr.operand = left;
  expr.right = right;
  expr.op = in.word.span.begin;
  expr.span = in.span;
  expr.instruction = true;
  define(p_.add_expression(expr), literal);
}

void Parser::InstructionList::close(size_t i) {
  ExprId right = use(list_[i], true);
  const Instruction& open = list_[opens_.back()];
  if (open.op->negated) right = p_.negated(right, open.span);
  result_ = outer_.back();
  outer_.pop_back();
  opens_.pop_back();
  kept_outer_ = std::min(kept_outer_, outer_.size());
  ExprId left = use(open, true);
  apply(open, left, right, false);
}

// The current result is the first argument.
void Parser::InstructionList::call_function(size_t i) {
  const Instruction& in = list_[i];
  const IlOperator* meant = similar_il_operator(in.word.text);
  if (result_.state == Result::State::kNone && meant != nullptr) {
    p_.note_only(Code::kBadInstruction, in.word.span,
                 "there is no operator `" + std::string(in.word.text) + "`",
                 "did you mean `" + std::string(meant->word) + "`?");
    return damage(in.span);
  }
  Expr name;
  if (in.operand.valid()) {
    name = tree_[in.operand];
  } else {
    name.kind = ExprKind::kName;
    name.name = in.word;
    name.span = in.word.span;
  }
  name.instruction = true;
  Expr call;
  call.kind = ExprKind::kCall;
  call.instruction = true;
  call.op = in.span.begin;
  call.span = in.span;
  Arg arg;
  arg.value = use(in, true);
  arg.span = in.word.span;
  call.operand = p_.add_expression(name);
  call.list = {static_cast<uint32_t>(tree_.args.size()), in.others.count + 1};
  tree_.args.push_back(arg);
  for (uint32_t k = 0; k < in.others.count; ++k) {
    arg.value = tree_.expr_lists[in.others.first + k];
    arg.span = tree_[arg.value].span;
    tree_.args.push_back(arg);
  }
  define(p_.add_expression(call), false);
}

}  // namespace frontend
