// CASE: labels become sorted intervals. Where many lie close together a table says where to go on;
// what is left, and the tables, are the leaves of a tree of comparisons.
#include <algorithm>
#include <limits>

#include "frontend/lower/case_code.h"
#include "frontend/lower/statements.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {

struct CaseCode::Interval {
  Wide low;
  Wide high;
  ir::BlockId arm;
  base::SourceSpan span;
};

// Intervals first..last - 1: one to be tested, or several for a table.
struct CaseCode::CaseLeaf {
  size_t first;
  size_t last;
};

struct CaseCode::CaseTests {
  const std::vector<Interval>& intervals;
  const std::vector<CaseLeaf>& leaves;
  ir::ValueId selector;
  ir::Scalar machine;
  ir::BlockId otherwise;
};

namespace {

// Up to here one test after the other is as good as a tree.
constexpr size_t kLinearTests = 4;
// A table has an entry for each value between its first label and its last: 8 bytes of code, where
// a test takes 16.
constexpr size_t kLeastIntervals = 5;  // fewer tests are as quick
constexpr Wide kMostAlike = 4;         // values of one interval, and between two
constexpr Wide kMostEntries = 1024;

}  // namespace

void CaseCode::case_statement(const Stmt& stmt) {
  const Note& note = infer(stmt.value);
  ir::TypeId type = without_range(types(), note.type);
  Traits traits = traits_of(types(), type);
  bool usable = traits.integer || traits.bits || traits.enumeration;
  if (type.valid() && !usable) {
    error(DiagnosticCode::kBadSelector, tree_[stmt.value].span,
          "the selector is `" + sema_.report.type_text(type) + "`");
  }
  if (!type.valid() || !usable) type = elementary(ir::Kind::kDint);
  if (usable) type = computed_type(sema_, infer(stmt.value));
  check_wrapped(*this, stmt.value, "compared");
  ir::ValueId selector = value(stmt.value, usable ? type : ir::TypeId());
  if (!usable) selector = code_.zero(type);
  std::vector<ir::BlockId> arms;
  for (uint32_t i = 0; i < stmt.arms.count; ++i) arms.push_back(build_.new_block());
  ir::BlockId otherwise = build_.new_block();
  ir::BlockId done = build_.new_block();
  std::vector<Interval> intervals;
  if (usable) intervals = case_intervals(stmt, type, arms);
  if (!stmt.has_else && traits.enumeration) report_missing_labels(stmt, type, intervals);
  std::vector<CaseLeaf> leaves = case_leaves(intervals);
  CaseTests tests{intervals, leaves, selector, scalar(type), otherwise};
  case_tree(tests, 0, leaves.size());
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    build_.start(arms[i]);
    if (body_.counting.on()) {
      const uint32_t line = sema_.sources.locate(tree_.cases[stmt.arms.first + i].span.begin).line;
      body_.counting.count(SiteKind::kBranch, stmt.span.begin, "CASE: line " + std::to_string(line),
                           i);
    }
    ask<Statements>().write(tree_.cases[stmt.arms.first + i].body);
    if (build_.reachable()) build_.jump(done);
  }
  build_.start(otherwise);
  body_.counting.count(SiteKind::kBranch, stmt.span.begin, "CASE: ELSE", stmt.arms.count);
  ask<Statements>().write(stmt.else_body);
  if (build_.reachable()) build_.jump(done);
  build_.start(done);
}

void CaseCode::report_missing_labels(const Stmt& stmt, ir::TypeId type,
                                     const std::vector<Interval>& intervals) {
  std::string missing;
  for (const ir::EnumLiteral& literal : types()[type].literals) {
    auto after = std::upper_bound(
        intervals.begin(), intervals.end(), literal.value,
        [](int64_t value, const Interval& interval) { return value < interval.low; });
    if (after != intervals.begin() && literal.value <= std::prev(after)->high) continue;
    missing += (missing.empty() ? "`" : ", `") + literal.name + "`";
  }
  if (missing.empty()) return;
  warning(DiagnosticCode::kMissingCaseLabels, stmt.span, "no label for " + missing,
          "add it, or an ELSE");
}

// A real number, which some dialects would round.
bool CaseCode::check_whole(ExprId label) {
  const Note& note = infer(label);
  if (!note.type.valid() || !traits_of(types(), note.type).real) return true;
  error(DiagnosticCode::kTypeMismatch, tree_[label].span, "a label is a whole number or a name",
        "use IF for ranges of real numbers");
  return false;
}

std::vector<CaseCode::Interval> CaseCode::case_intervals(const Stmt& stmt, ir::TypeId type,
                                                         const std::vector<ir::BlockId>& arms) {
  std::vector<Interval> intervals;
  bool is_signed = ir::is_signed(scalar(type));
  auto wide_of = [&](uint64_t bits) {
    return is_signed ? static_cast<Wide>(static_cast<int64_t>(bits)) : static_cast<Wide>(bits);
  };
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    const CaseArm& arm = tree_.cases[stmt.arms.first + i];
    for (uint32_t k = 0; k < arm.labels.count; ++k) {
      const CaseLabel& label = tree_.labels[arm.labels.first + k];
      if (!check_whole(label.low) || (label.high.valid() && !check_whole(label.high))) continue;
      auto low = ask<Constants>().fold_bits(label.low, type);
      auto high = label.high.valid() ? ask<Constants>().fold_bits(label.high, type) : low;
      if (!low || !high) continue;
      base::SourceSpan span = tree_[label.low].span;
      if (wide_of(*low) > wide_of(*high)) {
        error(DiagnosticCode::kBadBounds, span,
              "the range " + wide_text(wide_of(*low)) + ".." + wide_text(wide_of(*high)) +
                  " is empty");
        continue;
      }
      intervals.push_back({wide_of(*low), wide_of(*high), arms[i], span});
    }
  }
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const Interval& a, const Interval& b) { return a.low < b.low; });
  for (size_t i = 1; i < intervals.size(); ++i) {
    if (intervals[i].low > intervals[i - 1].high) continue;
    bool later = intervals[i].span.begin > intervals[i - 1].span.begin;
    const Interval& second = later ? intervals[i] : intervals[i - 1];
    const Interval& first = later ? intervals[i - 1] : intervals[i];
    error(DiagnosticCode::kOverlappingLabels, second.span,
          "the value " + wide_text(intervals[i].low) + " is already a label in line " +
              std::to_string(sema_.sources.locate(first.span.begin).line));
    intervals[i].high = std::max(intervals[i].high, intervals[i - 1].high);
  }
  return intervals;
}

std::vector<CaseCode::CaseLeaf> CaseCode::case_leaves(const std::vector<Interval>& intervals) {
  auto fits = [&](size_t i) {
    return intervals[i].high - intervals[i].low < kMostAlike &&
           intervals[i].low >= std::numeric_limits<int32_t>::min() &&
           intervals[i].high <= std::numeric_limits<int32_t>::max();
  };
  std::vector<CaseLeaf> leaves;
  for (size_t first = 0; first < intervals.size();) {
    size_t last = first + 1;
    while (last < intervals.size() && fits(first) && fits(last) &&
           intervals[last].low - intervals[last - 1].high - 1 <= kMostAlike &&
           intervals[last].high - intervals[first].low < kMostEntries) {
      ++last;
    }
    if (last - first < kLeastIntervals) last = first + 1;
    leaves.push_back({first, last});
    first = last;
  }
  return leaves;
}

void CaseCode::case_tree(const CaseTests& tests, size_t first, size_t last) {
  if (last - first > kLinearTests) {
    size_t middle = first + (last - first) / 2;
    ir::BlockId below = build_.new_block();
    ir::BlockId above = build_.new_block();
    Wide low = tests.intervals[tests.leaves[middle].first].low;
    ir::ValueId edge = build_.constant(tests.machine, static_cast<uint64_t>(low));
    build_.branch(build_.compare(ir::Op::kLt, tests.machine, tests.selector, edge), below, above);
    build_.start(below);
    case_tree(tests, first, middle);
    build_.start(above);
    case_tree(tests, middle, last);
    return;
  }
  for (size_t i = first; i < last; ++i) {
    ir::BlockId next = i + 1 == last ? tests.otherwise : build_.new_block();
    const CaseLeaf& leaf = tests.leaves[i];
    if (leaf.last - leaf.first == 1) {
      case_test(tests, tests.intervals[leaf.first], next);
    } else {
      case_table(tests, leaf, next);
    }
    if (i + 1 != last) build_.start(next);
  }
  if (first == last) build_.jump(tests.otherwise);
}

void CaseCode::case_test(const CaseTests& tests, const Interval& interval, ir::BlockId next) {
  auto test = [&](ir::Op op, ir::ValueId a, ir::ValueId b, ir::BlockId yes) {
    build_.branch(build_.compare(op, tests.machine, a, b), yes, next);
  };
  ir::ValueId low = build_.constant(tests.machine, static_cast<uint64_t>(interval.low));
  if (interval.low == interval.high) return test(ir::Op::kEq, tests.selector, low, interval.arm);
  ir::BlockId upper = build_.new_block();
  test(ir::Op::kLe, low, tests.selector, upper);
  build_.start(upper);
  ir::ValueId high = build_.constant(tests.machine, static_cast<uint64_t>(interval.high));
  test(ir::Op::kLe, tests.selector, high, interval.arm);
}

void CaseCode::case_table(const CaseTests& tests, const CaseLeaf& leaf, ir::BlockId next) {
  Wide low = tests.intervals[leaf.first].low;
  std::vector<ir::BlockId> targets;
  for (size_t i = leaf.first; i < leaf.last; ++i) {
    const Interval& interval = tests.intervals[i];
    targets.resize(static_cast<size_t>(interval.low - low), next);
    targets.resize(static_cast<size_t>(interval.high - low + 1), interval.arm);
  }
  build_.switch_on(tests.machine, tests.selector, static_cast<int64_t>(low), targets, next);
}

}  // namespace frontend
