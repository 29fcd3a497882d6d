// Names are compared without case (IEC 61131-3, 6.1.2), also letters beyond ASCII: Latin, Greek and
// Cyrillic letters whose two forms are both two bytes in UTF-8, so folding keeps the length.
// Anything else stays as written. Bytes that are no UTF-8 are folded as if each stood alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace base {

bool same_letters(std::string_view a, std::string_view b);  // of names of one length
inline bool same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && same_letters(a, b);
}
std::string fold_name(std::string_view name);
void fold_name(std::string_view name, char* out);  // as many bytes as the name has
// Equal for equal names.
uint64_t name_hash(std::string_view name);

}  // namespace base
