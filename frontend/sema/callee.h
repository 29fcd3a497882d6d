// What a call expression calls, and which argument is for which parameter.
#pragma once

#include "frontend/sema/expressions/reference_calls.h"
#include "frontend/sema/model.h"
#include "frontend/sema/tests/test_calls.h"
#include "frontend/sema/types/conversion.h"
#include "stdlib/registry.h"

namespace frontend {

// What the head of a call expression means.
struct Callee {
  enum class Kind : uint8_t {
    kError,
    kFunction,
    kInstance,
    kStandard,
    kConversion,
    kBound,
    kTest,
    kReference,
    kMethod,
    kBase,
  };
  Kind kind = Kind::kError;
  // kFunction, kMethod; kInstance: the block; kBase: SUPER^(), the base of the own block
  uint32_t pou = kNoPou;
  const stdlib::FunctionRow* row = nullptr;
  bool wide = false;  // WLEN: strings are WSTRING
  ir::TypeId typed;   // ADD_INT: the type of the operands; invalid: they decide
  Conversion conversion;
  const TestCallRow* test = nullptr;
  ReferenceCall reference = ReferenceCall::kNone;
  bool upper = false;  // kBound: UPPER_BOUND, else LOWER_BOUND
};

// An argument and the parameter that it is for.
struct Match {
  VarId parameter;
  const Arg* arg;
};

// The operator that a standard function of rule kArithmetic, kBitwise or kCompare is.
BinaryOp standard_operator(stdlib::FunctionId id);
// How many leading arguments of a string function are strings.
uint32_t string_arguments(const stdlib::FunctionRow& row, uint32_t count);

}  // namespace frontend
