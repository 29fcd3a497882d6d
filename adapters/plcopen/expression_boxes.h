// Expressions of wires (network/expressions.h) for editors that know none: boxes of functions.
#pragma once

#include <optional>

#include "frontend/network/network.h"

namespace plcopen {

// `o := e * 2.0 + a` becomes a box MUL and a box ADD in front of what uses them; what has no wire
// in it stays a text at their inputs. The span of an expression that functions cannot say: an
// element of an array at the index of a wire, a part of a wire; `body` is not complete then.
std::optional<base::SourceSpan> expressions_to_boxes(frontend::network::Body& body);

}  // namespace plcopen
