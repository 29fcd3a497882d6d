// Between parsing and sema: what charts mean as declarations. Every step becomes a
// variable of type __SFC_STEP with the step's name, every action one of type __SFC_ACTION
// (stdlib/st/sfc.st) with the action's name, or `name#action` where the action is a
// variable itself. So step flags are watched, retained and taken over by an online change
// as all variables are: by name. Charts are checked on the way.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "frontend/parse/tree.h"

namespace frontend::sfc {

inline constexpr const char* kStepType = "__SFC_STEP";
inline constexpr const char* kActionType = "__SFC_ACTION";
// TIME of the last call; that of a block with a base has the block in front, since the base's body
// is another one and may be a chart as well: `Block.sfc#clock`.
inline constexpr const char* kClock = "sfc#clock";
std::string clock_name(const PouDecl& pou);
inline constexpr const char* kRecordSuffix = "#action";

void declare_charts(Tree& tree, const base::SourceMap& sources, base::Diagnostics& diagnostics);

}  // namespace frontend::sfc
