// What a call expression calls, and which argument is for which parameter.
#pragma once

#include "frontend/sema/conversion.h"
#include "frontend/sema/model.h"
#include "frontend/sema/reference_calls.h"
#include "frontend/sema/test_calls.h"
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
  };
  Kind kind = Kind::kError;
  uint32_t pou = kNoPou;  // kFunction; kInstance: the block's POU
  const stdlib::FunctionRow* row = nullptr;
  ir::TypeId typed;  // ADD_INT: the type of the operands; invalid: they decide
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

}  // namespace frontend
