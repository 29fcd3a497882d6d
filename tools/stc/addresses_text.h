// `stc dump --addresses`: what stands at which address of an image.
#pragma once

#include <string>

#include "ir/bytecode/image.h"

namespace stc {

// A line for each variable, by area and address. `AT %I*` after one whose declaration leaves the
// address open: VAR_CONFIG or the linker gave it.
std::string addresses_text(const ir::Image& image);

}  // namespace stc
