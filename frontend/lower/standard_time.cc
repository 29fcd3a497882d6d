// Standard functions on durations, dates and moments.
#include <limits>

#include "frontend/lower/standard_code.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/calls/standard_calls.h"

namespace frontend {
namespace {

using stdlib::FunctionRule;
using stdlib::NativeId;

BinaryOp time_operator(FunctionRule rule) {
  return rule == FunctionRule::kTimeSum          ? BinaryOp::kAdd
         : rule == FunctionRule::kTimeDifference ? BinaryOp::kSub
         : rule == FunctionRule::kTimeProduct    ? BinaryOp::kMul
                                                 : BinaryOp::kDiv;
}

// The parts of a moment, in the order of kMoment and kMomentPart.
constexpr uint32_t kFirstOfClock = 3;
constexpr uint32_t kParts = 7;

// The first part that SPLIT_DATE, SPLIT_TOD or SPLIT_DT has.
uint32_t first_part(const stdlib::FunctionRow& row) {
  return row.parameters.find("YEAR") == std::string_view::npos ? kFirstOfClock : 0;
}

// Year and millisecond need more than eight bits.
bool holds_part(const ir::TypeTable& types, ir::TypeId type, uint32_t part) {
  Traits traits = traits_of(types, type);
  if (!traits.integer && !traits.bits) return false;
  bool large = part == 0 || part == kParts - 1;
  return !large || ir::scalar_size(types.scalar(type)) > 1;
}

}  // namespace

ir::ValueId StandardCode::time_function(const std::vector<ExprId>& args,
                                        const stdlib::FunctionRow& row) {
  Typed operands[2];
  for (uint32_t i = 0; i < 2; ++i) {
    auto kind = kind_of_name(stdlib::operand_type(row, i));
    operands[i] =
        kind ? Typed{value(args[i], elementary(*kind)), elementary(*kind)} : natural(args[i]);
  }
  return code_.time_arithmetic(time_operator(row.rule), operands[0], operands[1]).value;
}

// A date alone is midnight, a time of day alone is on 1970-01-01.
ir::ValueId StandardCode::moment(const std::vector<ExprId>& args, const stdlib::FunctionRow& row) {
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  uint32_t first = first_part(row);
  ir::ValueList given;
  for (ExprId arg : args) {
    Typed part = natural(arg);
    given.push_back(code_.machine_convert(part.value, scalar(part.type), kI64));
  }
  ir::ValueList parts;
  for (uint32_t i = 0; i < kParts; ++i) {
    constexpr uint64_t kEpoch[kParts] = {1970, 1, 1};
    bool is_given = i >= first && i - first < given.size();
    parts.push_back(is_given ? given[i - first] : build_.constant(kI64, kEpoch[i]));
  }
  ir::ValueId ns = code_.native(NativeId::kMoment, parts);
  auto none = static_cast<uint64_t>(std::numeric_limits<int64_t>::min());
  code_.require(build_.compare(ir::Op::kNe, kI64, ns, build_.constant(kI64, none)));
  return ns;
}

ir::ValueId ValueCode::moment_part(ir::ValueId ns, uint32_t part) {
  return native(NativeId::kMomentPart, {ns, build_.constant(ir::Scalar::kI32, part)});
}

ir::ValueId StandardCode::day_of_week(ExprId moment) {
  constexpr uint32_t kDayOfWeek = 7;
  ir::ValueId day = code_.moment_part(natural(moment).value, kDayOfWeek);
  return code_.machine_convert(day, ir::Scalar::kI32, ir::Scalar::kI16);
}

// SPLIT_DATE(IN := d, YEAR => y, ...): a statement.
void StandardCode::split(const Expr& call, const stdlib::FunctionRow& row) {
  std::vector<ExprId> args = ask<StandardCalls>().standard_arguments(call, row);
  if (args.empty() || !infer(args[0]).type.valid()) return;
  ir::ValueId ns = value(args[0], elementary(*kind_of_name(stdlib::operand_type(row, 0))));
  std::vector<std::optional<Target>> targets(args.size());
  for (size_t i = 1; i < args.size(); ++i) {
    if (args[i].valid()) targets[i] = target(args[i]);
  }
  for (uint32_t i = 1; i < args.size(); ++i) {
    if (!targets[i]) continue;
    uint32_t part = first_part(row) + i - 1;
    ir::TypeId type = targets[i]->type;
    if (!holds_part(types(), type, part)) {
      error(DiagnosticCode::kWrongArgument, tree_[args[i]].span,
            "`" + sema_.report.type_text(type) + "` cannot hold this part",
            "use a variable of type INT or UINT");
      continue;
    }
    ir::ValueId number =
        code_.machine_convert(code_.moment_part(ns, part), ir::Scalar::kI32, scalar(type));
    store(*targets[i], code_.check_range(number, without_range(types(), type), type));
  }
}

}  // namespace frontend
