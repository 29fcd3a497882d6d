// Phase: FOR (for.cc). It reads facts, notes its variable (Flow::for_variables), and writes the
// code of the loop.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class ForCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void for_statement(const Stmt& stmt);

 private:
  struct ForLoop;
  bool for_head(const Stmt& stmt, ForLoop& loop);
  void for_step(const Stmt& stmt, ForLoop& loop);
  void for_test(const ForLoop& loop, ir::BlockId body, ir::BlockId exit);
  void for_advance(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);
  void for_advance_constant(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);
  void for_advance_variable(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);
};

}  // namespace frontend
