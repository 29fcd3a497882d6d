// A drawing that was imported -> the text that comes in for it.
#pragma once

#include <string>
#include <string_view>

#include "adapters/xml/document.h"
#include "frontend/network/network.h"

namespace xml {

struct DiagramText {
  std::string text;  // LADDER ... END_LADDER or FBD ... END_FBD
  std::string rows;  // of a ladder that became FBD: those of the text; else empty
};

// A ladder that has no form as text becomes FBD, and a note says why (W0075), at `drawing`. No wire
// is called like a name in `taken`.
DiagramText diagram_text(const frontend::network::Body& body, Node drawing, std::string_view taken,
                         Reporter& report);

}  // namespace xml
