#include "ir/types/listed_name.h"

namespace ir {

std::string_view listed_name(const TypeTable& types, TypeId globals, std::string_view path) {
  std::string_view found;
  for (const Member& member : types[globals].members) {
    const size_t size = member.name.size();
    const bool ends =
        size == path.size() || (size < path.size() && (path[size] == '.' || path[size] == '['));
    if (!ends || member.name.find('.') == std::string::npos) continue;
    if (!found.empty() && found.size() <= size) continue;
    if (same_name(path.substr(0, size), member.name)) found = path.substr(0, size);
  }
  return found;
}

}  // namespace ir
