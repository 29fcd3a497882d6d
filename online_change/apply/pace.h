// How fast this machine does the work of a switch (change case 69). The model of the pause
// (online_change/plan/pause.h) has the times of one machine, so some hundred values that belong to
// nobody are carried over here as a switch does it, in memory of their own, and timed.
#pragma once

#include "vm/runtime/ports.h"

namespace online_change {

// How long this machine takes, as a multiple of what the model says; that takes it a quarter of a
// millisecond. 1 where no time passes on `clock`: virtual time has the model's.
double measured_pace(vm::Clock& clock);

}  // namespace online_change
