// What an image is made of, and what a fleet file changes, for people (E-04, E-08).
#pragma once

#include <string>

#include "base/result.h"
#include "ir/bytecode/image.h"

namespace stc {

// Each part with its identity, and for units what their code holds of others (ir::HeldName).
std::string parts_text(const ir::Image& image);
base::Result<std::string> fleet_file_text(const std::string& path);

}  // namespace stc
