// Leaves page by page: what for_each_leaf() of symbols.h visits, from one of them on.
#pragma once

#include <functional>
#include <string>

#include "ir/bytecode/symbols.h"

namespace ir {

// From leaf number `first` on, until `visit` is false. Elements of an array that come before are
// not looked at, so a page of a large array costs what is on it.
void for_each_leaf_from(
    const Image& image, uint64_t first,
    const std::function<bool(const std::string& path, const Symbol& symbol)>& visit);

}  // namespace ir
