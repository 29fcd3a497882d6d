// Instruction lists: jumps, labels, calls and returns, with and without a condition.
#include "frontend/parse/instruction_list.h"

namespace frontend {

// What arrives at a label that uses the current result comes from above: from the instruction
// before or from jumps. They give the result its type; jumps from below have to keep to it.
void Parser::InstructionList::label(size_t i) {
  const Instruction& in = list_[i];
  Label* found = find_label(in.word);
  bool needed = needed_behind(i);
  bool undefined = reachable_ && needed && result_.state == Result::State::kNone;
  const char* why = result_.why;
  if (reachable_ && needed && !undefined) {
    std::vector<Stmt> pass;
    pass_to(in, in.word, true, pass);
    for (const Stmt& stmt : pass) emit(stmt);
  } else {
    discard();
  }
  Stmt stmt;
  stmt.kind = StmtKind::kLabel;
  stmt.name = tree_.add_name(in.word);
  stmt.span = in.span;
  emit(stmt);
  reachable_ = true;
  if (found->index != i) return damage(in.span);  // stands twice: reported with the labels
  found->passed = true;
  if (!needed || undefined) return undefine(needed ? why : "the label did not need it");
  if (!found->result.valid()) return undefine("jumps from below only lead to this label");
  p_.set_values(found->result, found->ways);
  result_ = {Result::State::kKept, false, found->result, ""};
}

// Adds the assignment that takes the current result along to a label, when that uses it.
void Parser::InstructionList::pass_to(const Instruction& in, const Name& name, bool last,
                                      std::vector<Stmt>& out) {
  Label* target = find_label(name);
  if (target == nullptr || needs_[target->index] != Need::kYes) return;
  ExprId value = use(in, last);
  if (target->passed && !target->result.valid()) return;  // was reported there
  if (!target->result.valid()) target->result = p_.add_result(tree_[value].span, true);
  if (!target->passed) target->ways.push_back(value);
  Stmt assign = keep_statement(target->result, value);
  assign.span = in.span;
  out.push_back(assign);
}

void Parser::InstructionList::jump(size_t i) {
  const Instruction& in = list_[i];
  Stmt stmt;
  stmt.kind = StmtKind::kJump;
  stmt.name = tree_.add_name(in.target);
  stmt.span = in.span;
  stmt.instruction = true;
  std::vector<Stmt> body;
  if (in.op->conditional) {
    const Label* target = find_label(in.target);
    bool taken_along = target != nullptr && needs_[target->index] == Need::kYes;
    bool last = !needed_behind(i) && !taken_along;
    ExprId condition = use(in, last);
    if (taken_along) pass_to(in, in.target, false, body);
    body.push_back(stmt);
    return guard(in, condition, body);
  }
  pass_to(in, in.target, true, body);
  discard();
  body.push_back(stmt);
  for (const Stmt& each : body) emit(each);
  undefine("JMP stands in front of it");
  reachable_ = false;
}

void Parser::InstructionList::leave(size_t i) {
  const Instruction& in = list_[i];
  Stmt stmt;
  stmt.kind = StmtKind::kReturn;
  stmt.span = in.span;
  if (in.op->conditional) return guard(in, use(in, !needed_behind(i)), {stmt});
  discard();
  emit(stmt);
  undefine("RET stands in front of it");
  reachable_ = false;
}

void Parser::InstructionList::call(size_t i) {
  const Instruction& in = list_[i];
  Stmt stmt;
  stmt.kind = StmtKind::kCall;
  stmt.value = in.operand;
  stmt.span = in.span;
  if (in.op->conditional) {
    guard(in, use(in, true), {stmt});
  } else {
    discard();
    emit(stmt);
  }
  undefine("a call of a function block leaves none");
}

// IF condition THEN body END_IF
void Parser::InstructionList::guard(const Instruction& in, ExprId condition,
                                    const std::vector<Stmt>& body) {
  keep_outer();
  size_t mark = p_.statement_stack_.size();
  for (const Stmt& stmt : body) p_.add_statement(stmt);
  Branch branch;
  branch.condition = in.op->negated ? p_.negated(condition, in.span) : condition;
  branch.body = move_tail(p_.statement_stack_, mark, tree_.stmt_lists);
  Stmt stmt;
  stmt.kind = StmtKind::kIf;
  stmt.span = in.span;
  stmt.arms = {static_cast<uint32_t>(tree_.branches.size()), 1};
  tree_.branches.push_back(branch);
  emit(stmt);
}

}  // namespace frontend
