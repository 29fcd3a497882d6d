// Networks as other tools have to understand them.
#pragma once

#include <string_view>

#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace plcopen {

inline constexpr std::string_view kDisabledMark = "disabled:\n";

// A disabled network shows its elements in its last comment, behind that mark, and has none: others
// would execute them.
frontend::network::Body for_others(frontend::network::Body body);

// IEC 61131-10 has no place for what is only shown so, nor for titles. One note for a body.
void report_heads(const frontend::network::Body& body, base::Diagnostics& diagnostics);

}  // namespace plcopen
