// A compile-time value: exact until its type is known.
#pragma once

#include <optional>
#include <string>

#include "frontend/sema/model.h"

namespace frontend {

using Wide = __int128;

struct Constant {
  enum class Form : uint8_t { kInteger, kReal, kText, kAggregate };
  Form form = Form::kInteger;
  Flex flex = Flex::kNone;
  bool literal = false;  // a typed literal, INT#5, or an operation on one
  bool pattern = false;  // written with 2# 8# 16#, or AND OR XOR of such: bits, not a number
  ir::TypeId type;       // valid unless `flex` says that the context decides
  Wide integer = 0;      // also BOOL, bit strings, times, enumerations, characters
  double real = 0;
  std::string text;       // STRING: bytes, WSTRING: UTF-16LE
  ir::ConstId aggregate;  // an initial value in the program's table
};

// Limits of an integer machine scalar, as exact numbers.
struct Limits {
  Wide low = 0;
  Wide high = 0;
};
Limits limits_of(ir::Scalar scalar);
// Low bits of `value` in `scalar`, extended as ir::ConstValue::bits wants it.
Wide wrap_to(ir::Scalar scalar, Wide value);
std::string wide_text(Wide value);

class Sema;
// The value of a call of a standard function, or of a power, whose operands are known;
// `context` as for Sema::fold. Implemented by lower/constant_evaluation.cc, which knows what calls
// do.
std::optional<Constant> evaluate_constant(Sema& sema, const PouScope& scope, ExprId expr,
                                          ir::TypeId context);
// A scalar of `type` from its bits.
Constant scalar_constant(const ir::TypeTable& types, ir::TypeId type, uint64_t bits);

}  // namespace frontend
