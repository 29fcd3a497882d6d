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
uint64_t target_count(const Inst& inst);  // that it must have
// May a switch of that type begin or end with the number?
bool fits_switch(Scalar scalar, int64_t number);
// Where kBranch or kSwitch goes on for that value.
const Target& taken_target(const Inst& end, uint64_t bits);

}  // namespace ir
