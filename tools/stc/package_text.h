// A change package for people: what it was made for, and its update records (A3, C3) in both
// directions, with names and addresses.
#pragma once

#include <string>

#include "online_change/package/package.h"

namespace stc {

// `old_image`: the one it was made for, `new_image`: the one that it carries.
std::string package_text(const online_change::Package& package, const ir::Image& old_image,
                         const ir::Image& new_image);

}  // namespace stc
