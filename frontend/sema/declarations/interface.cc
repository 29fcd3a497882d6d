// Interfaces: the members of instances, the locals of frames, the global variables.
#include <algorithm>
#include <set>

#include "frontend/sema/calls/open_functions.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/objects/pools.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/tests/test_build.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

ir::Section section_of(VarSection section) {
  switch (section) {
    case VarSection::kInput:
      return ir::Section::kInput;
    case VarSection::kOutput:
      return ir::Section::kOutput;
    case VarSection::kInOut:
      return ir::Section::kInOut;
    case VarSection::kGlobal:
      return ir::Section::kGlobal;
    default:
      return ir::Section::kLocal;
  }
}

ir::LocalKind local_kind(VarSection section) {
  switch (section) {
    case VarSection::kInput:
      return ir::LocalKind::kInput;
    case VarSection::kOutput:
      return ir::LocalKind::kOutput;
    case VarSection::kInOut:
      return ir::LocalKind::kInOut;
    default:
      return ir::LocalKind::kTemp;
  }
}

// What is bound by reference is a reference that comes in.
VarSection ir_section(const Variable& variable) {
  return variable.by_reference ? VarSection::kInput : variable.section;
}

}  // namespace

void Interfaces::resolve_declarations() {
  for (const TypeDecl& decl : sema_.tree.types) {
    if (!sema_.library.holds(decl.name.span)) ask<Types>().resolve_type(decl.spec);
  }
  ask<OldNames>().rename_types();
  SharedAddresses(sema_).find();
  resolve_globals();
  // Grows while library blocks are discovered.
  for (uint32_t i = 0; i < sema_.declared.pous.size(); ++i) resolve_interface(i);
  sema_.declared.complete = true;
  ask<OpenFunctions>().check_overloads();
  ask<Objects>().check();
  ask<Types>().check_containment();
}

void Interfaces::resolve_globals() {
  for (size_t i = 0; i < sema_.declared.global_order.size();
       ++i) {  // grows with instances that are found
    VarId id = sema_.declared.global_order[i];
    resolve(id);
    const Variable& variable = sema_.declared.variables[id.index];
    sema_.program.types.edit(sema_.program.globals)
        .members.push_back(member_of(variable, ir::Section::kGlobal));
  }
  sema_.declared.globals_placed = true;
  if (sema_.for_tests()) ask<TestBuild>().add_test_globals();
}

ir::Member Interfaces::member_of(const Variable& variable, ir::Section section) {
  ir::Member member;
  member.old_name = ask<OldNames>().of(variable);
  if (!variable.list.empty()) member.name = std::string(variable.list) + ".";
  if (!variable.method.empty()) member.name = std::string(variable.method) + "#";
  member.name += variable.name.text;
  member.type = variable.type;
  member.section = variable.stamp ? ir::Section::kStamp : section;
  member.constant = has_known_value(variable);
  member.retain = variable.retain;
  member.init = variable.init;
  member.address = variable.address;
  if (variable.decl != nullptr && variable.decl->has_address && !variable.hidden) {
    member.address = variable.decl->address;
    if (variable.decl->incomplete) {
      member.address.bit_offset = ir::kOpenAddress;
      member.address.bit_size = ask<Variables>().address_bits(variable.type);
    }
  }
  return member;
}

// A VAR_INST of a method that overrides another one is no variable of the base: its name begins
// with the block, as `Block#Method#variable`. Values of a running program are found by these names.
static void qualify_method(Sema& sema, Variable& variable, const PouInfo& block,
                           std::set<std::string>& names) {
  if (variable.method.empty()) return;
  const auto full = [&] {
    return ir::fold_name(std::string(variable.method) + "#" + std::string(variable.name.text));
  };
  if (names.contains(full())) {
    std::string name(block.name);
    std::replace(name.begin(), name.end(), '.', '_');  // of a namespace: no path goes through it
    variable.method = sema.declared.keep_name(name + "#" + std::string(variable.method));
  }
  names.insert(full());
}

void Interfaces::resolve_interface(uint32_t number) {
  PouInfo& info = sema_.declared.pous[number];
  if (info.open || info.resolved) return;
  info.resolved = true;
  if (info.base != kNoPou) resolve_interface(info.base);
  for (VarId id : info.variables) resolve(id);
  std::vector<ir::Member> members;
  if (info.base != kNoPou)
    members = sema_.program.types[sema_.declared.pous[info.base].self].members;
  std::set<std::string> names;
  for (const ir::Member& member : members) names.insert(ir::fold_name(member.name));
  for (VarId id : info.members) {
    Variable& variable = sema_.declared.variables[id.index];
    qualify_method(sema_, variable, info, names);
    members.push_back(member_of(variable, section_of(ir_section(variable))));
  }
  for (VarId id : info.call_instances) {
    if (sema_.pools.declared) ask<Pools>().add_methods(sema_.declared.variables[id.index].type);
  }
  const bool block = info.decl->kind == PouKind::kFunctionBlock || info.as_block;
  if (sema_.for_tests() && block) ask<TestBuild>().add_mock_members(info, members);
  bool instance = info.self.valid() && info.owner == kNoPou;
  if (instance) sema_.program.types.edit(info.self).members = std::move(members);
  if (!info.id.valid()) return;
  ir::Pou& pou = sema_.program.pous[info.id.index];
  for (VarId id : info.locals) {
    const Variable& variable = sema_.declared.variables[id.index];
    ir::LocalKind kind =
        id == info.result ? ir::LocalKind::kReturn : local_kind(ir_section(variable));
    pou.locals.push_back({std::string(variable.name.text), variable.type, kind});
  }
}

}  // namespace frontend
