#include "ir/bytecode/edge_names.h"

#include <string>
#include <utility>

#include "ir/bytecode/rename_rules.h"
#include "ir/types/old_names.h"

namespace ir {

constexpr uint32_t kNoMember = RenameRules::kNone;
using Numbers = RenameRules::Numbers;

std::string_view edge_of_name(std::string_view name) {
  if (name.find('#') == name.npos) return {};
  for (const std::string_view kind : {"#rising", "#falling"}) {
    const size_t at = name.find(kind);
    if (at == name.npos) continue;
    const size_t end = at + kind.size();
    if (end == name.size() || name[end] == '#') return name.substr(0, end);
  }
  return {};
}

namespace {

// `operand#rising` of a BOOL; "" where it is no such name. A method's variable may have one of
// these words as its name: `Method#rising_count`.
std::string_view edge_of(const Member& member) {
  if (member.type.index != static_cast<uint32_t>(Kind::kBool)) return {};
  return edge_of_name(member.name);
}

// The same for the same names in any order.
uint64_t sum_of_edges(const TypeTable& types) {
  uint64_t sum = 0;
  for (uint32_t i = kElementaryCount; i < types.size(); ++i) {
    const Type& type = types[TypeId(i)];
    if (type.kind != Kind::kFunctionBlock && type.kind != Kind::kProgram) continue;
    for (const Member& member : type.members) {
      if (edge_of(member).empty()) continue;
      sum += base::name_hash(type.name) * 31 + base::name_hash(member.name);
    }
  }
  return sum;
}

}  // namespace

bool edges_differ(const TypeTable& old_types, const TypeTable& types) {
  // An image that was decoded beside another shares what did not change.
  return &old_types != &types && sum_of_edges(old_types) != sum_of_edges(types);
}

void pair_edges(const Type& old, const TypeTable& types, const Type& next,
                std::vector<uint32_t>& sources) {
  std::vector<bool> taken(old.members.size());
  for (const uint32_t from : sources) {
    if (from != kNoMember) taken[from] = true;
  }
  Numbers before;
  for (uint32_t i = 0; i < old.members.size(); ++i) {
    if (!edge_of(old.members[i]).empty()) before.emplace(fold_name(old.members[i].name), i);
  }
  if (before.empty()) return;
  std::vector<uint32_t> comes;
  for (uint32_t i = 0; i < next.members.size(); ++i) {
    if (edge_of(next.members[i]).empty() || sources[i] != kNoMember) continue;
    const auto twin = before.find(fold_name(next.members[i].name));
    if (twin == before.end()) {
      comes.push_back(i);
    } else {
      taken[twin->second] = true;
    }
  }
  // Of those that are only there, the first one of each operand, and behind it the next one.
  Numbers gone;
  std::vector<uint32_t> behind(old.members.size(), kNoMember);
  for (uint32_t i = static_cast<uint32_t>(old.members.size()); i-- > 0;) {
    const std::string_view edge = edge_of(old.members[i]);
    if (edge.empty() || taken[i]) continue;
    uint32_t& first = gone.emplace(fold_name(edge), kNoMember).first->second;
    behind[i] = std::exchange(first, i);
  }
  for (const uint32_t to : comes) {
    const Member& member = next.members[to];
    std::vector<std::string_view> names;
    if (member.old_name.valid()) names = old_names_of(types.old_name(member.old_name));
    names.insert(names.begin(), member.name);
    for (const std::string_view name : names) {
      const auto found = gone.find(fold_name(edge_of_name(name)));
      if (found == gone.end() || found->second == kNoMember) continue;
      sources[to] = std::exchange(found->second, behind[found->second]);
      break;
    }
  }
}

}  // namespace ir
