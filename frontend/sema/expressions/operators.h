// Facts about binary operators that typing, folding and lowering share.
#pragma once

#include <string_view>

#include "frontend/parse/tree.h"

namespace frontend {

enum class OperatorClass : uint8_t { kLogical, kComparison, kArithmetic };

inline OperatorClass operator_class(BinaryOp op) {
  if (op <= BinaryOp::kAndThen) return OperatorClass::kLogical;
  return op <= BinaryOp::kGe ? OperatorClass::kComparison : OperatorClass::kArithmetic;
}

std::string_view operator_text(BinaryOp op);

inline bool is_long_time(ir::Kind kind) {
  return kind == ir::Kind::kLtime || kind == ir::Kind::kLdate || kind == ir::Kind::kLtod ||
         kind == ir::Kind::kLdt;
}

}  // namespace frontend
