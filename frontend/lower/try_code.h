// Phase: __TRY, and the ways out of it (try.cc). It keeps what surrounds the current statement in
// Flow::tries, and writes the code that catches, and that goes on after a __FINALLY.
#pragma once

#include <functional>

#include "frontend/lower/body_phase.h"

namespace frontend {

class TryCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void try_statement(const Stmt& stmt);
  void enter_try(ir::BlockId handler, ir::BlockId finally, base::SourceSpan span);
  void leave_try();
  void go(ir::BlockId to, size_t tries);
  // At the beginning of a handler that takes traps: a failed assertion ends its test all the same.
  void pass_assertions_on();

 private:
  void try_finally(const std::function<void()>& body, Range32 finally_body, base::SourceSpan span);
  void try_catch(const Stmt& stmt);
  void catch_variable(const Stmt& stmt);
};

}  // namespace frontend
