#include "ir/bytecode/renames.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "base/limits.h"
#include "ir/bytecode/edge_names.h"
#include "ir/bytecode/rename_rules.h"
#include "ir/bytecode/symbols.h"
#include "ir/types/listed_name.h"
#include "ir/types/member_finder.h"

namespace ir {
namespace {

constexpr uint32_t kNoMember = RenameRules::kNone;

using Rules = RenameRules;
using Numbers = RenameRules::Numbers;

std::string type_key(const Type& type) {
  return std::to_string(static_cast<uint32_t>(type.kind)) + ":" + fold_name(type.name);
}

bool has_names(Kind kind) {
  return is_structure(kind) || kind == Kind::kEnum || kind == Kind::kFunctionBlock ||
         kind == Kind::kProgram || kind == Kind::kInterface;
}

struct NewProgram {
  std::string_view name;
  OldNameId old_name;
};

class Renamer {
 public:
  Renamer(const Image& old_image, const TypeTable& types, TypeId globals,
          std::vector<NewProgram> programs)
      : old_(old_image),
        types_(types),
        globals_(globals),
        programs_(std::move(programs)),
        edges_(edges_differ(old_image.types, types)),
        paired_(old_image.types.size(), false) {}

  std::optional<Image> run() {
    if (types_.old_names().empty() && !edges_) return std::nullopt;
    find_types();
    find_programs();
    for (const auto& [old, next] : pairs_of_types()) pair(old, next, 0);
    if (type_names_.empty() && member_names_.empty() && literal_names_.empty() &&
        program_names_.empty()) {
      return std::nullopt;
    }
    out_ = old_;
    forget_rules();
    rename();
    return std::move(out_);
  }

 private:
  struct NewName {
    TypeId type;          // of the running version, as all numbers here
    uint32_t number = 0;  // member, literal, instance
    std::string name;
  };

  std::string rule_of(OldNameId id) const {
    const bool known = id.valid() && old_.types.knows(id);
    return known ? fold_name(old_.types.old_name(id)) : std::string();
  }

  void find_types() {
    for (uint32_t i = kElementaryCount; i < old_.types.size(); ++i) {
      const Type& type = old_.types[TypeId(i)];
      if (has_names(type.kind) && !type.name.empty()) old_types_.emplace(type_key(type), i);
    }
    std::unordered_map<uint32_t, std::pair<Rules, Numbers>> kinds;
    for (uint32_t i = kElementaryCount; i < types_.size(); ++i) {
      const Type& type = types_[TypeId(i)];
      if (!type.old_name.valid() || !has_names(type.kind)) continue;
      kinds[static_cast<uint32_t>(type.kind)].first.add(type.name, types_.old_name(type.old_name),
                                                        i);
    }
    for (auto& [kind, scope] : kinds) {
      for (const auto& [key, number] : old_types_) {
        const Type& type = old_.types[TypeId(number)];
        if (static_cast<uint32_t>(type.kind) == kind) {
          scope.second.emplace(fold_name(type.name), number);
        }
      }
      scope.first.resolve(
          scope.second, [&](uint32_t i) { return rule_of(old_.types[TypeId(i)].old_name); },
          [&](uint32_t from, uint32_t to) {
            renamed_types_[to] = from;
            is_source_.insert(from);
            type_names_.push_back({TypeId(from), 0, types_[TypeId(to)].name});
          });
    }
  }

  std::vector<std::pair<TypeId, TypeId>> pairs_of_types() const {
    std::vector<std::pair<TypeId, TypeId>> out{{old_.globals, globals_}};
    for (uint32_t i = kElementaryCount; i < types_.size(); ++i) {
      const Type& type = types_[TypeId(i)];
      if (!has_names(type.kind) || type.name.empty()) continue;
      if (const auto renamed = renamed_types_.find(i); renamed != renamed_types_.end()) {
        out.emplace_back(renamed->second, i);
        continue;
      }
      const auto found = old_types_.find(type_key(type));
      if (found == old_types_.end() || is_source_.contains(found->second)) continue;
      out.emplace_back(found->second, i);
    }
    return out;
  }

  void find_programs() {
    Rules rules;
    for (uint32_t i = 0; i < programs_.size(); ++i) {
      const OldNameId old = programs_[i].old_name;
      if (old.valid()) rules.add(programs_[i].name, types_.old_name(old), i);
    }
    if (rules.empty()) return;
    Numbers ids;
    for (uint32_t id : old_.program_ids()) ids.emplace(fold_name(old_.instances[id].name), id);
    rules.resolve(
        ids, [&](uint32_t id) { return rule_of(old_.instances[id].old_name); },
        [&](uint32_t from, uint32_t to) {
          program_names_.push_back({{}, from, std::string(programs_[to].name)});
        });
  }

  // Pairs the members of the same type in both versions.
  void pair(TypeId old, TypeId next, uint32_t depth) {
    if (paired_[old.index] || depth > base::kMaxNesting) return;
    paired_[old.index] = true;
    if (types_[next].kind == Kind::kEnum) return pair_literals(old, next);
    if (!types_.has_members(next)) return;
    const std::vector<Member>& members = types_[next].members;
    Rules rules;
    for (uint32_t i = 0; i < members.size(); ++i) {
      const OldNameId rule = members[i].old_name;
      if (rule.valid()) rules.add(members[i].name, types_.old_name(rule), i);
    }
    std::vector<uint32_t> sources(members.size(), kNoMember);  // by new member, the old one
    const std::vector<Member>& before = old_.types[old].members;
    if (!rules.empty()) {
      Numbers numbers;
      for (uint32_t i = 0; i < before.size(); ++i) numbers.emplace(fold_name(before[i].name), i);
      rules.resolve(
          numbers, [&](uint32_t i) { return rule_of(before[i].old_name); },
          [&](uint32_t from, uint32_t to) { sources[to] = from; });
    }
    if (edges_) pair_edges(old_.types[old], types_, types_[next], sources);
    for (uint32_t i = 0; i < members.size(); ++i) {
      if (sources[i] != kNoMember) member_names_.push_back({old, sources[i], members[i].name});
    }
    pair_members(old, next, sources, depth);
  }

  // What has no name of its own is known by the variable that it is the type of.
  void pair_members(TypeId old, TypeId next, const std::vector<uint32_t>& sources, uint32_t depth) {
    const std::vector<Member>& members = types_[next].members;
    MemberFinder finder(old_.types, old);
    std::vector<bool> renamed(old_.types[old].members.size());
    for (const uint32_t from : sources) {
      if (from != kNoMember) renamed[from] = true;
    }
    for (uint32_t i = 0; i < members.size(); ++i) {
      const TypeId inner = innermost(types_, members[i].type);
      if (!has_names(types_[inner].kind) || !types_[inner].name.empty()) continue;
      const bool is_renamed = sources[i] != kNoMember;
      const std::optional<size_t> twin =
          is_renamed ? std::optional<size_t>(sources[i]) : finder.find(members[i].name);
      if (!twin || (!is_renamed && renamed[*twin])) continue;
      const TypeId before = innermost(old_.types, old_.types[old].members[*twin].type);
      const bool same = old_.types[before].kind == types_[inner].kind;
      if (same && old_.types[before].name.empty()) pair(before, inner, depth + 1);
    }
  }

  static TypeId innermost(const TypeTable& types, TypeId id) {
    for (uint32_t depth = 0; depth < base::kMaxNesting; ++depth) {
      if (types[id].kind != Kind::kArray) break;
      id = types[id].base;
    }
    return id;
  }

  void pair_literals(TypeId old, TypeId next) {
    Rules rules;
    const std::vector<EnumLiteral>& literals = types_[next].literals;
    for (uint32_t i = 0; i < literals.size(); ++i) {
      const OldNameId rule = literals[i].old_name;
      if (rule.valid()) rules.add(literals[i].name, types_.old_name(rule), i);
    }
    if (rules.empty()) return;
    const std::vector<EnumLiteral>& before = old_.types[old].literals;
    Numbers numbers;
    for (uint32_t i = 0; i < before.size(); ++i) numbers.emplace(fold_name(before[i].name), i);
    rules.resolve(
        numbers, [&](uint32_t i) { return rule_of(before[i].old_name); },
        [&](uint32_t from, uint32_t to) {
          literal_names_.push_back({old, from, literals[to].name});
        });
  }

  void forget_rules() {
    out_.types.own().set_old_names({});
    for (uint32_t i = 0; i < out_.types.size(); ++i) {
      Type& type = out_.types.own().edit(TypeId(i));
      type.old_name = {};
      for (Member& member : type.members) member.old_name = {};
      for (EnumLiteral& literal : type.literals) literal.old_name = {};
    }
    for (Instance& row : out_.instances) row.old_name = {};
  }

  void rename_to(std::string& name, OldNameId& old_name, const std::string& next) {
    old_name = out_.types.own().add_old_name(std::move(name));
    name = next;
  }

  void rename() {
    for (const NewName& row : type_names_) {
      Type& type = out_.types.own().edit(row.type);
      rename_to(type.name, type.old_name, row.name);
    }
    for (const NewName& row : member_names_) {
      Member& member = out_.types.own().edit(row.type).members[row.number];
      rename_to(member.name, member.old_name, row.name);
    }
    for (const NewName& row : literal_names_) {
      EnumLiteral& literal = out_.types.own().edit(row.type).literals[row.number];
      rename_to(literal.name, literal.old_name, row.name);
    }
    for (const NewName& row : program_names_) {
      Instance& program = out_.instances[row.number];
      rename_to(program.name, program.old_name, row.name);
    }
    rename_pous();
    if (!member_names_.empty()) rename_instances();
  }

  // `Motor`, `Motor.Start`: code belongs to the type that has its name.
  void rename_pous() {
    for (LinkedPou& pou : out_.pous) {
      if (!out_.types.contains(pou.self) || !out_.types[pou.self].old_name.valid()) continue;
      const std::string& before = out_.types.old_name(out_.types[pou.self].old_name);
      if (!same_name(pou.name.substr(0, before.size()), before)) continue;
      pou.name = out_.types[pou.self].name + pou.name.substr(before.size());
    }
  }

  // "s.fb", "row[3].fb": by the variables on the way from the parent.
  void rename_instances() {
    for (uint32_t id = 1; id < out_.instances.size(); ++id) {
      Instance& row = out_.instances[id];
      const bool program = old_.types[row.type].kind == Kind::kProgram;
      if (!row.live || program || row.parent >= old_.instances.size()) continue;
      std::string name = new_path(old_.instances[row.parent].type, row.name);
      if (name != row.name) rename_to(row.name, row.old_name, name);
    }
  }

  std::string new_path(TypeId type, std::string_view path) {
    std::string out;
    for (size_t at = 0; at < path.size();) {
      std::string_view name = path.substr(at, path.find_first_of(".[", at) - at);
      uint32_t number = member_number(type, name);
      if (number == kNoMember && type == old_.globals) {
        name = listed_name(old_.types, type, path);
        number = member_number(type, name);
      }
      if (number == kNoMember) return std::string(path);
      out += out_.types[type].members[number].name;
      type = old_.types[type].members[number].type;
      at += name.size();
      if (at < path.size() && path[at] == '[') {
        const size_t end = std::min(path.find(']', at), path.size() - 1) + 1;
        out += path.substr(at, end - at);
        at = end;
        type = old_.types[type].base;
      }
      if (at < path.size() && path[at] == '.') out += path[at++];
      if (at < path.size() && !old_.types.has_members(type)) return std::string(path);
    }
    return out;
  }

  uint32_t member_number(TypeId type, std::string_view name) {
    Numbers& numbers = members_of_[type.index];
    if (numbers.empty()) {
      const std::vector<Member>& members = old_.types[type].members;
      for (uint32_t i = 0; i < members.size(); ++i) numbers.emplace(fold_name(members[i].name), i);
    }
    const auto found = numbers.find(fold_name(name));
    return found == numbers.end() ? kNoMember : found->second;
  }

  const Image& old_;
  const TypeTable& types_;
  TypeId globals_;
  std::vector<NewProgram> programs_;
  bool edges_;
  std::vector<bool> paired_;                              // old types
  Numbers old_types_;                                     // by kind and name
  std::unordered_map<uint32_t, uint32_t> renamed_types_;  // new -> old
  std::unordered_set<uint32_t> is_source_;
  std::vector<NewName> type_names_;
  std::vector<NewName> member_names_;
  std::vector<NewName> literal_names_;
  std::vector<NewName> program_names_;
  std::unordered_map<uint32_t, Numbers> members_of_;
  Image out_;
};

}  // namespace

std::optional<Image> under_new_names(const Image& old_image, const Program& next) {
  std::vector<NewProgram> programs;
  for (const ProgramInstance& row : next.instances) programs.push_back({row.name, row.old_name});
  return Renamer(old_image, next.types, next.globals, std::move(programs)).run();
}

std::optional<Image> under_new_names(const Image& old_image, const Image& next) {
  std::vector<NewProgram> programs;
  for (uint32_t id : next.program_ids()) {
    programs.push_back({next.instances[id].name, next.instances[id].old_name});
  }
  return Renamer(old_image, next.types, next.globals, std::move(programs)).run();
}

std::string own_path(const Image& image, const Image& renamed, std::string_view path) {
  const base::Result<Symbol> symbol = find_symbol(renamed, path);
  return symbol.ok() ? path_of(image, *symbol) : std::string();
}

}  // namespace ir
