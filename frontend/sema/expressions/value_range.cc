#include "frontend/sema/expressions/value_range.h"

#include <algorithm>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {
namespace {

constexpr int kDeepest = 16;  // of expressions in expressions; below that, types tell

bool within(const Limits& inner, const Limits& outer) {
  return inner.low >= outer.low && inner.high <= outer.high;
}

Limits around(std::initializer_list<Wide> values) { return {std::min(values), std::max(values)}; }

class Ranges {
 public:
  explicit Ranges(const Phase& phase) : phase_(phase), types_(phase.sema().program.types) {}

  Limits of(ExprId id, int depth) {
    const Limits own = of_type(id);
    const Note& note = phase_.infer(id);
    if (note.constant) {
      const auto value = phase_.ask<Constants>().fold(id, {});
      const bool whole = value && value->form == Constant::Form::kInteger;
      return whole ? Limits{value->integer, value->integer} : own;
    }
    if (depth == kDeepest || !note.type.valid()) return own;
    const Limits exact = exact_of(id, depth);
    return within(exact, own) ? exact : own;
  }

  // As if nothing were cut off.
  Limits exact_of(ExprId id, int depth) {
    const Expr& expr = phase_.sema().tree[id];
    const bool small = has_wider(phase_.sema(), phase_.infer(id));
    if (expr.kind == ExprKind::kUnary && small) {
      const Limits in = of(expr.operand, depth + 1);
      if (expr.unary == UnaryOp::kNegate) return {-in.high, -in.low};
      return expr.unary == UnaryOp::kPlus ? in : of_type(id);
    }
    if (expr.kind == ExprKind::kBinary && small) return of_binary(id, expr, depth);
    if (expr.kind == ExprKind::kCall) return of_call(id, expr, depth);
    return of_type(id);
  }

 private:
  Limits of_type(ExprId id) const {
    const ir::TypeId type = phase_.infer(id).type;
    if (!type.valid() || !types_.is_scalar(type)) return kAnything;
    const Traits traits = traits_of(types_, type);
    if (!traits.integer && !traits.bits) return kAnything;
    if (types_[type].kind == ir::Kind::kSubrange) return {types_[type].low, types_[type].high};
    return limits_of(types_.scalar(type));
  }

  Limits of_binary(ExprId id, const Expr& expr, int depth) {
    const auto out = combined(expr.binary, of(expr.operand, depth + 1), of(expr.right, depth + 1));
    return out.value_or(of_type(id));
  }

  // Nothing: the limits of the type do.
  static std::optional<Limits> combined(BinaryOp op, const Limits& a, const Limits& b) {
    if (!within(a, kSmall) || !within(b, kSmall)) return std::nullopt;
    switch (op) {
      case BinaryOp::kAdd:
        return Limits{a.low + b.low, a.high + b.high};
      case BinaryOp::kSub:
        return Limits{a.low - b.high, a.high - b.low};
      case BinaryOp::kMul:
        return around({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
      case BinaryOp::kDiv:
        if (b.low <= 0) return std::nullopt;
        return around({a.low / b.low, a.high / b.low, 0});
      case BinaryOp::kMod:
        if (b.low <= 0) return std::nullopt;
        return Limits{a.low < 0 ? 1 - b.high : 0, a.high > 0 ? b.high - 1 : 0};
      default:
        return std::nullopt;
    }
  }

  Limits of_call(ExprId id, const Expr& expr, int depth) {
    if (phase_.sema().tree[expr.operand].kind != ExprKind::kName) return of_type(id);
    const Callee callee = phase_.ask<Calls>().callee(expr);
    if (callee.kind == Callee::Kind::kConversion) {
      const ExprId from = phase_.ask<Calls>().conversion_argument(expr);
      const bool plain = callee.conversion.bcd == Conversion::Bcd::kNone && from.valid();
      return plain ? of(from, depth + 1) : of_type(id);
    }
    if (callee.kind != Callee::Kind::kStandard) return of_type(id);
    const std::vector<ExprId> args =
        phase_.ask<StandardCalls>().standard_arguments(expr, *callee.row);
    if (args.empty()) return of_type(id);
    if (callee.row->id == stdlib::FunctionId::kLen) {
      return {0, types_[phase_.infer(args[0]).type].capacity};
    }
    Limits out = of(args[0], depth + 1);
    switch (callee.row->id) {
      case stdlib::FunctionId::kAbs:
        return {std::max<Wide>({out.low, -out.high, 0}), std::max(out.high, -out.low)};
      case stdlib::FunctionId::kMax:
      case stdlib::FunctionId::kMin:
        for (size_t i = 1; i < args.size(); ++i) {
          const Limits next = of(args[i], depth + 1);
          const bool most = callee.row->id == stdlib::FunctionId::kMax;
          out.low = most ? std::max(out.low, next.low) : std::min(out.low, next.low);
          out.high = most ? std::max(out.high, next.high) : std::min(out.high, next.high);
        }
        return out;
      case stdlib::FunctionId::kLimit: {
        const Limits in = of(args[1], depth + 1);
        const Limits most = of(args[2], depth + 1);
        out = {std::max(out.low, in.low), std::max(out.high, in.high)};
        return {std::min(out.low, most.low), std::min(out.high, most.high)};
      }
      case stdlib::FunctionId::kSel: {
        const Limits no = of(args[1], depth + 1);
        const Limits yes = of(args[2], depth + 1);
        return around({no.low, no.high, yes.low, yes.high});
      }
      case stdlib::FunctionId::kAdd:
      case stdlib::FunctionId::kSub:
      case stdlib::FunctionId::kMul:
        for (size_t i = 1; i < args.size(); ++i) {
          const BinaryOp op = standard_operator(callee.row->id);
          out = combined(op, out, of(args[i], depth + 1)).value_or(kAnything);
        }
        return out;
      default:
        return of_type(id);
    }
  }

  static constexpr Limits kAnything{-(Wide{1} << 100), Wide{1} << 100};
  static constexpr Limits kSmall{-(Wide{1} << 40), Wide{1} << 40};

  const Phase& phase_;
  const ir::TypeTable& types_;
};

}  // namespace

Limits range_of(const Phase& phase, ExprId id) { return Ranges(phase).of(id, 0); }

bool is_natural(const Phase& phase, ExprId id) {
  Ranges ranges(phase);
  // What is wide is not cut to its type.
  const bool wide = phase.infer(id).width == Width::kWide && !phase.infer(id).constant;
  return (wide ? ranges.exact_of(id, 0) : ranges.of(id, 0)).low >= 0;
}

bool may_leave_type(const Phase& phase, ExprId id) {
  const ir::TypeTable& types = phase.sema().program.types;
  const Limits own = limits_of(types.scalar(phase.infer(id).type));
  return !within(Ranges(phase).exact_of(id, 0), own);
}

}  // namespace frontend
