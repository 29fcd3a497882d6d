#include "frontend/sema/declarations/old_names.h"

#include <algorithm>

#include "frontend/lex/pragma.h"
#include "frontend/sema/declarations/made_names.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/sema.h"
#include "ir/types/old_names.h"

namespace frontend {
namespace {

// Not only a name: `List.x`, `limit.low`, `row[3]`.
bool is_whole(std::string_view old_name) {
  return old_name.find_first_of(".[") != std::string_view::npos;
}

// What may not have been renamed in this step, too.
std::string with_name(std::string_view rule, std::string_view name) {
  return std::string(rule) + (rule.empty() ? "" : ",") + std::string(name);
}

// Every front with every end but `now`, the name that they have now; whole ends go alone.
std::string joined_rules(std::string_view fronts, const std::string& between, std::string_view ends,
                         std::string_view now) {
  std::vector<std::string> out;
  for (std::string_view end : ir::old_names_of(ends)) {
    if (is_whole(end)) out.emplace_back(without_dot(end));
  }
  for (std::string_view front : ir::old_names_of(fronts)) {
    for (std::string_view end : ir::old_names_of(ends)) {
      const bool whole = is_whole(end);
      std::string name = std::string(front) + between + std::string(end);
      if (!whole && !ir::same_name(name, now)) out.push_back(std::move(name));
    }
  }
  return ir::old_names_rule(out);
}

}  // namespace

ir::OldNameId OldNames::add(std::string name) {
  return name.empty() ? ir::OldNameId() : sema_.program.types.add_old_name(std::move(name));
}

ir::OldNameId OldNames::of_rule(Range32 attributes) {
  return add(renamed_from(sema_.tree, attributes));
}

ir::OldNameId OldNames::add_made(ir::TypeId type, std::string_view suffix) {
  const ir::OldNameId rule = sema_.program.types[type].old_name;
  if (!rule.valid()) return {};
  std::vector<std::string> out;
  for (std::string_view name : ir::old_names_of(sema_.program.types.old_name(rule)))
    out.push_back(std::string(name) + std::string(suffix));
  return add(ir::old_names_rule(out));
}

// `Block#pool`, `Block#states`.
ir::OldNameId OldNames::of_pool(const Variable& variable) {
  const std::string_view name = variable.name.text;
  for (const Pool& pool : sema_.pools.all) {
    if (name.starts_with(pool.name) && name.find('#') == pool.name.size())
      return add_made(pool.type, name.substr(pool.name.size()));
  }
  return {};
}

ir::OldNameId OldNames::of(const Variable& variable) {
  if (variable.decl == nullptr && variable.name.text.find('#') != std::string_view::npos)
    return of_pool(variable);
  std::string rule = old_member(variable);
  const bool made = variable.name.text.find('#') != std::string_view::npos;
  if (variable.decl == nullptr || made) return add(std::move(rule));
  for (const Attribute* part : part_rules(sema_.tree, variable.decl->attributes)) {
    if (!part->has_value || !variable.type.valid()) continue;
    if (!has_part(variable.type, part->part)) {
      error(DiagnosticCode::kBadRename, part->name.span,
            "`" + std::string(variable.name.text) + std::string(part->part) +
                "` is no part of this variable that has a value of its own",
            "name a member or element that is in no union and no function block");
      continue;
    }
    std::vector<std::string> names;
    for (std::string_view name : quoted_texts(part->value)) names.emplace_back(name);
    std::string before = ir::old_names_rule(names);
    if (!variable.list.empty()) before = whole_old_names(std::string(variable.list) + ".", before);
    rule += ";" + std::string(part->part) + "=" + before;
  }
  return add(std::move(rule));
}

bool OldNames::has_part(ir::TypeId type, std::string_view part) const {
  const ir::TypeTable& types = sema_.program.types;
  while (!part.empty()) {
    const size_t end =
        part[0] == '[' ? part.find(']') + 1 : std::min(part.find_first_of(".[", 1), part.size());
    if (part[0] == '[') {
      const auto commas = std::count(part.begin(), part.begin() + static_cast<ptrdiff_t>(end), ',');
      if (end == 0 || types[type].kind != ir::Kind::kArray) return false;
      if (types[type].dims.size() != static_cast<size_t>(commas) + 1) return false;
      type = types[type].base;
    } else {
      const int32_t number = types.find_member(type, part.substr(1, end - 1));
      if (types[type].kind != ir::Kind::kStruct || types.overlaps(type) || number < 0) return false;
      type = types[type].members[static_cast<size_t>(number)].type;
    }
    part.remove_prefix(end);
  }
  return !types.is_instance(type);
}

ir::OldNameId OldNames::of_clone(std::string_view name, std::string_view rule,
                                 std::string_view instance, std::string_view instance_rule) {
  std::vector<std::string> out;
  const std::string now = std::string(name) + "(" + std::string(instance) + ")";
  for (std::string_view program : ir::old_names_of(with_name(rule, name))) {
    for (std::string_view one : ir::old_names_of(with_name(instance_rule, instance))) {
      std::string before = std::string(program) + "(" + std::string(one) + ")";
      if (!ir::same_name(before, now)) out.push_back(std::move(before));
    }
  }
  return add(ir::old_names_rule(out));
}

void OldNames::rename_types() {
  for (const TypeDecl& decl : sema_.tree.types) {
    const std::string rule = renamed_from(sema_.tree, decl.attributes);
    if (rule.empty() || !decl.spec.valid() || sema_.library.holds(decl.name.span)) continue;
    const SpecInfo& info = sema_.facts.of(scope_, decl.spec);
    if (!info.use.type.valid()) continue;
    ir::Type& type = sema_.program.types.edit(info.use.type);
    const bool own = ir::same_name(type.name, info.name.text) &&
                     (ir::is_structure(type.kind) || type.kind == ir::Kind::kEnum);
    if (own) {
      type.old_name = add(whole_old_names(info.name.text, rule));
      continue;
    }
    error(DiagnosticCode::kBadRename, decl.name.span,
          "`" + std::string(decl.name.text) +
              "` is another name for a type; its variables keep their values by themselves",
          "take the rule away");
  }
}

// The old names of the list in front of the names of VAR_STAT variables; "" when it has not
// changed.
std::string OldNames::old_list(const PouInfo& info) const {
  if (info.owner == kNoPou) return std::string(info.old_name);
  const PouInfo& block = sema_.declared.pous[info.owner];
  return joined_rules(with_name(block.old_name, block.name), "#",
                      with_name(info.old_name, info.name),
                      std::string(block.name) + "#" + std::string(info.name));
}

// "" where no rule says anything.
std::string OldNames::old_member(const Variable& variable) const {
  if (variable.decl == nullptr) {  // the program itself, among the globals
    const PouInfo* called = variable.type.valid() ? sema_.declared.pou_of(variable.type) : nullptr;
    const bool whole = called != nullptr && called->decl->kind == PouKind::kProgram;
    return whole ? std::string(called->old_name) : std::string();
  }
  const std::string own = renamed_from(sema_.tree, variable.decl->attributes);
  std::string front;
  std::string before;
  if (!variable.list.empty()) front = std::string(variable.list) + ".";
  if (!variable.method.empty()) front = std::string(variable.method) + "#";
  if (variable.pou != kNoPou && !front.empty()) {
    const PouInfo& info = sema_.declared.pous[variable.pou];
    const bool of_block = variable.method.empty() || variable.method.find('#') != std::string::npos;
    before = of_block ? old_list(info) : std::string(info.old_name);
    if (!variable.method.empty()) std::replace(before.begin(), before.end(), '.', '_');
  }
  std::vector<std::string> ends;
  if (variable.name.text.find('#') != std::string_view::npos)
    ends = MadeNames(sema_, variable).before();
  const bool plain = own.empty() && ends.empty();
  if (plain && before.empty()) return {};
  // `x#last` is made for x and carries its rule.
  const std::string name(variable.name.text);
  const std::string made = name.substr(std::min(name.find('#'), name.size()));
  for (std::string_view end : ir::old_names_of(own)) {
    if (!is_whole(end)) ends.push_back(std::string(end) + made);
    if (is_whole(end) && made.empty()) ends.emplace_back(front.empty() ? without_dot(end) : end);
  }
  if (!before.empty() || plain) ends.push_back(name);
  if (front.empty()) return ir::old_names_rule(ends);
  const std::string fronts = with_name(before, front.substr(0, front.size() - 1));
  return joined_rules(fronts, front.substr(front.size() - 1), ir::old_names_rule(ends),
                      front + name);
}

}  // namespace frontend
