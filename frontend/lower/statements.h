// Phase: statements, one after the other (statement.cc), with IF, loops, EXIT, RETURN and JMP
// (jump.cc). It reads and writes what surrounds them (Flow), counts what is reached (Counting), and
// leaves the other kinds to phases of their own.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class Statements : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void write(Range32 list);
  bool loop_body(Range32 body, ir::BlockId again, ir::BlockId exit);
  void leave();

 private:
  void write(const Stmt& stmt);
  void if_statement(const Stmt& stmt);
  void while_statement(const Stmt& stmt);
  void repeat_statement(const Stmt& stmt);
  void check_end(ExprId condition, bool goes_on);
  void check_rounds(ExprId condition, size_t first, size_t test, size_t tests);
  bool differs_by_code(ExprId condition) const;
  void leave_loop(const Stmt& stmt);
  void leave_loops();
  bool is_same_row(const Stmt& a, const Stmt& b) const;
  Flow::Labels labels_of(Range32 list);
  void jump(const Stmt& stmt);
  void label(const Stmt& stmt);
};

}  // namespace frontend
