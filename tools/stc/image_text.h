// An image's tables for people: areas, instances, POUs, tasks, I/O.
#pragma once

#include <string>

#include "base/hash.h"
#include "ir/bytecode/image.h"

namespace stc {

// The layout without hash and code sizes: what a golden file of mode link shows.
std::string layout_text(const ir::Image& image);
std::string image_text(const ir::Image& image, const base::Digest& digest);
// "path : type @ offset" for every leaf variable.
std::string symbols_text(const ir::Image& image);

}  // namespace stc
