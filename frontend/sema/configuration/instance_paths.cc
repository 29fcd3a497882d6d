#include "frontend/sema/configuration/instance_paths.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/types/types.h"

#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/sema.h"

namespace frontend {

namespace {

// %IW0 for an INT; arrays and structures begin at a byte.
std::string example_address(const ir::DirectAddress& open) {
  const char area = open.area == ir::DirectArea::kInput    ? 'I'
                    : open.area == ir::DirectArea::kOutput ? 'Q'
                                                           : 'M';
  std::string out = std::string("%") + area;
  switch (open.bit_size) {
    case 1:
      return out + "X0.0";
    case 16:
      return out + "W0";
    case 32:
      return out + "D0";
    case 64:
      return out + "L0";
    default:
      return out + "B0";
  }
}

}  // namespace

// Where a path leads: `steps` are numbers of members and elements.
struct InstancePaths::Path {
  std::string text;  // "" while only the resource was named
  bool global = false;
  bool fixed = false;  // to a constant, or a part of one
  uint32_t root = 0;   // number of the program instance, or of the global variable
  std::vector<uint32_t> steps;
  ir::TypeId type;
  ir::DirectAddress address;  // as its member declares it
};

void InstancePaths::configure(const std::vector<VarBlock>& blocks) {
  for (const VarBlock& block : blocks) {
    for (const VarDecl& decl : block.vars) {
      if (block.section == VarSection::kConfig) configure_variable(decl);
      if (block.section == VarSection::kAccess) add_access(decl);
    }
  }
}

bool InstancePaths::global(VarId id, Path& path) {
  const Variable& variable = resolve(id);
  sema_.declared.variables[id.index].used = sema_.declared.variables[id.index].written = true;
  const ir::Member& member = sema_.program.types[sema_.program.globals].members[variable.index];
  path.text = member.name;
  path.global = true;
  path.fixed = has_known_value(variable);
  path.root = variable.index;
  path.type = variable.type;
  path.address = member.address;
  if (variable.view.global != AddressView::kNone) view(variable.view, path);
  return path.type.valid();
}

// For shared bytes the path has the name of the view alone.
void InstancePaths::view(const AddressView& view, Path& path) {
  const ir::Member& shared = sema_.program.types[sema_.program.globals].members[view.global];
  const ir::Member& member = sema_.program.types[shared.type].members[view.member];
  path.text = member.name;
  path.root = view.global;
  path.steps.push_back(view.member);
  path.type = member.type;
  path.address = {};
}

bool InstancePaths::head(const Expr& expr, Path& path) {
  for (uint32_t i = 0; i < sema_.program.instances.size(); ++i) {
    if (!ir::same_name(sema_.program.instances[i].name, expr.name.text)) continue;
    path.text = expr.name.text;
    path.root = i;
    path.type = sema_.program.instances[i].type;
    return true;
  }
  if (VarId id = ask<Variables>().find_variable(expr); id.valid()) return global(id, path);
  bool prefix = sema_.declared.resource != nullptr &&
                ir::same_name(sema_.declared.resource->name.text, expr.name.text);
  bool config =
      !sema_.tree.configs.empty() && ir::same_name(sema_.tree.configs[0].name.text, expr.name.text);
  if (prefix || config) return true;
  NearestName nearest(expr.name.text);
  for (const ir::ProgramInstance& instance : sema_.program.instances) nearest.offer(instance.name);
  nearest.offer_all(sema_.declared.globals);
  error(DiagnosticCode::kUnknownName, expr.span,
        "`" + std::string(expr.name.text) + "` is no program instance and no global variable",
        nearest.fix());
  return false;
}

// Private variables too: the path belongs to the plant, not to another POU.
bool InstancePaths::member(const Expr& expr, Path& path) {
  if (path.text.empty()) return head(expr, path);
  int32_t member = -1;
  VarId variable;
  if (const PouInfo* block = sema_.declared.pou_of(path.type)) {
    const VarId found = ask<Objects>().find_variable(block->number, expr.name.text);
    if (found.valid() && resolve(found).view.global != AddressView::kNone) {
      return global(found, path);
    }
    if (found.valid() && resolve(found).storage == Storage::kMember) {
      variable = found;
      path.fixed = path.fixed || has_known_value(resolve(found));
      sema_.declared.variables[found.index].used = sema_.declared.variables[found.index].written =
          true;
      member = static_cast<int32_t>(resolve(found).index);
    }
  } else {
    member = sema_.declared.find_member(path.type, expr.name.text);
  }
  if (member < 0) {
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          "`" + sema_.report.type_text(path.type) + "` has no member `" +
              std::string(expr.name.text) + "`");
    return false;
  }
  auto number = static_cast<uint32_t>(member);
  const ir::Member& chosen = sema_.program.types[path.type].members[number];
  path.address = chosen.address;
  path.type = variable.valid() ? resolve(variable).type : chosen.type;
  path.text += "." + std::string(expr.name.text);
  path.steps.push_back(number);
  return path.type.valid();
}

bool InstancePaths::element(const Expr& expr, Path& path) {
  if (path.text.empty() || sema_.program.types[path.type].kind != ir::Kind::kArray ||
      sema_.program.types[path.type].dims.size() != expr.list.count) {
    error(DiagnosticCode::kNotArray, expr.span, "this path leads to no array of that form");
    return false;
  }
  std::vector<ir::Dimension> dims = sema_.program.types[path.type].dims;
  uint64_t flat = 0;
  path.text += "[";
  for (uint32_t i = 0; i < dims.size(); ++i) {
    auto index = ask<Constants>().fold_integer(sema_.tree.expr_lists[expr.list.first + i]);
    if (!index) return false;
    if (*index < dims[i].low || *index > dims[i].high) {
      error(DiagnosticCode::kIndexOutOfBounds, expr.span,
            "index " + std::to_string(*index) + " is outside " + std::to_string(dims[i].low) +
                ".." + std::to_string(dims[i].high));
      return false;
    }
    path.text += (i == 0 ? "" : ",") + std::to_string(*index);
    flat = flat * dims[i].count() + static_cast<uint64_t>(*index - dims[i].low);
  }
  path.text += "]";
  path.steps.push_back(static_cast<uint32_t>(flat));
  path.type = sema_.program.types[path.type].base;
  path.address = {};
  return true;
}

bool InstancePaths::walk(ExprId id, Path& path) {
  const Expr& expr = sema_.tree[id];
  switch (expr.kind) {
    case ExprKind::kName:
      return head(expr, path);
    case ExprKind::kMember:
      if (VarId found = sema_.namespaces.find_global(scope_, expr); found.valid())
        return global(found, path);
      return walk(expr.operand, path) && member(expr, path);
    case ExprKind::kIndex:
      return walk(expr.operand, path) && element(expr, path);
    case ExprKind::kDirect:
      if (const AddressView* shared = direct_view(*this, expr)) {
        path.global = true;
        view(*shared, path);
        return true;
      }
      path.root = ask<Variables>().direct_member(expr);
      path.text = sema_.program.types[sema_.program.globals].members[path.root].name;
      path.global = true;
      path.type = ask<Variables>().type_of_direct(sema_.tree.directs[expr.number].address);
      return true;
    default:
      error(DiagnosticCode::kUnknownName, expr.span,
            "a path names a program instance and its variables");
      return false;
  }
}

bool InstancePaths::check_type(const VarDecl& decl, const Path& path) {
  TypeUse use = ask<Types>().resolve_type(decl.spec);
  if (!use.type.valid()) return false;
  if (path.text.empty() || use.type != path.type) {
    error(DiagnosticCode::kTypeMismatch, sema_.tree[decl.path].span,
          path.text.empty() ? "the path ends at the resource"
                            : "`" + path.text + "` is `" + sema_.report.type_text(path.type) +
                                  "`, declared here as `" + sema_.report.type_text(use.type) + "`");
    return false;
  }
  return true;
}

void InstancePaths::configure_variable(const VarDecl& decl) {
  Path path;
  if (!decl.path.valid() || !walk(decl.path, path) || !check_type(decl, path)) return;
  if (decl.has_address && !decl.incomplete) {
    bool open =
        path.address.bit_offset == ir::kOpenAddress && path.address.area == decl.address.area;
    const bool plain = path.address.area == ir::DirectArea::kNone &&
                       decl.address.area == ir::DirectArea::kMarker &&
                       sema_.options.dialect != Dialect::kIec;
    std::string problem = open || plain
                              ? ask<Variables>().address_problem(path.type, decl.address, false)
                              : "is not declared with AT %I*, %Q* or %M* of this area";
    if (!problem.empty()) {
      error(DiagnosticCode::kBadAddress, decl.span, "`" + path.text + "` " + problem);
      return;
    }
    if (plain) {
      warning(DiagnosticCode::kAddressNotAsked, decl.span,
              "`" + path.text + "` is not declared with AT %M* and keeps a place of its own",
              "declare it with AT %M* to find it at the marker");
    } else {
      sema_.program.located.push_back({path.text, decl.address});
      sema_.addresses.configured.push_back({decl.address, path.type, decl.span, path.text, true});
    }
  }
  if (!decl.init.valid()) return;
  if (path.fixed) {
    error(DiagnosticCode::kAssignToConstant, decl.span,
          "`" + path.text + "` is a constant: it is what its declaration says",
          "declare it in VAR or VAR_INPUT to set it here");
    return;
  }
  auto configure = [&](ir::ConstId before, ir::TypeId type) {
    return with_initial(before, type, path.steps, 0, decl.init);
  };
  if (path.global) {
    ir::TypeTable& types = sema_.program.types;
    const ir::Member& member = types[sema_.program.globals].members[path.root];
    const ir::ConstId init = configure(member.init, member.type);
    types.edit(sema_.program.globals).members[path.root].init = init;
    return;
  }
  ir::ProgramInstance& instance = sema_.program.instances[path.root];
  instance.init = configure(instance.init, instance.type);
}

// `before` with another value after `steps`.
ir::ConstId InstancePaths::with_initial(ir::ConstId before, ir::TypeId type,
                                        const std::vector<uint32_t>& steps, size_t at,
                                        ExprId init) {
  if (at == steps.size()) return ask<Constants>().initial_value(init, type, before);
  uint32_t step = steps[at];
  bool array = sema_.program.types[type].kind == ir::Kind::kArray;
  ir::ConstId inner = ask<Constants>().listed(before, step);
  if (!inner.valid() && !array) inner = ask<Constants>().member_default(type, step);
  ir::TypeId part =
      array ? sema_.program.types[type].base : sema_.program.types[type].members[step].type;
  ir::ConstId made = with_initial(inner, part, steps, at + 1, init);
  if (!made.valid()) return before;
  ir::ConstValue value;
  if (before.valid()) value.elements = sema_.program.constants[before].elements;
  value.elements.push_back({step, 1, made});
  return sema_.program.constants.add(std::move(value));
}

void InstancePaths::add_access(const VarDecl& decl) {
  Path path;
  if (!decl.path.valid() || decl.names.empty() || !walk(decl.path, path)) return;
  if (!check_type(decl, path)) return;
  for (const ir::AccessPath& other : sema_.program.access) {
    if (!ir::same_name(other.name, decl.names[0].text)) continue;
    error(DiagnosticCode::kDuplicateName, decl.names[0].span,
          "`" + other.name + "` is declared twice");
    return;
  }
  sema_.program.access.push_back({std::string(decl.names[0].text), path.text, decl.writable});
}

// Does a variable of this type, or a part of it, stand at an open address?
bool InstancePaths::holds_open(ir::TypeId type) {
  if (!type.valid()) return false;
  if (auto known = holds_open_.find(type); known != holds_open_.end()) return known->second;
  holds_open_[type] = false;  // blocks in a circle were reported
  const ir::Type& of = sema_.program.types[type];
  bool holds = of.kind == ir::Kind::kArray && holds_open(of.base);
  if (sema_.program.types.has_members(type)) {
    for (const ir::Member& member : of.members) {
      if (member.section == ir::Section::kInOut) continue;
      holds = holds || member.address.bit_offset == ir::kOpenAddress || holds_open(member.type);
    }
  }
  return holds_open_[type] = holds;
}

// With `iec`, every AT %I*, %Q* has to get its address, in each instance; so it has where several
// RESOURCEs, which are linked one by one, share the process image. Else the linker gives one. A
// VAR_CONFIG with a mistake gives none, and what it meant is not to be known.
void InstancePaths::check_open_addresses() {
  const bool alone = sema_.tree.configs.empty() || sema_.tree.configs[0].resources.size() < 2;
  if (sema_.options.dialect != Dialect::kIec && alone) return;
  if (sema_.report.has_errors()) return;
  Known known;
  for (const ir::LocatedPath& located : sema_.program.located) {
    known.insert(ir::fold_name(located.path));
  }
  if (holds_open(sema_.program.globals)) {
    check_members(sema_.program.globals, "", {}, known);
  }
  for (const ir::ProgramInstance& instance : sema_.program.instances) {
    if (holds_open(instance.type)) check_part(instance.type, instance.name, {}, known);
  }
}

// `span`: of the nearest variable around it that a source declares.
void InstancePaths::check_part(ir::TypeId type, const std::string& path, base::SourceSpan span,
                               const Known& known) {
  const ir::Type of = sema_.program.types[type];
  if (of.kind != ir::Kind::kArray) return check_members(type, path + ".", span, known);
  uint64_t count = 1;
  for (const ir::Dimension& dim : of.dims) count *= dim.count();
  for (uint64_t i = 0; i < count; ++i) {
    std::string indices;
    uint64_t rest = i;
    for (size_t d = of.dims.size(); d-- > 0;) {
      int64_t index = of.dims[d].low + static_cast<int64_t>(rest % of.dims[d].count());
      rest /= of.dims[d].count();
      indices = std::to_string(index) + (indices.empty() ? "" : "," + indices);
    }
    check_part(of.base, path + "[" + indices + "]", span, known);
  }
}

void InstancePaths::check_members(ir::TypeId type, const std::string& prefix, base::SourceSpan span,
                                  const Known& known) {
  const std::vector<ir::Member> members = sema_.program.types[type].members;
  const PouInfo* block = sema_.declared.pou_of(type);
  for (uint32_t i = 0; i < members.size(); ++i) {
    bool open = members[i].address.bit_offset == ir::kOpenAddress;
    bool inside = members[i].section != ir::Section::kInOut && holds_open(members[i].type);
    if (!open && !inside) continue;
    std::string path = prefix + members[i].name;
    base::SourceSpan here = span;
    VarId variable;
    bool declared = type == sema_.program.globals && i < sema_.declared.global_order.size();
    if (declared) variable = sema_.declared.global_order[i];
    if (block != nullptr) variable = ask<Objects>().member_variable(*block, i);
    if (variable.valid()) here = resolve(variable).name.span;
    if (open && !known.contains(ir::fold_name(path))) {
      error(DiagnosticCode::kOpenAddress, here, "`" + path + "` has no address yet",
            "add VAR_CONFIG " + path + " AT " + example_address(members[i].address) + " : " +
                sema_.report.type_text(members[i].type) + "; END_VAR");
    }
    if (inside) check_part(members[i].type, path, here, known);
  }
}

}  // namespace frontend
