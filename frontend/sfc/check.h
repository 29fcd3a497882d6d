// What can be said about a chart from its net alone: names that mean nothing, the initial
// step, and, by playing the net through with every condition free, steps that are never
// entered, transitions that never fire, and branches that meet where they must not.
#pragma once

#include "base/diagnostics.h"
#include "frontend/sfc/net.h"

namespace frontend::sfc {

// `pou` is the name of the POU whose body the chart is.
void check(const Chart& chart, const Net& net, const Name& pou, const base::SourceMap& sources,
           base::Diagnostics& diagnostics);

}  // namespace frontend::sfc
