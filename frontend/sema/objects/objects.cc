// Members with code, and what names mean in a block with bases.
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/declarations/collection.h"

#include "frontend/parse/declared_twice.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

std::string code_name(const std::string& block, const PouDecl& decl) {
  std::string name = block + "." + std::string(decl.name.text);
  if (decl.kind == PouKind::kGetter) name += ".GET";
  if (decl.kind == PouKind::kSetter) name += ".SET";
  return name;
}

// Where its block has that name already: a variable, a method or a property.
base::SourceSpan same_name_in(const Declarations& declared, const PouInfo& owner,
                              const MemberCode& code, const Name& name) {
  const auto variable = owner.names.find(name.text);
  if (variable != owner.names.end()) return declared.variables[variable->second.index].name.span;
  const uint32_t accessor = code.getter != kNoPou ? code.getter : code.setter;
  const uint32_t other = code.method != kNoPou ? code.method : accessor;
  return declared.pous[other].decl->name.span;
}

}  // namespace

void Objects::collect(uint32_t block) {
  const PouInfo& info = sema_.declared.pous[block];
  if (has_frame(info.decl->kind)) return;
  for (const PouDecl& member : info.decl->members) {
    if (has_frame(member.kind)) add_member(block, member);
  }
}

void Objects::add_member(uint32_t block, const PouDecl& decl) {
  PouInfo& owner = sema_.declared.pous[block];
  MemberCode& code = owner.code[decl.name.text];
  const bool accessor = decl.kind == PouKind::kGetter || decl.kind == PouKind::kSetter;
  uint32_t& slot = !accessor                       ? code.method
                   : decl.kind == PouKind::kGetter ? code.getter
                                                   : code.setter;
  // GET and SET belong to one PROPERTY.
  const uint32_t other_accessor = decl.kind == PouKind::kGetter ? code.setter : code.getter;
  const bool apart =
      accessor && other_accessor != kNoPou &&
      sema_.declared.pous[other_accessor].decl->name.span.begin != decl.name.span.begin;
  const bool taken = slot != kNoPou || apart ||
                     (accessor ? code.method != kNoPou : code.is_property()) ||
                     owner.names.contains(decl.name.text);
  if (taken) {
    const base::SourceSpan other = same_name_in(sema_.declared, owner, code, decl.name);
    if (other.begin == decl.name.span.begin) return;  // two GETs: the parser has said so
    error(DiagnosticCode::kDuplicateName, decl.name.span,
          declared_twice(sema_.sources, decl.name.text, decl.name.span, other));
    return;
  }
  slot = static_cast<uint32_t>(sema_.declared.pous.size());
  PouInfo& info = sema_.declared.pous.emplace_back();
  info.number = slot;
  info.decl = &decl;
  info.name = decl.name.text;
  if (std::string rule = renamed_from(sema_.tree, decl.attributes); !rule.empty()) {
    info.old_name = sema_.declared.keep_name(std::move(rule));
  }
  info.library = owner.library;
  info.owner = block;
  info.self = owner.self;
  if (owner.meaning != nullptr) info.meaning = std::make_unique<Meaning>();
  ask<Collection>().add_code(info, code_name(sema_.program.types[owner.self].name, decl));
  ask<Collection>().collect_interface(info.number);
}

VarId Objects::find_variable(uint32_t block, std::string_view name) const {
  for (; block != kNoPou; block = sema_.declared.pous[block].base) {
    const NameMap<VarId>& names = sema_.declared.pous[block].names;
    auto found = names.find(name);
    if (found == names.end()) continue;
    const Variable& variable = sema_.declared.variables[found->second.index];
    if (variable.section == VarSection::kTemp && !in_action_of(block)) continue;
    if (variable.storage != Storage::kLocal) return found->second;
  }
  return {};
}

bool Objects::in_action_of(uint32_t block) const {
  if (scope_.pou == nullptr) return false;
  const PouInfo& current = *scope_.pou;
  return current.owner == block && current.decl->kind == PouKind::kAction;
}

VarId Objects::find_parameter(const PouInfo& callee, std::string_view name) const {
  if (auto found = callee.names.find(name); found != callee.names.end()) return found->second;
  return has_frame(callee.decl->kind) ? VarId() : find_variable(callee.base, name);
}

std::vector<VarId> Objects::variables_of(const PouInfo& pou) const {
  std::vector<const PouInfo*> chain{&pou};
  while (chain.back()->base != kNoPou) chain.push_back(&sema_.declared.pous[chain.back()->base]);
  std::vector<VarId> all;
  for (; !chain.empty(); chain.pop_back()) {
    all.insert(all.end(), chain.back()->variables.begin(), chain.back()->variables.end());
  }
  return all;
}

VarId Objects::member_variable(const PouInfo& block, uint32_t member) const {
  const PouInfo* at = &block;
  while (member < at->inherited) at = &sema_.declared.pous[at->base];
  member -= at->inherited;
  return member < at->members.size() ? at->members[member] : VarId();
}

Objects::Found Objects::find_code(uint32_t block, std::string_view name) const {
  for (uint32_t at = block; at != kNoPou; at = sema_.declared.pous[at].base) {
    const PouInfo& info = sema_.declared.pous[at];
    if (auto own = info.code.find(name); own != info.code.end()) return {at, own->second};
    if (info.decl->kind != PouKind::kInterface) continue;
    for (ir::TypeId parent : sema_.program.types[info.self].interfaces) {  // all, each once
      const PouInfo& other = *sema_.declared.pou_of(parent);
      auto found = other.code.find(name);
      if (found != other.code.end()) return {other.number, found->second};
    }
  }
  return {};
}

bool Objects::extends(uint32_t pou, uint32_t base) const {
  for (; pou != kNoPou; pou = sema_.declared.pous[pou].base) {
    if (pou == base) return true;
  }
  return false;
}

std::string Objects::suggestion(uint32_t block, std::string_view name) const {
  NearestName nearest(name);
  for (; block != kNoPou; block = sema_.declared.pous[block].base) {
    nearest.offer_all(sema_.declared.pous[block].names);
    nearest.offer_all(sema_.declared.pous[block].code);
    if (sema_.declared.pous[block].decl->kind != PouKind::kInterface) continue;
    for (uint32_t parent : sema_.declared.pous[block].interfaces) {
      nearest.offer_all(sema_.declared.pous[parent].code);
    }
  }
  return nearest.fix();
}

}  // namespace frontend
