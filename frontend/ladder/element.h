// What stands in the brackets of one element -> elements of the network.
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "frontend/ladder/rungs.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/network/network.h"

namespace frontend::ladder {

// Where power comes into what was made of one piece, and where it goes on.
struct Made {
  uint32_t element = 0;  // in Network::elements
  uint32_t input = 0;
  network::Link out;
};

// Appends to `network`; nullopt when reported (E1046). `text` holds the piece's bytes;
// `declarations`: as in read.h.
std::optional<Made> make_element(std::string_view text, base::SourcePos begin, const Piece& piece,
                                 network::Network& network, base::Diagnostics& diagnostics,
                                 const DeclarationIndex* declarations);

}  // namespace frontend::ladder
