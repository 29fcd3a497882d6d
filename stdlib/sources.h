// The part of the standard library that is written in ST (stdlib/st/*.st), embedded at build time.
#pragma once

#include <span>
#include <string_view>

namespace stdlib {

struct LibrarySource {
  std::string_view name;  // "<stdlib>/timers.st"
  std::string_view text;
};
std::span<const LibrarySource> library_sources();

}  // namespace stdlib
