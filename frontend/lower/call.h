// One argument of a call on its way from expression to parameter.
#pragma once

#include "frontend/lower/target.h"
#include "frontend/parse/tree.h"

namespace frontend {

struct Binding {
  VarId variable;
  const Arg* arg;
  ir::ValueId value;               // input: scalar; in-out: address
  std::optional<ir::Place> place;  // input: string or aggregate
  std::optional<Target> target;    // output
};

std::string quoted_name(const Name& name);

}  // namespace frontend
