// Names as messages show them.
#pragma once

#include <string>
#include <string_view>

#include "frontend/parse/tree.h"

namespace frontend {

inline std::string quoted(std::string_view name) { return "`" + std::string(name) + "`"; }
inline std::string quoted(const Name& name) { return quoted(name.text); }

}  // namespace frontend
