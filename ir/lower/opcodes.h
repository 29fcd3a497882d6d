// Which instruction an IR operation becomes, by scalar type. Tables are made from
// opcodes.def; kNoOpcode where the table has no such instruction.
#pragma once

#include "ir/bytecode/code.h"
#include "ir/program/ir.h"

namespace ir::codegen {

inline constexpr Opcode kNoOpcode = static_cast<Opcode>(kOpcodeCount);

// Arithmetic, logic and comparison: a := b op c (or op b).
Opcode operation_opcode(Op op, Scalar scalar);
Opcode greater_opcode(Scalar scalar);           // GT
Opcode greater_or_equal_opcode(Scalar scalar);  // GE
Opcode move_opcode(Class cls);
Opcode conditional_move_opcode(Class cls);
Opcode load_opcode(Class cls);            // through an addr
Opcode store_opcode(Class cls);           // through an addr
Opcode index_opcode(Scalar index);        // of an array behind an addr
Opcode index_place_opcode(Scalar index);  // of an array at a place
Opcode check_range_opcode(Scalar scalar);
Opcode switch_opcode(Scalar scalar);
Opcode check_step_opcode(Scalar scalar);
// Conversions; kNoOpcode also where nothing needs to be done.
Opcode extend_opcode(Scalar from, Scalar to);  // by the sign of `from`
Opcode narrow_opcode(Scalar from, Scalar to);
Opcode to_float_opcode(Scalar from, Scalar to);
Opcode round_opcode(Scalar from, Scalar to);
Opcode truncate_opcode(Scalar from, Scalar to);
Opcode to_bool_opcode(Scalar from);
Opcode bits_opcode(Scalar from, Scalar to);

}  // namespace ir::codegen
