// Histograms of a task, as bars and as JSON.
#pragma once

#include <string>

#include "vm/runtime/controller.h"

namespace stvm {

// At most 80 columns; a line for each power of two that occurs, and those between.
std::string times_text(const vm::TaskTimes& times);
std::string times_json(const vm::TaskTimes& times);

}  // namespace stvm
