// Statements without a file of their own.
#include "frontend/lower/assignments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/case_code.h"
#include "frontend/lower/current_results.h"
#include "frontend/lower/for_code.h"
#include "frontend/lower/mock_code.h"
#include "frontend/lower/rounds.h"
#include "frontend/lower/statements.h"
#include "frontend/lower/try_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/constants/constants.h"

namespace frontend {

void Statements::write(Range32 list) {
  if (body_.flow.labels.empty()) ask<CurrentResults>().infer_results(list);
  body_.flow.labels.push_back({labels_of(list), body_.flow.tries.size()});
  bool warned = false;
  bool was_reachable = build_.reachable();
  for (uint32_t i = 0; i < list.count; ++i) {
    const Stmt& stmt = tree_[tree_.stmt_lists[list.first + i]];
    bool counts = stmt.kind != StmtKind::kEmpty && stmt.kind != StmtKind::kError &&
                  stmt.kind != StmtKind::kLabel;
    if (i > 0 && counts && was_reachable && !build_.reachable() && !warned) {
      warning(DiagnosticCode::kUnreachableCode, stmt.span,
              "nothing gets here: the statement before always leaves");
      warned = true;
    }
    write(stmt);
  }
  body_.flow.labels.pop_back();
}

void Statements::write(const Stmt& stmt) {
  set_line(stmt.span);
  body_.counting.statement(stmt);
  switch (stmt.kind) {
    case StmtKind::kError:
    case StmtKind::kEmpty:
      return;
    case StmtKind::kAssign:
      return ask<Assignments>().assign(stmt);
    case StmtKind::kCall:
      return ask<CallCode>().call_statement(stmt);
    case StmtKind::kIf:
      return if_statement(stmt);
    case StmtKind::kCase:
      return ask<CaseCode>().case_statement(stmt);
    case StmtKind::kFor:
      return ask<ForCode>().for_statement(stmt);
    case StmtKind::kWhile:
      return while_statement(stmt);
    case StmtKind::kRepeat:
      return repeat_statement(stmt);
    case StmtKind::kExit:
    case StmtKind::kContinue:
      return leave_loop(stmt);
    case StmtKind::kReturn:
      return leave();
    case StmtKind::kJump:
      return jump(stmt);
    case StmtKind::kLabel:
      return label(stmt);
    case StmtKind::kTry:
      return ask<TryCode>().try_statement(stmt);
    case StmtKind::kMock:
    case StmtKind::kMockFunction:
      return ask<MockCode>().mock_statement(stmt);
  }
}

ir::ValueId Values::condition(ExprId expr) {
  const Note& note = infer(expr);
  const bool literal = note.flex == Flex::kInteger;  // 0 and 1 are values of BOOL
  if (note.type.valid() && !literal && !traits_of(types(), note.type).boolean) {
    error(DiagnosticCode::kConditionNotBool, tree_[expr].span,
          "the condition is `" + sema_.report.type_text(note.type) + "`", "compare it: `x <> 0`");
    return code_.zero(elementary(ir::Kind::kBool));
  }
  return value(expr, elementary(ir::Kind::kBool));
}

// A function with ARRAY[*] has code for each type of array; bounds are constants in each of them.
bool Statements::differs_by_code(ExprId id) const {
  if (scope_.meaning == nullptr) return false;
  for (;;) {
    const Expr& expr = tree_[id];
    if (expr.kind == ExprKind::kCall) return true;
    const bool binary = expr.kind == ExprKind::kBinary;
    if (!binary && expr.kind != ExprKind::kUnary) return false;
    if (binary && differs_by_code(expr.right)) return true;
    id = expr.operand;
  }
}

void Statements::if_statement(const Stmt& stmt) {
  ir::BlockId done = build_.new_block();
  bool open = false;  // the way past the last condition is still without a target
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    const Branch& branch = tree_.branches[stmt.arms.first + i];
    bool last = i + 1 == stmt.arms.count && stmt.else_body.count == 0;
    const base::SourcePos at = tree_[branch.condition].span.begin;
    ir::BlockId then = build_.new_block();
    ir::BlockId otherwise = last ? done : build_.new_block();
    const Note& note = infer(branch.condition);
    if (note.constant && note.type.valid() && !differs_by_code(branch.condition)) {
      warning(DiagnosticCode::kConditionConstant, tree_[branch.condition].span,
              "this condition is always the same");
    }
    body_.counting.decide(ask<Values>().condition(branch.condition), then, otherwise, at,
                          i == 0 ? "IF" : "ELSIF");
    build_.start(then);
    write(branch.body);
    if (build_.reachable()) build_.jump(done);
    if (!last) build_.start(otherwise);
    open = !last;
  }
  write(stmt.else_body);
  if (open && build_.reachable()) build_.jump(done);
  build_.start(done);
}

// Returns whether anything in it leaves the loop.
bool Statements::loop_body(Range32 body, ir::BlockId again, ir::BlockId exit) {
  body_.flow.loops.push_back({again, exit, body_.flow.tries.size(), false});
  write(body);
  const bool left = body_.flow.loops.back().left;
  body_.flow.loops.pop_back();
  if (build_.reachable()) build_.jump(again);
  return left;
}

void Statements::leave_loops() {
  for (Flow::Loop& loop : body_.flow.loops) loop.left = true;
}

// `goes_on`: the value of the condition with which there is another round.
void Statements::check_end(ExprId condition, bool goes_on) {
  const Note& note = infer(condition);
  const bool literal = note.flex == Flex::kInteger;
  if (!note.constant || !note.type.valid()) return;
  if (!literal && !traits_of(types(), note.type).boolean) return;
  const auto value = ask<Constants>().fold(condition, elementary(ir::Kind::kBool));
  if (!value || (value->integer != 0) != goes_on) return;
  warning(DiagnosticCode::kEndlessLoop, tree_[condition].span,
          std::string("this loop never ends: its condition is always ") +
              (goes_on ? "TRUE" : "FALSE") + ", and nothing in it leaves it",
          "let the condition depend on what the loop changes, or leave it with EXIT");
}

// The loop began with block `first`; `tests` blocks from `test` on compute its condition.
void Statements::check_rounds(ExprId condition, size_t first, size_t test, size_t tests) {
  const Note& note = infer(condition);
  if (note.constant || !note.type.valid()) return;
  const std::span<const ir::BlockId> blocks = build_.blocks();
  if (!is_same_each_round(body_.out, blocks.subspan(test, tests), blocks.subspan(first))) return;
  warning(DiagnosticCode::kEndlessLoop, tree_[condition].span,
          "once this loop goes on it never ends: nothing in it changes its condition",
          "let the condition depend on what the loop changes; inputs change between scans only");
}

void Statements::while_statement(const Stmt& stmt) {
  ir::BlockId head = build_.new_block();
  ir::BlockId body = build_.new_block();
  ir::BlockId exit = build_.new_block();
  build_.jump(head);
  const size_t first = build_.blocks().size();
  build_.start(head);
  body_.counting.decide(ask<Values>().condition(stmt.value), body, exit,
                        tree_[stmt.value].span.begin, "WHILE");
  const size_t behind = build_.blocks().size();
  build_.start(body);
  if (!loop_body(stmt.body, head, exit)) {
    check_end(stmt.value, true);
    check_rounds(stmt.value, first, first, behind - first);
  }
  build_.start(exit);
}

void Statements::repeat_statement(const Stmt& stmt) {
  ir::BlockId body = build_.new_block();
  ir::BlockId test = build_.new_block();
  ir::BlockId exit = build_.new_block();
  build_.jump(body);
  const size_t first = build_.blocks().size();
  build_.start(body);
  const bool left = loop_body(stmt.body, test, exit);
  if (!left) check_end(stmt.value, false);
  const size_t tested = build_.blocks().size();
  build_.start(test);
  body_.counting.decide(ask<Values>().condition(stmt.value), exit, body,
                        tree_[stmt.value].span.begin, "UNTIL");
  if (!left) check_rounds(stmt.value, first, tested, build_.blocks().size() - tested);
  build_.start(exit);
}

void Statements::leave_loop(const Stmt& stmt) {
  bool exit = stmt.kind == StmtKind::kExit;
  if (body_.flow.loops.empty()) {
    error(DiagnosticCode::kExitOutsideLoop, stmt.span,
          std::string(exit ? "EXIT" : "CONTINUE") + " stands in no loop",
          exit ? "RETURN leaves the POU" : "");
    return;
  }
  if (exit) body_.flow.loops.back().left = true;
  ask<TryCode>().go(exit ? body_.flow.loops.back().exit : body_.flow.loops.back().again,
                    body_.flow.loops.back().tries);
}

void Statements::leave() {
  leave_loops();
  ask<TryCode>().go({}, 0);
}

}  // namespace frontend
