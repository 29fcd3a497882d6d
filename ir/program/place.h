// Walks the steps of a place from its base, checking each against the type it
// stands on (ir.h, "Places"). The one definition of what a place means: printer,
// parser and verifier use it.
#pragma once

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

struct PlaceState {
  TypeId type;
  bool entered = false;     // the own variables of an instance, or the globals
  bool slot = false;        // an in-out slot, not yet followed by kDeref
  uint32_t dimensions = 0;  // index steps taken of the array `type`

  // May an instruction name it? Not inside an array's dimensions, not an instance's whole area.
  bool complete() const { return !entered && dimensions == 0; }
};

// Type of the base itself, from what the place names; an Error when that does not exist.
base::Result<PlaceState> place_base(const Program& program, const Pou& pou, const Place& place);
base::Result<PlaceState> place_step(const TypeTable& types, const PlaceState& from,
                                    const Step& step);
// All steps. Also checks base_type and type of `place` against what the walk finds.
base::Result<PlaceState> check_place(const Program& program, const Pou& pou, const Place& place);

}  // namespace ir
