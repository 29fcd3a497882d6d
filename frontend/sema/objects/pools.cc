#include "frontend/sema/objects/pools.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/types/types.h"

#include <algorithm>
#include <charconv>

#include "frontend/sema/sema.h"

namespace frontend {
namespace {

constexpr std::string_view kPoolAttribute = "pool";
constexpr uint32_t kMostElements = 65'535;

}  // namespace

void Pools::declare() {
  sema_.pools.declared = true;
  const size_t count = sema_.declared.pous.size();
  for (size_t i = 0; i < count; ++i) {
    const PouInfo& info = sema_.declared.pous[i];
    const Attribute* attribute = sema_.tree.find_attribute(info.decl->attributes, kPoolAttribute);
    if (attribute == nullptr || info.library || info.owner != kNoPou) continue;
    const bool block = info.self.valid() && info.id.valid() &&
                       sema_.program.types[info.self].kind == ir::Kind::kFunctionBlock;
    if (!block || info.decl->is_abstract) {
      error(DiagnosticCode::kBadPool, attribute->name.span,
            "`" + std::string(info.decl->name.text) + "` cannot have instances in a pool",
            "put the attribute in front of a FUNCTION_BLOCK that is not ABSTRACT, or of a TYPE");
      continue;
    }
    const Name name{sema_.declared.keep_name(sema_.program.types[info.self].name),
                    info.decl->name.span};
    add(name, info.self, info.number, false, count_of(*attribute));
  }
  for (const TypeDecl& decl : sema_.tree.types) {
    const Attribute* attribute = sema_.tree.find_attribute(decl.attributes, kPoolAttribute);
    if (attribute != nullptr && !sema_.library.holds(decl.name.span)) add_type(decl, *attribute);
  }
  for (size_t i = 0; i < sema_.declared.variables.size(); ++i) {
    const Variable& variable = sema_.declared.variables[i];
    if (variable.each_call) add_methods(variable.type);
  }
}

uint32_t Pools::count_of(const Attribute& attribute) {
  uint32_t count = 0;
  const char* end = attribute.value.data() + attribute.value.size();
  auto [at, problem] = std::from_chars(attribute.value.data(), end, count);
  if (problem == std::errc() && at == end && count >= 1 && count <= kMostElements) return count;
  error(
      DiagnosticCode::kBadPool, attribute.name.span,
      "`" + std::string(attribute.value) + "` is no size of a pool",
      "write a number from 1 to " + std::to_string(kMostElements) + ": {attribute 'pool' := '16'}");
  return 1;
}

void Pools::add_type(const TypeDecl& decl, const Attribute& attribute) {
  const ir::TypeId type = ask<Types>().resolve_type(decl.spec).type;
  if (!type.valid()) return;
  const ir::Kind kind = sema_.program.types[type].kind;
  const bool storable = kind != ir::Kind::kReferenceTo && kind != ir::Kind::kInterface;
  if (!storable || sema_.program.types.is_instance(type)) {
    error(DiagnosticCode::kBadPool, attribute.name.span,
          "`" + std::string(decl.name.text) + "` cannot have values in a pool",
          "put the attribute in front of the FUNCTION_BLOCK itself, or of a TYPE of data");
    return;
  }
  const std::string_view name = sema_.namespaces.qualified(decl.scope, decl.name.text);
  add({name, decl.name.span}, type, add_box(decl, name), true, count_of(attribute));
}

// FUNCTION_BLOCK Name#box VAR value : Name; END_VAR END_FUNCTION_BLOCK
uint32_t Pools::add_box(const TypeDecl& decl, std::string_view name) {
  PouDecl& made = sema_.declared.made_decls.emplace_back();
  made.kind = PouKind::kFunctionBlock;
  made.name = {sema_.declared.keep_name(std::string(name) + "#box"), decl.name.span};
  made.span = decl.name.span;
  made.scope = decl.scope;
  VarBlock& block = made.blocks.emplace_back();
  block.access = Access::kPublic;
  block.scope = decl.scope;
  block.span = decl.name.span;
  VarDecl value;
  value.names.push_back({"value", decl.name.span});
  value.spec = decl.spec;
  value.span = decl.name.span;
  block.vars.push_back(std::move(value));
  const uint32_t number = ask<Collection>().add_pou(made, false, made.name.text);
  sema_.program.types.edit(sema_.declared.pous[number].self).old_name =
      ask<OldNames>().add_made(ask<Types>().resolve_type(decl.spec).type, "#box");
  ask<Objects>().inherit();
  ask<Interfaces>().resolve_interface(number);
  return number;
}

void Pools::add(const Name& name, ir::TypeId type, uint32_t block, bool boxed, uint32_t count) {
  Pool& pool = sema_.pools.all.emplace_back();
  pool.name = name.text;
  pool.type = type;
  pool.block = block;
  pool.boxed = boxed;
  pool.count = count;
  ir::TypeTable& types = sema_.program.types;
  const std::string text(name.text);
  auto global = [&](const char* suffix, ir::TypeId element) {
    return ask<Objects>().add_hidden_global(sema_.declared.keep_name(text + suffix),
                                            types.array(element, {{1, count}}), name.span);
  };
  pool.elements = global("#pool", sema_.declared.pous[block].self);
  pool.states = global("#states", types.elementary(ir::Kind::kByte));
  add_methods(sema_.declared.pous[block].self);
}

void Pools::add_methods(ir::TypeId type) {
  Seen seen;
  add_methods(type, seen);
}

void Pools::add_methods(ir::TypeId type, Seen& seen) {
  const ir::TypeTable& types = sema_.program.types;
  if (!types.contains(type)) return;  // of a member whose type nobody knows
  while (types[type].kind == ir::Kind::kArray) type = types[type].base;
  if (!types.has_members(type)) return;
  const PouInfo* block = sema_.declared.pou_of(type);
  if (block != nullptr && block->reset != kNoPou) return;
  if (!seen.insert(type.index).second) return;
  bool inner_leave = false;
  for (size_t i = 0; i < types[type].members.size(); ++i) {
    const ir::Member member = types[type].members[i];
    if (!ir::is_listed(member)) continue;
    add_methods(member.type, seen);
    inner_leave = inner_leave || leaves(member.type);
  }
  if (block == nullptr || !block->id.valid()) return;
  const uint32_t number = block->number;
  sema_.declared.pous[number].reset =
      ask<Objects>().add_made_method(number, "__RESET", MadeCode::kReset);
  if (!inner_leave) return;
  sema_.declared.pous[number].leave =
      ask<Objects>().add_made_method(number, "__LEAVE", MadeCode::kLeave);
}

bool Pools::leaves(ir::TypeId type) {
  Seen seen;
  return leaves(type, seen);
}

bool Pools::leaves(ir::TypeId type, Seen& seen) {
  const ir::TypeTable& types = sema_.program.types;
  if (!types.contains(type)) return false;
  while (types[type].kind == ir::Kind::kArray) type = types[type].base;
  if (!types.has_members(type) || !seen.insert(type.index).second) return false;
  const PouInfo* block = sema_.declared.pou_of(type);
  if (block != nullptr && ask<Objects>().find_code(block->number, kFbExit).code.method != kNoPou) {
    return true;
  }
  const std::vector<ir::Member>& members = types[type].members;
  return std::any_of(members.begin(), members.end(), [&](const ir::Member& member) {
    return ir::is_listed(member) && leaves(member.type, seen);
  });
}

const Pool* Pools::of_new(ExprId id) {
  if (!sema_.pools.declared) {
    error(DiagnosticCode::kBadPool, sema_.tree[id].span, "no initial value is taken from a pool",
          "call __NEW in FB_Init, or in code");
    return nullptr;
  }
  const Expr* expr = &sema_.tree[id];
  if (expr->kind == ExprKind::kCall) expr = &sema_.tree[expr->operand];
  const bool named = expr->kind == ExprKind::kName || expr->kind == ExprKind::kMember;
  const std::string_view name =
      named ? sema_.namespaces.find(NameSort::kDeclaration, scope_, *expr) : std::string_view();
  for (const Pool& pool : sema_.pools.all) {
    if (!name.empty() && ir::same_name(pool.name, name)) return &pool;
  }
  const PouInfo* block = name.empty() ? nullptr : sema_.declared.find_pou(name);
  const bool type = expr->kind == ExprKind::kType || block != nullptr ||
                    (!name.empty() && ask<Types>().find_type(name));
  const std::string shown = name.empty() ? "this" : "`" + std::string(name) + "`";
  if (!type) {
    error(DiagnosticCode::kBadPool, expr->span, shown + " is no type with a pool",
          "write __NEW(Type), or __NEW(Block(arguments))");
  } else if (expr->kind == ExprKind::kType) {
    error(DiagnosticCode::kBadPool, expr->span, "only types with a name have a pool",
          "declare one: {attribute 'pool' := '16'} TYPE Cell : INT; END_TYPE");
  } else {
    error(DiagnosticCode::kBadPool, expr->span, shown + " has no pool",
          "say how many there can be at once: {attribute 'pool' := '16'} in front of its "
          "declaration");
  }
  return nullptr;
}

Note Pools::infer_new(ExprId type) {
  const Pool* pool = of_new(type);
  if (pool == nullptr) return {};
  Note note;
  note.type = sema_.program.types.pointer(pool->type);
  note.calls = true;
  note.can_trap = true;
  return note;
}

// __DELETE is called for what it does; its value is FALSE.
Note Pools::infer_delete(ExprId pointer) {
  const Note& given = infer(pointer);
  const ir::TypeTable& types = sema_.program.types;
  const bool reference =
      !given.reference.valid() && types.is_reference(given.type) && given.flex != Flex::kNull;
  if (!reference || of_target(types[given.type].base).empty()) {
    error(DiagnosticCode::kBadPool, sema_.tree[pointer].span,
          reference ? "nothing that `" + sema_.report.type_text(given.type) +
                          "` leads to comes from a pool"
                    : "__DELETE takes a variable that __NEW has given a value",
          reference ? "put {attribute 'pool' := '16'} in front of the type's declaration"
                    : "declare it as POINTER TO the type");
    return {};
  }
  Note note;
  note.type = types.elementary(ir::Kind::kBool);
  note.calls = true;
  note.can_trap = true;
  return note;
}

std::vector<const Pool*> Pools::of_target(ir::TypeId target) const {
  std::vector<const Pool*> found;
  for (const Pool& pool : sema_.pools.all) {
    if (pool.type == target || sema_.program.types.is_a(pool.type, target)) found.push_back(&pool);
  }
  return found;
}

}  // namespace frontend
