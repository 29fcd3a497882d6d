// Networks -> the text forms, drawn as `stc fmt` draws them. What read() makes of the text is
// the same body again, but for positions, ids and spans.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "frontend/network/network.h"

namespace frontend::network {

// The rows between LADDER and END_LADDER, each with `indent` spaces. nullopt when a network
// cannot be drawn as series and parallel branches of what ladder/read.h has, or `body` is FBD:
// write_fbd() can write it then. Contacts may be read earlier or later than in `body`, but not on
// the other side of what writes them (same.h, kAsRead).
std::optional<std::string> write_ladder(const Body& body, uint32_t indent);

// Why write_ladder() refuses a ladder of this network alone. Empty: it does not.
std::string ladder_problem(const Network& network);

// The rows between FBD and END_FBD; of ladder, too: contacts become AND, joins OR, power TRUE.
// Coils and sinks that nothing is connected to are left out. No wire is called like a name in
// `taken`, which may be any text: the variables around the body.
std::string write_fbd(const Body& body, uint32_t indent, std::string_view taken = {});

}  // namespace frontend::network
