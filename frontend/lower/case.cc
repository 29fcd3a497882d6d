// CASE: labels become sorted intervals, and those a tree of comparisons.
#include <algorithm>

#include "frontend/lower/body.h"

namespace frontend {

struct Body::Interval {
  Wide low;
  Wide high;
  ir::BlockId arm;
  base::SourceSpan span;
};

namespace {

// Up to here one test behind the other is as good as a tree.
constexpr size_t kLinearTests = 4;

}  // namespace

void Body::case_statement(const Stmt& stmt) {
  const Note& note = sema_.infer(stmt.value);
  ir::TypeId type = without_range(types(), note.type);
  Traits traits = traits_of(types(), type);
  bool usable = traits.integer || traits.bits || traits.enumeration;
  if (type.valid() && !usable) {
    sema_.error(DiagnosticCode::kBadSelector, tree_[stmt.value].span,
                "the selector is `" + sema_.type_text(type) + "`");
  }
  if (!type.valid() || !usable) type = elementary(ir::Kind::kDint);
  ir::ValueId selector = value(stmt.value, usable ? type : ir::TypeId());
  if (!usable) selector = zero(type);
  std::vector<ir::BlockId> arms;
  for (uint32_t i = 0; i < stmt.arms.count; ++i) arms.push_back(build_.new_block());
  ir::BlockId otherwise = build_.new_block();
  ir::BlockId done = build_.new_block();
  std::vector<Interval> intervals;
  if (usable) intervals = case_intervals(stmt, type, arms);
  if (!stmt.has_else && traits.enumeration) report_missing_labels(stmt, type, intervals);
  case_tree(intervals, 0, intervals.size(), selector, scalar(type), otherwise);
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    build_.start(arms[i]);
    statements(tree_.cases[stmt.arms.first + i].body);
    if (build_.reachable()) build_.jump(done);
  }
  build_.start(otherwise);
  statements(stmt.else_body);
  if (build_.reachable()) build_.jump(done);
  build_.start(done);
}

void Body::report_missing_labels(const Stmt& stmt, ir::TypeId type,
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
  sema_.warning(DiagnosticCode::kMissingCaseLabels, stmt.span, "no label for " + missing,
                "add it, or an ELSE");
}

std::vector<Body::Interval> Body::case_intervals(const Stmt& stmt, ir::TypeId type,
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
      auto low = sema_.fold_bits(label.low, type);
      auto high = label.high.valid() ? sema_.fold_bits(label.high, type) : low;
      if (!low || !high) continue;
      base::SourceSpan span = tree_[label.low].span;
      if (wide_of(*low) > wide_of(*high)) {
        sema_.error(DiagnosticCode::kBadBounds, span,
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
    sema_.error(DiagnosticCode::kOverlappingLabels, second.span,
                "the value " + wide_text(intervals[i].low) + " is already a label in line " +
                    std::to_string(sema_.sources.locate(first.span.begin).line));
    intervals[i].high = std::max(intervals[i].high, intervals[i - 1].high);
  }
  return intervals;
}

void Body::case_tree(const std::vector<Interval>& intervals, size_t first, size_t last,
                     ir::ValueId selector, ir::Scalar machine, ir::BlockId otherwise) {
  if (last - first > kLinearTests) {
    size_t middle = first + (last - first) / 2;
    ir::BlockId below = build_.new_block();
    ir::BlockId above = build_.new_block();
    ir::ValueId edge = build_.constant(machine, static_cast<uint64_t>(intervals[middle].low));
    build_.branch(build_.compare(ir::Op::kLt, machine, selector, edge), below, above);
    build_.start(below);
    case_tree(intervals, first, middle, selector, machine, otherwise);
    build_.start(above);
    case_tree(intervals, middle, last, selector, machine, otherwise);
    return;
  }
  for (size_t i = first; i < last; ++i) {
    ir::BlockId next = i + 1 == last ? otherwise : build_.new_block();
    case_test(intervals[i], selector, machine, next);
    if (i + 1 != last) build_.start(next);
  }
  if (first == last) build_.jump(otherwise);
}

void Body::case_test(const Interval& interval, ir::ValueId selector, ir::Scalar machine,
                     ir::BlockId next) {
  ir::ValueId low = build_.constant(machine, static_cast<uint64_t>(interval.low));
  if (interval.low == interval.high) {
    build_.branch(build_.compare(ir::Op::kEq, machine, selector, low), interval.arm, next);
    return;
  }
  ir::BlockId upper = build_.new_block();
  build_.branch(build_.compare(ir::Op::kLe, machine, low, selector), upper, next);
  build_.start(upper);
  ir::ValueId high = build_.constant(machine, static_cast<uint64_t>(interval.high));
  build_.branch(build_.compare(ir::Op::kLe, machine, selector, high), interval.arm, next);
}

}  // namespace frontend
