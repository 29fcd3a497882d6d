// Global variables that are visible with a prefix only have names with dots: `List.x` of a list,
// `A.B.x` of a namespace, `Count.all` of a static variable.
#pragma once

#include <string_view>

#include "ir/types/types.h"

namespace ir {

// What of `path` is such a name; "": it begins with none.
std::string_view listed_name(const TypeTable& types, TypeId globals, std::string_view path);

}  // namespace ir
