// A drawing that was imported -> the text that comes in for it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "frontend/network/network.h"

namespace xml {

struct DiagramText {
  std::string text;  // LADDER ... END_LADDER or FBD ... END_FBD
  std::string rows;  // of a ladder that became FBD: those of the text; else empty
};

// Why a ladder became FBD (W0075); the network that made it so, from 1, or 0.
using AsFbd = std::function<void(uint32_t network, const std::string& why)>;

// A ladder that has no form as text becomes FBD. No wire is called like a name in `taken`.
DiagramText diagram_text(const frontend::network::Body& body, std::string_view taken,
                         const AsFbd& as_fbd);

}  // namespace xml
