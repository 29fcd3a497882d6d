// Characters of strings: s[i]. Positions are checked against the capacity.
#include "frontend/lower/places.h"
#include "frontend/lower/value_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/constants/constants.h"

namespace frontend {

using stdlib::NativeId;

bool Places::is_character(ExprId id) {
  const Expr& expr = tree_[id];
  return expr.kind == ExprKind::kIndex && is_string(types(), infer(expr.operand).type);
}

// From 0, whatever the dialect counts from.
ir::ValueId Places::character_position(const Expr& expr) {
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  ExprId index = tree_.expr_lists[expr.list.first];
  int64_t first = sema_.options.dialect == Dialect::kIec ? 1 : 0;
  if (infer(index).constant) {
    int64_t position = ask<Constants>().fold_integer(index).value_or(first) - first;
    return build_.constant(kI64, static_cast<uint64_t>(position));
  }
  uint32_t capacity = types()[infer(expr.operand).type].capacity;
  Typed given = natural(index);
  ir::ValueId position = code_.machine_convert(given.value, scalar(given.type), kI64);
  if (first != 0) position = build_.binary(ir::Op::kSub, kI64, position, build_.constant(kI64, 1));
  // As one unsigned comparison: a negative position is a huge one.
  ir::ValueId number = build_.unary(ir::Op::kWrap, ir::Scalar::kU64, position);
  uint32_t last = first != 0 ? capacity - 1 : capacity;
  ir::ValueId end = build_.constant(ir::Scalar::kU64, last);
  ir::BlockId good = build_.new_block();
  ir::BlockId bad = build_.new_block();
  build_.branch(build_.compare(ir::Op::kLe, ir::Scalar::kU64, number, end), good, bad);
  build_.start(bad);
  build_.trap(ir::TrapKind::kIndex);
  build_.start(good);
  return position;
}

ir::ValueId Values::emit_character(const Expr& expr) {
  ir::Place string = place(expr.operand);
  return code_.load_character(string, ask<Places>().character_position(expr));
}

ir::ValueId ValueCode::load_character(const ir::Place& string, ir::ValueId position) {
  bool is_wide = wide(string.type);
  NativeId id = is_wide ? NativeId::kCharacterW : NativeId::kCharacterS;
  ir::ValueId character = native(id, {string_value(string), position});
  return build_.unary(ir::Op::kWrap, is_wide ? ir::Scalar::kU16 : ir::Scalar::kU8, character);
}

void ValueCode::store_character(const ir::Place& string, ir::ValueId position, ir::ValueId value) {
  NativeId id = wide(string.type) ? NativeId::kSetCharacterW : NativeId::kSetCharacterS;
  ir::ValueId unit = build_.unary(ir::Op::kWrap, ir::Scalar::kU64, value);
  native(id, {string_value(string), position, unit});
}

}  // namespace frontend
