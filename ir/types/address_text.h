// Direct addresses as text: "%IX0.3", "%QW4", "%MD10". Of one place, not hierarchical.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/types/types.h"

namespace ir {

// I, Q, M; kNone for any other letter. Case does not matter.
DirectArea area_of_letter(char letter);
// X, B, W, D, L: 1 to 64; 0 for any other letter.
uint32_t bits_of_letter(char letter);
// The whole of `text`; nullopt where it is none, or lies beyond 2^32 bits. `%I0.3` is `%IX0.3`.
std::optional<DirectAddress> parse_address(std::string_view text);
// As parse_address() reads it.
std::string address_text(const DirectAddress& address);

}  // namespace ir
