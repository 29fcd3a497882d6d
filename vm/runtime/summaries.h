// Times of scans as reports show them.
#pragma once

#include <vector>

#include "vm/runtime/controller.h"
#include "vm/runtime/histogram.h"

namespace vm {

TimeSummary summary_of(const Histogram& times);
// The classes with at least one entry.
std::vector<TimeClass> classes_of(const Histogram& times);

}  // namespace vm
