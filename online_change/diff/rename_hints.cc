// Case 14: a variable that goes and one of the same type that comes may be one variable with a new
// name. Case 62: another type takes the place of one. The report says how to keep the values.
#include <algorithm>
#include <map>
#include <unordered_set>

#include "ir/types/old_names.h"
#include "online_change/diff/type_diff.h"

namespace online_change {
namespace {

using ir::Member;

struct Candidates {  // of one type
  std::vector<const Member*> gone;
  std::vector<const Member*> came;
};

// Has it a name that a source can write, and a value that a rename would keep?
bool is_written(const Member& member) {
  return ir::is_listed(member) && !member.constant &&
         member.name.find_first_of("#-") == std::string::npos;
}

// Written variables of `type` that `other` does not have.
std::vector<const Member*> only_here(const ir::Type& type, const ir::Type& other) {
  std::unordered_set<std::string> names;
  for (const Member& member : other.members) names.insert(ir::fold_name(member.name));
  std::vector<const Member*> out;
  for (const Member& member : type.members) {
    if (is_written(member) && !names.contains(ir::fold_name(member.name))) out.push_back(&member);
  }
  return out;
}

// `List.x` is x for a variable of the same list, and `x` is `.x` for one of a list.
std::string seen_from(const std::string& name, const std::string& other) {
  const size_t list = name.rfind('.');
  const bool same = list != std::string::npos && list < other.size() &&
                    ir::same_name(name.substr(0, list + 1), other.substr(0, list + 1));
  const bool of_none = list == std::string::npos && other.find('.') != std::string::npos;
  return (of_none ? "." : "") + name.substr(same ? list + 1 : 0);
}

// The old name of a rule that leads into a function block of the old area; "" when none does.
std::string_view name_in_block(const ir::TypeTable& types, const ir::Type& area,
                               const std::string& rule) {
  for (const std::string_view name : ir::old_names_of(rule)) {
    const std::string_view head = name.substr(0, name.find_first_of(".["));
    if (head.size() == name.size()) continue;
    for (const Member& member : area.members) {
      ir::TypeId type = member.type;
      while (types[type].kind == ir::Kind::kArray) type = types[type].base;
      if (ir::same_name(member.name, head) && types.is_instance(type)) return name;
    }
  }
  return {};
}

// As a part of the name of a function.
std::string plain(std::string name) {
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

}  // namespace

std::string rename_proposal(const std::string& old_name) {
  return "; if it is `" + old_name.substr(old_name[0] == '.') +
         "` renamed, write {renamed from := '" + old_name + "'} before it";
}

std::string migration_hint(const ir::Type& before, const ir::Type& after) {
  return "; {migration of := '" + after.name + "', from := '" + before.name + "'} FUNCTION " +
         plain(before.name) + "_to_" + plain(after.name) +
         " END_FUNCTION would keep what has the same name, and its parameters the rest";
}

// Where one structure takes the place of another, only a migration tells its members apart from
// those of other values of that type.
void TypeDiffer::propose_migration(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type) const {
  const ir::Type& before = old_.types[old_type];
  const ir::Type& after = new_.types[new_type];
  if (before.name.empty() || after.name.empty() || ir::same_name(before.name, after.name)) return;
  for (FateRow& row : diff.rows) {
    if (row.fate == Fate::kDropped && row.may_lose && row.reason == "removed") {
      row.reason += "; a parameter of a {migration of := '" + after.name + "', from := '" +
                    before.name + "'} can take it over";
      return;
    }
  }
}

// X2: a rule that could not be followed is no rule that has done its work.
void TypeDiffer::explain_rules(TypeDiff& diff, ir::TypeId old_area, ir::TypeId new_area) const {
  for (FateRow& row : diff.rows) {
    if (row.fate != Fate::kInitialised || row.reason != "new" || row.path.empty()) continue;
    const int32_t number = new_.types.find_member(new_area, row.path.substr(1));
    if (number < 0) continue;
    const ir::OldNameId rule = new_.types[new_area].members[size_t(number)].old_name;
    if (!rule.valid() || !new_.types.knows(rule)) continue;
    const std::string_view name =
        name_in_block(old_.types, old_.types[old_area], new_.types.old_name(rule));
    if (name.empty()) continue;
    row.reason += ", not renamed: `" + std::string(name) + "` is in a function block";
  }
}

void TypeDiffer::propose_renames(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type) const {
  // What a migration reads or another step takes over goes on already.
  std::unordered_set<std::string> goes_on;
  for (const FateRow& row : diff.rows) {
    if (row.fate == Fate::kDropped && !row.may_lose) goes_on.insert(row.path);
  }
  std::map<std::string, Candidates> groups;
  for (const Member* member : only_here(old_.types[old_type], new_.types[new_type])) {
    const std::string path = "." + member->name;
    if (goes_on.contains(path) || diff.moved.contains(path)) continue;
    groups[ir::fold_name(old_.types.text(member->type))].gone.push_back(member);
  }
  if (groups.empty()) return;
  for (const Member* member : only_here(new_.types[new_type], old_.types[old_type])) {
    if (diff.moved.contains("." + member->name)) continue;
    groups[ir::fold_name(new_.types.text(member->type))].came.push_back(member);
  }
  for (const auto& [type, group] : groups) {
    if (group.gone.size() != group.came.size()) continue;
    for (size_t i = 0; i < group.gone.size(); ++i) {
      const std::string old_name = seen_from(group.gone[i]->name, group.came[i]->name);
      diff.hints[ir::fold_name(group.came[i]->name)] = rename_proposal(old_name);
    }
  }
  for (FateRow& row : diff.rows) {
    const bool came = row.fate == Fate::kInitialised && row.old_type.empty() && !row.path.empty();
    const auto hint = came ? diff.hints.find(ir::fold_name(row.path.substr(1))) : diff.hints.end();
    if (hint != diff.hints.end()) row.reason += hint->second;
  }
}

// "Main.ticks" and "ticks", "GVL.ticks": the last name of both.
static std::string last_name(const std::string& path) {
  return ir::fold_name(path.substr(path.rfind('.') + 1));
}

void propose_reading(const ir::Image& image, std::vector<FateRow>& rows) {
  std::map<std::pair<std::string, std::string>, std::vector<const FateRow*>> gone;
  for (const FateRow& row : rows) {
    if (row.fate == Fate::kDropped && row.may_lose && row.reason == "removed")
      gone[{last_name(row.path), row.old_type}].push_back(&row);
  }
  if (gone.empty()) return;
  const auto program_of = [&](const std::string& path) -> std::string {
    for (const uint32_t id : image.program_ids()) {
      const std::string& name = image.instances[id].name;
      if (path.size() > name.size() && path[name.size()] == '.' &&
          path.find('.', name.size() + 1) == std::string::npos &&
          ir::same_name(path.substr(0, name.size()), name)) {
        return image.types[image.instances[id].type].name;
      }
    }
    return {};
  };
  for (FateRow& row : rows) {
    if (row.fate != Fate::kInitialised || !row.reason.starts_with("new")) continue;
    const auto found = gone.find({last_name(row.path), row.new_type});
    if (found == gone.end() || found->second.size() != 1) continue;
    const std::string& old_path = found->second[0]->path;
    const std::string from = program_of(old_path);
    const std::string to = program_of(row.path);
    if (from.empty() == to.empty()) continue;
    const bool list = old_path.find('.') != std::string::npos;
    row.reason = "new; a {migration of := '" + (to.empty() ? "VAR_GLOBAL" : to) +
                 "'} with an input {old := '" + (list ? "" : ".") + old_path +
                 "'} can take over the one that goes";
  }
}

}  // namespace online_change
