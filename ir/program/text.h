// The IR as text, printed for golden tests and `stc dump --ir`, and parsed back:
// parse(print(p)) is p for every verified p. The parser takes any bytes; what it
// does not understand is kBadFormat with line and reason. Result is not verified.
//
// One declaration or instruction per line; indentation is free; `//` starts a
// comment. NAME is a word, or '...' with $ escapes when it has other characters.
// %N is the type number N (the elementary types are 0..24), #N the constant N.
//
//   program NAME
//   type NAME = DEFINITION [init #N]       DEFINITION is one of
//   type %N [NAME] = DEFINITION ...          string 20 | wstring 20 | subrange TYPE 0..10
//                                            array TYPE [1..3, 0..9] | enum TYPE (Red = 0, ...)
//                                            pointer TYPE | ref_to TYPE | reference_to TYPE
//                                            struct [overlap] | union | program | globals
//                                            function_block [extends TYPE] [implements TYPE, ..]
//                                            interface [implements TYPE, ..]
//     member SECTION NAME : TYPE [constant] [retain] [init #N] [at AREA bit size]
//   const #N = 42 | 'bytes' | {2 = #0, 5 * 3 = #1}      member or element = value; first * count
//   globals TYPE
//   task NAME period 10000000 [watchdog ns] priority 0      task NAME once priority 0
//   instance NAME : TYPE task 0 [init #N]
//   override TYPE : POU = POU             of what type a virtual call of which runs which
//   pou KIND NAME [self TYPE] [recursion N] [file '..' line 3] [hash HEX]
//                                          KIND: function function_block program method
//     local KIND NAME : TYPE               KIND: input output in_out return temp
//   b0:                                    blocks in order, the entry first
//   b1(v4:i16, v5:bool) handler b7:        parameters; handler of the try around it
//     v0 = const i16 5 @12                 @: source line
//     v1 = load i16 self.motors[2][v0].speed
//     store i16 local.x, v1
//     copy global.a, self.b        init self.a [, #N]
//     v6 = handle u64 self.x       v7 = move_handle u64 v6, v8  v9 = size_of u32 TYPE
//     v2 = add i16 v0, v1          v3 = eq i16 v0, v1          v4 = check_range i16 v2, 0..10
//     call Limit                   call_instance self.timer    v5 = native i32 LEN/i:S v6
//     v6 = this u64                v7 = is_type bool v6, Motor             v8 = trap_kind u32
//     call_method 'Motor.start'[, self.motor | , v6]       call_body Motor
//     call_virtual 'Motor.start', v6                       call_reference v6, Motor
//     try b1, b2                   end_try b3
//     jump b1(v2, v3)              branch v3, b1(v2, v3), b2   return        trap assert
//
// The scalar stands after the operation where it has a meaning. Places: local,
// arg(FUNCTION), self, global, const(#N : TYPE), pointee(v0 : TYPE), target(v0 : TYPE), then steps:
// .member [index] ! (kEnter) ^ (kDeref). TYPE is a name, or %N where the name is
// missing or not unique; likewise .#N is the member or local with number N.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

std::string print(const Program& program);
std::string print(const Program& program, const Pou& pou);
base::Result<Program> parse_program(std::string_view text);

}  // namespace ir
