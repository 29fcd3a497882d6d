#include "ir/bytecode/variable_names.h"

#include "base/joined.h"
#include "base/nearest_name.h"
#include "ir/bytecode/leaf_walk.h"
#include "ir/bytecode/name_index.h"
#include "ir/types/address_text.h"
#include "ir/types/location.h"
#include "ir/types/shared_bytes.h"

namespace ir {
namespace {

base::Error not_there(std::string_view name, std::initializer_list<std::string_view> why) {
  return {base::Refusal::kNoSuchVariable, base::joined({"`", name, "`: ", base::joined(why)})};
}

// "Main", ".", "pumps[1]": up to the next dot outside of brackets.
size_t end_of_part(std::string_view path, size_t at) {
  int depth = 0;
  for (; at < path.size() && (depth > 0 || path[at] != '.'); ++at) {
    depth += path[at] == '[' ? 1 : path[at] == ']' ? -1 : 0;
  }
  return at;
}

// What the first part that is not there was meant to be. Globals of lists and namespaces have a dot
// in their name, so they are compared with as much of the path.
std::string meant(const NameIndex& names, std::string_view path, std::string_view why) {
  // Of a list that is no part of names find_symbol() has said what to write.
  if (why.find("qualified_only") != why.npos) return {};
  const Image& image = names.image();
  TypeId owner = image.globals;
  size_t at = 0;
  for (size_t end = end_of_part(path, 0); end < path.size(); end = end_of_part(path, end + 1)) {
    const base::Result<Symbol> symbol = find_symbol(names, path.substr(0, end));
    if (!symbol.ok()) continue;
    owner = symbol->type;
    at = end + 1;
  }
  const std::string_view rest = path.substr(at);
  const std::string_view name = rest.substr(0, rest.find_first_of(".["));
  const size_t next = std::min(name.size() + 1, rest.size());
  base::NearestName nearest(name);
  base::NearestName listed(rest.substr(0, rest.find_first_of(".[", next)));
  for (const Member& member : image.types[owner].members) {
    if (same_name(member.name, name)) return {};  // it is there, and what is wrong stands after it
    if (!is_listed(member)) continue;
    const std::string_view whole = member.name;
    const std::string_view last = whole.substr(whole.rfind('.') + 1);
    if (last.size() != whole.size() && same_name(last, name)) {
      return base::joined({"; did you mean `", whole, "`?"});
    }
    (member.name.find('.') == std::string::npos ? nearest : listed).offer(member.name);
  }
  if (at == 0) {
    for (uint32_t id : names.programs()) {
      nearest.offer(image.instances[id].name);
      nearest.offer(image.types[image.instances[id].type].name);
    }
  }
  return nearest.best().empty() ? listed.question() : nearest.question();
}

// Which variable stands for `wanted`, or for the bit at that place of an array of BOOL.
base::Result<std::string> located(const Image& image, std::string_view name,
                                  const DirectAddress& wanted) {
  std::string around;
  const std::vector<Member>& globals = image.types[image.globals].members;
  for (const Member& global : globals) {
    const bool bit = wanted.bit_size == 1 && global.address.area == wanted.area;
    if (!bit || !is_shared(image.types, global)) continue;
    const std::vector<Member>& members = image.types[global.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (shared_address(image.types, global, i) == wanted) return members[i].name;
    }
  }
  for (const IoBinding& row : image.io) {
    if (row.address.area != wanted.area || wanted.bit_offset < row.address.bit_offset) continue;
    const uint32_t behind = wanted.bit_offset - row.address.bit_offset;
    const uint64_t bools = located_bools(image.types, row.type, row.address);
    const bool one_of_bools = wanted.bit_size == 1 && behind < bools;
    if (one_of_bools && image.types[row.type].kind == Kind::kArray) {
      return path_of(image, {.data = row.data + behind, .type = image.types[row.type].base});
    }
    if (row.address == wanted) return path_of(image, {.data = row.data, .type = row.type});
    if (behind < row.address.bit_size) {
      const std::string path = path_of(image, {.data = row.data, .type = row.type});
      around = base::joined({path, " AT ", address_text(row.address)});
    }
  }
  if (!around.empty()) return not_there(name, {"is a part of ", around, "; name that variable"});
  return not_there(name, {"no variable of the program stands for this address"});
}

// The path with the instance's name in place of its PROGRAM's; "": it begins with none.
base::Result<std::string> by_program(const NameIndex& names, std::string_view path) {
  const Image& image = names.image();
  const std::string_view declared = path.substr(0, path.find_first_of(".["));
  std::string instances;
  std::string found;
  uint32_t count = 0;
  for (uint32_t id : names.programs()) {
    const Instance& row = image.instances[id];
    if (!same_name(image.types[row.type].name, declared)) continue;
    if (count++ != 0) instances += ", ";
    instances += row.name;
    found = base::joined({row.name, path.substr(declared.size())});
  }
  if (count < 2) return found;
  return not_there(path, {"`", declared, "` has ", std::to_string(count),
                          " instances; name one of them: ", instances});
}

}  // namespace

base::Result<NamedSymbol> named_symbol(const NameIndex& names, std::string_view name) {
  const auto found_at = [&](std::string path) -> base::Result<NamedSymbol> {
    base::Result<Symbol> symbol = find_symbol(names, path);
    if (!symbol.ok()) return symbol.error();
    return NamedSymbol{std::move(path), *symbol};
  };
  if (const auto address = parse_address(name)) {
    base::Result<std::string> path = located(names.image(), name, *address);
    return path.ok() ? found_at(std::move(*path)) : path.error();
  }
  base::Result<NamedSymbol> found = found_at(std::string(name));
  if (found.ok()) return found;
  base::Result<std::string> other = by_program(names, name);
  if (!other.ok()) return other.error();
  if (!other->empty()) {
    base::Result<NamedSymbol> better = found_at(std::move(*other));
    if (better.ok()) return better;
  }
  const std::string& why = found.error().text;
  return base::Error{found.error().refusal, why + meant(names, name, why)};
}

base::Result<Symbol> named_symbol(const Image& image, std::string_view name) {
  base::Result<NamedSymbol> found = named_symbol(NameIndex(image), name);
  if (!found.ok()) return found.error();
  return found->symbol;
}

}  // namespace ir
