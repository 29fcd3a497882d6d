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

// Does the source belong to the library of the standard's own dialect, or else of the others?
constexpr bool is_of_dialect(const LibrarySource& source, bool iec) {
  return source.dialects != (iec ? LibraryDialects::kVendors : LibraryDialects::kIec);
}

}  // namespace stdlib
