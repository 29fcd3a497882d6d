// What an opcode becomes, where one row says it all.
#pragma once

#include "vm/native/lir.h"

namespace vm::native {

enum class Shape : uint8_t {
  kHelper,  // by its handler
  kMove,
  kBinary,       // a := b op c
  kUnary,        // a := op b
  kCompare,      // a := b cond c
  kDivide,       // with a check of c; `is_signed`
  kShift,        // c is 4 bytes wide
  kExtreme,      // a := c cond b ? c : b
  kAbsolute,     // of a signed integer
  kChoose,       // if b then a := c
  kExtend,       // of `from` bytes, `is_signed`
  kSame,         // the low bytes of b are the result
  kToBool,       // b <> 0
  kFromInteger,  // a number of `from` bytes, `is_signed`, to floating point
  kToInteger,    // floating point of `from` bytes, to `width`; `towards_zero`
  kCheckRange,
  kCheckStep,
  kLoadAt,
  kStoreAt,
  kLoadFar,
  kStoreFar,
  kIndex,
  kIndexPlace,
  kSpecial,  // build_special.cc
};

struct Recipe {
  Shape shape = Shape::kHelper;
  Op op = Op::kConst;
  uint8_t width = 0;
  uint8_t from = 0;
  Cond cond = Cond::kEq;
  bool is_signed = false;
  bool floating = false;
  bool towards_zero = false;
};
const Recipe& recipe_of(ir::Opcode op);

}  // namespace vm::native
