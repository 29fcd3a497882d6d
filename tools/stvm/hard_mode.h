// Hard modes (docs: style of tests): every program must come out the same when it is suspended
// at every safe point, exchanged for itself at every boundary, or moved as a whole.
#pragma once

#include <string>

#include "base/result.h"
#include "online_change/apply/change.h"
#include "tools/stvm/compiler.h"

namespace stvm {

enum class HardMode : uint8_t { kNone, kFuel1, kIdentity, kMove };
base::Result<HardMode> parse_hard_mode(const std::string& text);

// kMove relinks, so it needs sources.
base::Status check_hard_mode(HardMode mode, const Sources& sources);

// At a boundary: changes the running program to itself under another name (kIdentity), or to itself
// with every instance at another place (kMove; relinked by stc from `sources`).
base::Status apply_hard_mode(HardMode mode, const Sources& sources, vm::Controller& controller);

}  // namespace stvm
