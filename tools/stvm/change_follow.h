// stvm change --watch: each save of the sources becomes a change of the running program.
#pragma once

#include "tools/stvm/compiler.h"
#include "tools/stvm/switch_steps.h"

namespace stvm {

// Keeps an stc that builds at each save (stc package --watch) and brings what it makes to the
// controller, under the rules of a single change. What is refused leaves the running program as it
// is, says why, and the next save is another try. While a change is on trial, saves wait for its
// end. Until it is ended by a signal, or controller or stc are gone. The exit code.
int follow(const Sources& sources, const SwitchOptions& options, ControllerClient& client);

}  // namespace stvm
