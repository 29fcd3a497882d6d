// What is said of a name that two declarations bring: both places, the other one in words.
#pragma once

#include <string>
#include <string_view>

#include "base/source.h"

namespace frontend {

// "`Main` is declared twice; first declared in line 3", with the file where that is another one.
std::string declared_twice(const base::SourceMap& sources, std::string_view name,
                           base::SourceSpan here, base::SourceSpan other);

}  // namespace frontend
