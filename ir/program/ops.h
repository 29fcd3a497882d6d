// The table of instructions (ops.def) as data.
#pragma once

#include <cstdint>
#include <string_view>

#include "ir/program/ir.h"

namespace ir {

inline constexpr uint32_t kOpCount = 0
#define OP(id, text, operands, result) +1
#include "ir/program/ops.def"
#undef OP
    ;

std::string_view op_name(Op op);
int op_operand_count(Op op);  // -1: any number
bool op_has_result(Op op);
bool is_terminator(Op op);

}  // namespace ir
