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
  // Names that it declares, separated by blanks: functions and function blocks; types and
  // enumerators.
  std::string_view pous;
  std::string_view types;
};
std::span<const LibrarySource> library_sources();

// `iec`: does that include the standard's own dialect? Otherwise: those of CODESYS and TwinCAT?
constexpr bool are_of_dialect(LibraryDialects dialects, bool iec) {
  return dialects != (iec ? LibraryDialects::kVendors : LibraryDialects::kIec);
}
// Does the source belong to the library of that dialect?
constexpr bool is_of_dialect(const LibrarySource& source, bool iec) {
  return are_of_dialect(source.dialects, iec);
}

}  // namespace stdlib
