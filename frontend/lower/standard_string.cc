// Standard functions on strings, and choices between values that are no scalars.
#include "frontend/lower/standard_code.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

using stdlib::FunctionId;
using stdlib::NativeId;

NativeId string_native(FunctionId id, bool wide) {
  switch (id) {
    case FunctionId::kLen:
      return wide ? NativeId::kLenW : NativeId::kLenS;
    case FunctionId::kFind:
      return wide ? NativeId::kFindW : NativeId::kFindS;
    case FunctionId::kLeft:
      return wide ? NativeId::kLeftW : NativeId::kLeftS;
    case FunctionId::kRight:
      return wide ? NativeId::kRightW : NativeId::kRightS;
    case FunctionId::kMid:
      return wide ? NativeId::kMidW : NativeId::kMidS;
    case FunctionId::kInsert:
      return wide ? NativeId::kInsertW : NativeId::kInsertS;
    case FunctionId::kDelete:
      return wide ? NativeId::kDeleteW : NativeId::kDeleteS;
    case FunctionId::kReplace:
      return wide ? NativeId::kReplaceW : NativeId::kReplaceS;
    default:
      return wide ? NativeId::kConcatW : NativeId::kConcatS;
  }
}

// Do lengths and positions of the call lie in a text of `length` characters? `operands` are result,
// strings and numbers. Sums of numbers that are out of range themselves may wrap.
ir::ValueId in_range(Builder& build, FunctionId id, ir::ValueId length,
                     const ir::ValueList& operands) {
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  ir::ValueId one = build.constant(kI64, 1);
  ir::ValueId last = operands.back();
  auto inside = [&](ir::ValueId low, ir::ValueId number, ir::ValueId high) {
    ir::ValueId above = build.compare(ir::Op::kLe, kI64, low, number);
    ir::ValueId below = build.compare(ir::Op::kLe, kI64, number, high);
    return build.binary(ir::Op::kAnd, ir::Scalar::kBool, above, below);
  };
  ir::ValueId zero = build.constant(kI64, 0);
  if (id == FunctionId::kLeft || id == FunctionId::kRight || id == FunctionId::kInsert) {
    return inside(zero, last, length);
  }
  ir::ValueId count = operands[operands.size() - 2];
  ir::ValueId behind = build.binary(ir::Op::kAdd, kI64, length, one);
  ir::ValueId end = build.binary(ir::Op::kAdd, kI64, last, count);
  ir::ValueId both = build.binary(ir::Op::kAnd, ir::Scalar::kBool, inside(one, last, behind),
                                  inside(zero, count, length));
  ir::ValueId fits = build.compare(ir::Op::kLe, kI64, end, behind);
  return build.binary(ir::Op::kAnd, ir::Scalar::kBool, both, fits);
}

}  // namespace

ir::ValueId StandardCode::string_number(const std::vector<ExprId>& args,
                                        const stdlib::FunctionRow& row) {
  ir::ValueList operands;
  bool is_wide = false;
  for (ExprId arg : args) {
    ir::Place text = place(arg);
    is_wide = wide(text.type);
    operands.push_back(code_.string_value(text));
  }
  ir::ValueId count = code_.native(string_native(row.id, is_wide), operands);
  return code_.machine_convert(count, ir::Scalar::kI32, ir::Scalar::kI16);
}

// The result lies in a temporary of its own, so it never overlaps a source.
ir::Place StandardCode::string_function(const std::vector<ExprId>& args,
                                        const stdlib::FunctionRow& row, ir::TypeId type) {
  bool is_wide = wide(type);
  if (row.id == FunctionId::kConcat) return concat(args, type, is_wide);
  ir::Place result = temporary_place(type);
  uint32_t strings = string_arguments(row, static_cast<uint32_t>(args.size()));
  ir::ValueList operands{code_.string_value(result)};
  for (uint32_t i = 0; i < args.size(); ++i) {
    if (i < strings) {
      operands.push_back(code_.string_value(place(args[i])));
    } else {
      Typed number = natural(args[i]);
      operands.push_back(
          code_.machine_convert(number.value, scalar(number.type), ir::Scalar::kI64));
    }
  }
  bool strict = sema_.options.strict_strings && !info_.library;
  if (strict || (!body_.flow.tries.empty() && body_.flow.tries.back().eno)) {
    constexpr ir::Scalar kI64 = ir::Scalar::kI64;
    ir::ValueId length = code_.native(string_native(FunctionId::kLen, is_wide), {operands[1]});
    length = code_.machine_convert(length, ir::Scalar::kI32, kI64);
    code_.require(in_range(build_, row.id, length, operands), ir::TrapKind::kString);
  }
  code_.native(string_native(row.id, is_wide), operands);
  return result;
}

ir::Place StandardCode::concat(const std::vector<ExprId>& args, ir::TypeId type, bool is_wide) {
  NativeId id = string_native(FunctionId::kConcat, is_wide);
  ir::Place sum = place(args[0]);
  for (size_t i = 1; i < args.size(); ++i) {
    ir::Place next = place(args[i]);
    ir::Place result = temporary_place(type);
    code_.native(id,
                 {code_.string_value(result), code_.string_value(sum), code_.string_value(next)});
    sum = result;
  }
  return sum;
}

// MAX, MIN and LIMIT of strings: `result` becomes `next` when that is the better one.
ir::Place StandardCode::extreme_string(const std::vector<ExprId>& args,
                                       const stdlib::FunctionRow& row, ir::TypeId type) {
  std::vector<ir::Place> places;
  for (ExprId arg : args) places.push_back(place(arg));
  bool limit = row.id == FunctionId::kLimit;
  if (limit) std::swap(places[0], places[1]);  // IN, then at least MN, then at most MX
  ir::Place result = temporary_place(type);
  build_.copy(result, places[0]);
  for (size_t i = 1; i < places.size(); ++i) {
    bool largest = limit ? i == 1 : row.id == FunctionId::kMax;
    BinaryOp better = largest ? BinaryOp::kGt : BinaryOp::kLt;
    ir::BlockId take = build_.new_block();
    ir::BlockId next = build_.new_block();
    build_.branch(code_.compare_places(better, places[i], result), take, next);
    build_.start(take);
    build_.copy(result, places[i]);
    build_.jump(next);
    build_.start(next);
  }
  return result;
}

// SEL and MUX of strings, structures and arrays.
ir::Place StandardCode::choose(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                               ir::TypeId type) {
  bool select = row.id == FunctionId::kSel;
  if (ir::holds_instance(types(), type)) {
    error(DiagnosticCode::kNotAssignable, tree_[args[1]].span,
          "instances of `" + sema_.report.type_text(type) + "` are no values to choose from",
          "use IF, or choose between pointers to them");
    return place(args[1]);
  }
  ir::Place result = temporary_place(type);
  Typed selector =
      select ? Typed{value(args[0], elementary(ir::Kind::kBool)), elementary(ir::Kind::kBool)}
             : natural(args[0]);
  ir::ValueId number =
      code_.machine_convert(selector.value, scalar(selector.type), ir::Scalar::kI64);
  std::vector<ir::Place> choices;
  for (size_t i = 1; i < args.size(); ++i) choices.push_back(place(args[i]));
  build_.copy(result, choices[0]);
  for (size_t i = 1; i < choices.size(); ++i) {
    ir::BlockId take = build_.new_block();
    ir::BlockId next = build_.new_block();
    ir::ValueId at = build_.constant(ir::Scalar::kI64, i);
    build_.branch(build_.compare(ir::Op::kLe, ir::Scalar::kI64, at, number), take, next);
    build_.start(take);
    build_.copy(result, choices[i]);
    build_.jump(next);
    build_.start(next);
  }
  return result;
}

}  // namespace frontend
