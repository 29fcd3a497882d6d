// Lowers the body of one POU: checks every statement against the types that sema
// knows, and writes IR by the contract of ir/program/ir.h. Order of evaluation is
// source order: a target's indices, then the value; operands and arguments from left
// to right (docs/LANGUAGE.md). After an error it goes on with harmless values,
// so that one run reports all errors; the result is then thrown away.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "frontend/lower/body_phase.h"
#include "frontend/lower/handles.h"
#include "stdlib/native/natives.h"

namespace frontend {

class Body : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void run();
  std::optional<Constant> evaluate(ExprId id, ir::TypeId context);
  std::optional<Constant> run_alone(uint32_t local, base::SourceSpan span);
  // --- statements (statement.cc, for.cc, case.cc, assignment.cc)
  void statements(Range32 list);
  void statement(const Stmt& stmt);
  void if_statement(const Stmt& stmt);
  void while_statement(const Stmt& stmt);
  void repeat_statement(const Stmt& stmt);
  void for_statement(const Stmt& stmt);
  void case_statement(const Stmt& stmt);
  void leave_loop(const Stmt& stmt);
  void assign(const Stmt& stmt);
  std::optional<Target> assign_value(ExprId left, ExprId right, base::SourceSpan span);
  void allow_set_or_reset(base::SourceSpan span);
  ir::ValueId set_or_reset(AssignOp op, ExprId left, ExprId right, base::SourceSpan span);
  ir::ValueId emit_assignment(const Expr& expr);
  ir::Place assignment_place(ExprId id, const Expr& expr);
  void assign_aggregate(const Target& target, ExprId value);
  bool loop_body(Range32 body, ir::BlockId again, ir::BlockId exit);
  void leave_loops();
  void check_end(ExprId condition, bool goes_on);

  // --- __TRY (try.cc)
  void try_statement(const Stmt& stmt);
  void try_finally(const std::function<void()>& body, Range32 finally_body, base::SourceSpan span);
  void try_catch(const Stmt& stmt);
  void catch_variable(const Stmt& stmt);
  void enter_try(ir::BlockId handler, ir::BlockId finally, base::SourceSpan span);
  void leave_try();
  void go(ir::BlockId to, size_t tries);

  // --- JMP (jump.cc)
  Flow::Labels labels_of(Range32 list);
  void jump(const Stmt& stmt);
  void label(const Stmt& stmt);

  // --- FOR (for.cc)
  struct ForLoop;
  bool for_head(const Stmt& stmt, ForLoop& loop);
  void for_step(const Stmt& stmt, ForLoop& loop);
  void for_test(const ForLoop& loop, ir::BlockId body, ir::BlockId exit);
  void for_advance(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);
  void for_advance_constant(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);
  void for_advance_variable(const ForLoop& loop, ir::BlockId head, ir::BlockId exit);

  // --- CASE (case.cc)
  struct Interval;
  std::vector<Interval> case_intervals(const Stmt& stmt, ir::TypeId type,
                                       const std::vector<ir::BlockId>& arms);
  void report_missing_labels(const Stmt& stmt, ir::TypeId type,
                             const std::vector<Interval>& intervals);
  struct CaseLeaf;
  struct CaseTests;
  static std::vector<CaseLeaf> case_leaves(const std::vector<Interval>& intervals);
  void case_tree(const CaseTests& tests, size_t first, size_t last);
  void case_test(const CaseTests& tests, const Interval& interval, ir::BlockId next);
  void case_table(const CaseTests& tests, const CaseLeaf& leaf, ir::BlockId next);

  // --- helpers
  void initialise_locals();
  void detect_edges();
  void connect_inputs();
  void connect_outputs();
  void connect_input(const Target& input, const Arg& arg);
  void connect_output(const Variable& output, const Arg& arg);
  void leave();
  void initialise(const ir::Place& where, const Variable& variable);
};

// Lowers the body of a POU that has one.
void write_body(Sema& sema, uint32_t pou);

}  // namespace frontend
