// __TRY ... __CATCH(e) ... __FINALLY ... __ENDTRY (docs/adr/0007-caught-traps.md). Whatever leaves
// the body or the handler of a __TRY with a __FINALLY goes through that first: it notes where to
// go on in a variable of the frame, and what is after the __FINALLY looks there.
#include "base/limits.h"
#include "frontend/lower/statements.h"
#include "frontend/lower/try_code.h"
#include "frontend/lower/write_checks.h"

namespace frontend {

void TryCode::try_statement(const Stmt& stmt) {
  const auto body = [&] {
    if (stmt.has_catch) {
      try_catch(stmt);
    } else {
      ask<Statements>().write(stmt.body);
    }
  };
  if (stmt.has_finally) {
    try_finally(body, tree_.branches[stmt.arms.first + 1].body, stmt.span);
  } else {
    body();
  }
}

void TryCode::enter_try(ir::BlockId handler, ir::BlockId finally, base::SourceSpan span) {
  Flow::Try scope;
  scope.outer = build_.set_handler(handler);
  scope.finally = finally;
  if (body_.flow.tries.size() == base::kMaxTryDepth) {
    error(DiagnosticCode::kTooDeep, span,
          "more than " + std::to_string(base::kMaxTryDepth) + " levels of __TRY",
          "move a part into a function");
  }
  if (finally.valid()) scope.where = temporary_place(elementary(ir::Kind::kUdint));
  ir::BlockId body = build_.new_block();
  build_.begin_try(body, handler);
  build_.start(body);
  body_.flow.tries.push_back(std::move(scope));
}

void TryCode::leave_try() {
  build_.set_handler(body_.flow.tries.back().outer);
  body_.flow.tries.pop_back();
}

// Goes to `to`, which `tries` of the scopes are around; invalid: out of the POU.
void TryCode::go(ir::BlockId to, size_t tries) {
  const ir::BlockId handler = build_.set_handler({});
  size_t at = body_.flow.tries.size();
  bool done = false;
  while (at > tries && !done) {
    Flow::Try& scope = body_.flow.tries[--at];
    ir::BlockId outside = build_.new_block();
    build_.end_try(outside);
    build_.set_handler(scope.outer);
    build_.start(outside);
    if (!scope.finally.valid()) continue;
    const uint64_t code = ir::kTrapCount + scope.exits.size();
    scope.exits.push_back({to, tries});
    build_.store(scope.where, ir::Scalar::kU32, build_.constant(ir::Scalar::kU32, code));
    build_.jump(scope.finally);
    done = true;
  }
  if (!done) {
    if (!to.valid()) to = body_.flow.exit;
    if (to.valid()) {
      build_.jump(to);
    } else {
      build_.ret();
    }
  }
  build_.set_handler(handler);
}

void TryCode::try_finally(const std::function<void()>& body, Range32 finally_body,
                          base::SourceSpan span) {
  ir::BlockId finally = build_.new_block();
  ir::BlockId handler = build_.new_block();
  ir::BlockId behind = build_.new_block();
  enter_try(handler, finally, span);
  body();
  if (build_.reachable()) go(behind, body_.flow.tries.size() - 1);
  const Flow::Try scope = std::move(body_.flow.tries.back());
  leave_try();

  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  build_.start(handler);
  build_.store(scope.where, kU32, build_.trap_kind());
  build_.jump(finally);
  build_.start(finally);
  ask<Statements>().write(finally_body);
  if (build_.reachable()) {
    set_line({span.end, span.end});
    ir::ValueId where = build_.load(scope.where, kU32);
    for (size_t i = 0; i < scope.exits.size(); ++i) {
      ir::ValueId code = build_.constant(kU32, ir::kTrapCount + i);
      ir::BlockId here = build_.new_block();
      ir::BlockId next = build_.new_block();
      build_.branch(build_.compare(ir::Op::kEq, kU32, where, code), here, next);
      build_.start(here);
      go(scope.exits[i].to, scope.exits[i].tries);
      build_.start(next);
    }
    build_.trap_again(where);
  }
  build_.start(behind);
}

void TryCode::try_catch(const Stmt& stmt) {
  ir::BlockId handler = build_.new_block();
  ir::BlockId behind = build_.new_block();
  enter_try(handler, {}, stmt.span);
  ask<Statements>().write(stmt.body);
  if (build_.reachable()) go(behind, body_.flow.tries.size() - 1);
  leave_try();
  build_.start(handler);
  pass_assertions_on();
  if (stmt.target.valid()) catch_variable(stmt);
  ask<Statements>().write(tree_.branches[stmt.arms.first].body);
  if (build_.reachable()) build_.jump(behind);
  build_.start(behind);
}

void TryCode::pass_assertions_on() {
  if (!sema_.for_tests()) return;
  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  const ir::ValueId kind = build_.trap_kind();
  const ir::ValueId assertion = build_.constant(kU32, static_cast<uint64_t>(ir::TrapKind::kAssert));
  const ir::BlockId again = build_.new_block();
  const ir::BlockId caught = build_.new_block();
  build_.branch(build_.compare(ir::Op::kEq, kU32, kind, assertion), again, caught);
  build_.start(again);
  build_.trap_again(kind);
  build_.start(caught);
}

// An integer, or the library's ExceptionCode: 0 is no trap, so kinds count from 1.
void TryCode::catch_variable(const Stmt& stmt) {
  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  ir::ValueId kind = build_.trap_kind();
  kind = build_.binary(ir::Op::kAdd, kU32, kind, build_.constant(kU32, 1));
  auto variable =
      ask<WriteChecks>().check_writable(stmt.target) ? target(stmt.target) : std::nullopt;
  if (!variable) return;
  Traits traits = traits_of(types(), variable->type);
  bool wide_enough = types().is_scalar(variable->type) && !traits.boolean &&
                     (traits.integer || traits.bits || traits.enumeration);
  if (!wide_enough) {
    error(DiagnosticCode::kTypeMismatch, tree_[stmt.target].span,
          "the variable of __CATCH is `" + sema_.report.type_text(variable->type) + "`",
          "declare it as ExceptionCode or as an integer");
    return;
  }
  store(*variable, code_.machine_convert(kind, kU32, scalar(variable->type)));
}

}  // namespace frontend
