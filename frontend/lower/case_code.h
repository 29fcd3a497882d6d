// Phase: CASE (case.cc). It folds labels, reports those that overlap or are missing, and writes
// comparisons and tables.
#pragma once

#include <vector>

#include "frontend/lower/body_phase.h"

namespace frontend {

class CaseCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void case_statement(const Stmt& stmt);

 private:
  struct Interval;
  struct CaseLeaf;
  struct CaseTests;
  bool check_whole(ExprId label);
  std::vector<Interval> case_intervals(const Stmt& stmt, ir::TypeId type,
                                       const std::vector<ir::BlockId>& arms);
  void report_missing_labels(const Stmt& stmt, ir::TypeId type,
                             const std::vector<Interval>& intervals);
  static std::vector<CaseLeaf> case_leaves(const std::vector<Interval>& intervals);
  void case_tree(const CaseTests& tests, size_t first, size_t last);
  void case_test(const CaseTests& tests, const Interval& interval, ir::BlockId next);
  void case_table(const CaseTests& tests, const CaseLeaf& leaf, ir::BlockId next);
};

}  // namespace frontend
