// A condition of a trial as people write it: an expression of Structured Text.
//
//   Line.Rate > 0.95 * baseline(Line.Rate) AND NOT Line.Stopped
//
// Operators and their order are those of the language: OR, XOR, AND (&), = <>, < > <= >=, + -,
// * / MOD, NOT and the sign. Calls are ABS, MIN and MAX, and baseline(), which is what a variable
// was behind the switch. Nothing else can be called, so nothing is written and nothing loops.
#pragma once

#include <string>

#include "tools/stvm/trial_guard_order.h"

namespace stvm {

// Adds it and the variables that it names. kBadValue; `at`: the byte of `text` that is wrong.
base::Status add_condition(const std::string& text, GuardOrder& order, size_t& at);

}  // namespace stvm
