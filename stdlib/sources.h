// The part of the standard library that is written in ST (stdlib/st/*.st), embedded at build time.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace stdlib {

// Where CODESYS and TwinCAT have another interface under the same name, there are two sources.
enum class LibraryDialects : uint8_t { kAll, kIec, kVendors };

struct LibrarySource {
  std::string_view name;  // "<stdlib>/timers.st"
  std::string_view text;
  LibraryDialects dialects;
};
std::span<const LibrarySource> library_sources();

}  // namespace stdlib
