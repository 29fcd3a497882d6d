// Between parsing and sema: what charts mean as declarations. Every step becomes a
// variable of type __SFC_STEP with the step's name, every action one of type __SFC_ACTION
// (stdlib/st/sfc.st) with the action's name, or `name#action` where the action is a
// variable itself. So step flags are watched, retained and taken over by an online change
// as all variables are: by name. Charts are checked on the way.
#pragma once

#include "base/diagnostics.h"
#include "frontend/parse/tree.h"

namespace frontend::sfc {

inline constexpr const char* kStepType = "__SFC_STEP";
inline constexpr const char* kActionType = "__SFC_ACTION";
inline constexpr const char* kClock = "sfc#clock";  // TIME of the last call
inline constexpr const char* kRecordSuffix = "#action";

void declare_charts(Tree& tree, base::Diagnostics& diagnostics);

}  // namespace frontend::sfc
