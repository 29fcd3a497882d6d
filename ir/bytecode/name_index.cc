#include "ir/bytecode/name_index.h"

#include <algorithm>
#include <bit>

namespace ir {
namespace {

constexpr size_t kFewMembers = 8;  // these are compared one by one

uint64_t hash_of(uint32_t owner, std::string_view name) {
  const uint64_t mixed = (base::name_hash(name) ^ owner) * 0x9e3779b97f4a7c15u;
  return mixed ^ mixed >> 32;
}

// Where the path may be cut: before each `.` and `[`, and at its end; of at most so many bytes.
template <typename Visit>
void each_beginning(std::string_view path, size_t most, const Visit& visit) {
  for (size_t end = 0; end < path.size() && end <= most; ++end) {
    if (path[end] == '.' || path[end] == '[') visit(path.substr(0, end));
  }
  if (path.size() <= most) visit(path);
}

bool is_large(const Type& type) { return type.members.size() > kFewMembers; }

}  // namespace

NameIndex::NameIndex(const Image& image) : image_(image), programs_(image.program_ids()) {
  const std::vector<Member>& globals = image.types[image.globals].members;
  for (size_t i = 0; i < globals.size(); ++i) {
    if (!is_shared(image.types, globals[i])) continue;
    const size_t views = image.types[globals[i].type].members.size();
    for (size_t view = 0; view < views; ++view) shared_.push_back({i, view});
  }
  rows_.resize(std::bit_ceil(2 * count_names() + 1));
  for (uint32_t type = 0; type < image.types.size(); ++type) {
    if (!is_large(image.types[TypeId(type)])) continue;
    const size_t members = image.types[TypeId(type)].members.size();
    for (uint32_t i = 0; i < members; ++i) add(type, i);
  }
  for (const uint32_t id : programs_) add(kProgram, id);
  for (uint32_t i = 0; i < shared_.size(); ++i) add(kShared, i);
  for (uint32_t i = 0; i < image.access.size(); ++i) {
    add(kAccess, i);
    longest_access_ = std::max(longest_access_, image.access[i].name.size());
  }
  const auto listed = [this](std::string_view name) {
    if (name.find('.') != name.npos) longest_listed_ = std::max(longest_listed_, name.size());
  };
  for (const Member& global : globals) listed(global.name);
  for (uint32_t i = 0; i < shared_.size(); ++i) listed(name_of({kShared, i}));
}

size_t NameIndex::count_names() const {
  size_t count = programs_.size() + shared_.size() + image_.access.size();
  for (uint32_t type = 0; type < image_.types.size(); ++type) {
    const Type& one = image_.types[TypeId(type)];
    if (is_large(one)) count += one.members.size();
  }
  return count;
}

std::string_view NameIndex::name_of(const Row& row) const {
  switch (row.owner) {
    case kProgram:
      return image_.instances[row.number].name;
    case kShared: {
      const SharedMember& shared = shared_[row.number];
      const TypeId bytes = image_.types[image_.globals].members[shared.global].type;
      return image_.types[bytes].members[shared.member].name;
    }
    case kAccess:
      return image_.access[row.number].name;
    default:
      return image_.types[TypeId(row.owner)].members[row.number].name;
  }
}

// The first of several with one name comes before the others on their way.
void NameIndex::add(uint32_t owner, uint32_t number) {
  const size_t mask = rows_.size() - 1;
  size_t at = hash_of(owner, name_of({owner, number})) & mask;
  while (rows_[at].number != kFree) at = (at + 1) & mask;
  rows_[at] = {owner, number};
}

uint32_t NameIndex::find(uint32_t owner, std::string_view name) const {
  const size_t mask = rows_.size() - 1;
  for (size_t at = hash_of(owner, name) & mask; rows_[at].number != kFree; at = (at + 1) & mask) {
    if (rows_[at].owner == owner && same_name(name_of(rows_[at]), name)) return rows_[at].number;
  }
  return kFree;
}

int32_t NameIndex::find_member(TypeId type, std::string_view name) const {
  if (!is_large(image_.types[type])) return image_.types.find_member(type, name);
  return static_cast<int32_t>(find(type.index, name));
}

std::optional<SharedMember> NameIndex::find_shared(std::string_view name) const {
  const uint32_t found = find(kShared, name);
  if (found == kFree) return std::nullopt;
  return shared_[found];
}

std::string_view NameIndex::listed_name(std::string_view path) const {
  std::string_view found;
  each_beginning(path, longest_listed_, [&](std::string_view name) {
    if (name.find('.') == name.npos) return;
    if (find_member(image_.globals, name) >= 0 || find_shared(name)) found = name;
  });
  return found;
}

uint32_t NameIndex::find_program(std::string_view name) const {
  const uint32_t found = find(kProgram, name);
  return found == kFree ? 0 : found;
}

const AccessPath* NameIndex::access_path(std::string_view path) const {
  uint32_t first = kFree;
  each_beginning(path, longest_access_,
                 [&](std::string_view name) { first = std::min(first, find(kAccess, name)); });
  return first == kFree ? nullptr : &image_.access[first];
}

}  // namespace ir
