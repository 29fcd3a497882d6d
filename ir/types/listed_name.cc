#include "ir/types/listed_name.h"

#include "ir/types/shared_bytes.h"

namespace ir {

std::string_view listed_name(const TypeTable& types, TypeId globals, std::string_view path) {
  std::string_view found;
  const auto look = [&](const Member& member) {
    const size_t size = member.name.size();
    const bool ends =
        size == path.size() || (size < path.size() && (path[size] == '.' || path[size] == '['));
    if (!ends || member.name.find('.') == std::string::npos) return;
    if (!found.empty() && found.size() <= size) return;
    if (same_name(path.substr(0, size), member.name)) found = path.substr(0, size);
  };
  for (const Member& member : types[globals].members) {
    look(member);
    if (!is_shared(types, member)) continue;
    for (const Member& view : types[member.type].members) look(view);
  }
  return found;
}

}  // namespace ir
