// What runs once, before the first scan, after all initial values: FB_Init of every instance
// (docs/adr/0006-objects.md). A block with members that need it has a method __START, which
// calls those of its members and then their FB_Init; a hidden program __START does so for the
// globals and calls __START of every program instance.
#include <algorithm>
#include <unordered_map>

#include "base/hash.h"
#include "base/limits.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/objects/pools.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"
#include "ir/types/stamps.h"

namespace frontend {
namespace {

constexpr std::string_view kStampName = "#stamp";
constexpr std::string_view kChangeFlag = "#changed";

bool has_arguments(const Tree& tree, SpecId id) {
  const Spec& spec = tree[id];
  if (spec.kind == SpecKind::kArray) {
    return spec.element_args.count != 0 || has_arguments(tree, spec.element);
  }
  return spec.kind == SpecKind::kNamed && spec.has_args;
}

// What of a type decides how a variable of it is laid out; instances have areas of their own. Of
// what is long, a hash: of thirty structures that hold the one before twice, the last has a billion
// parts.
class Shapes {
 public:
  explicit Shapes(const ir::TypeTable& types) : types_(types) {}

  std::string of(ir::TypeId id) {
    if (!id.valid()) return "?";  // after an error that was said
    const ir::Type& type = types_[id];
    if (type.kind == ir::Kind::kArray) {
      std::string text = "[";
      for (const ir::Dimension& dim : type.dims) {
        text += std::to_string(dim.low) + ".." + std::to_string(dim.high) + ",";
      }
      return text + "]" + of(type.base);
    }
    if (!ir::is_structure(type.kind)) return types_.text(id);
    if (const auto known = known_.find(id); known != known_.end()) return known->second;
    std::string text = types_.text(id);
    for (const ir::Member& member : type.members) {
      text += "{" + ir::fold_name(member.name) + ":" + of(member.type) + "}";
    }
    if (text.size() > kMaxText) text = "#" + std::to_string(base::hash64(base::as_bytes(text)));
    return known_[id] = text;
  }

 private:
  static constexpr size_t kMaxText = 16 * 1024;

  const ir::TypeTable& types_;
  std::unordered_map<ir::TypeId, std::string> known_;  // of structures
};

}  // namespace

bool Objects::starts(ir::TypeId type, ir::ConstId init) {
  return sema_.start_values.inside(type, init) || constructs(type);
}

bool Objects::constructs(ir::TypeId type) {
  if (!type.valid()) return false;
  const ir::TypeTable& types = sema_.program.types;
  while (types[type].kind == ir::Kind::kArray) type = types[type].base;
  if (!types.has_members(type)) return false;
  if (auto known = sema_.started.constructs.find(type); known != sema_.started.constructs.end())
    return known->second;
  sema_.started.constructs.emplace(type, false);  // types do not contain themselves
  const PouInfo* block = sema_.declared.pou_of(type);
  bool needed = block != nullptr && (block->stamp.valid() || has_members_to_start(*block));
  for (size_t i = 0; block == nullptr && i < types[type].members.size() && !needed; ++i) {
    needed = constructs(types[type].members[i].type);
  }
  sema_.started.constructs[type] = needed;
  return needed;
}

const Spec* Objects::construction(SpecId id) const {
  for (uint32_t depth = 0; depth < base::kMaxNesting; ++depth) {
    const Spec& spec = sema_.tree[id];
    if (spec.kind != SpecKind::kNamed || spec.has_args) break;
    auto named = sema_.declared.types.find(
        sema_.namespaces.find(NameSort::kDeclaration, spec.qualifiers, spec.name));
    if (named == sema_.declared.types.end()) break;
    id = named->second;
  }
  return &sema_.tree[id];
}

void Objects::check_start_arguments(SpecId id, ir::TypeId type, std::vector<bool>& good) {
  const bool arguments = has_arguments(sema_.tree, id);
  for (; sema_.tree[id].kind == SpecKind::kArray; id = sema_.tree[id].element) {
    good[id.index] = true;
  }
  good[id.index] = true;
  if (!arguments || !type.valid() || constructs(type)) return;
  error(DiagnosticCode::kBadConstruction, sema_.tree[id].span,
        "`" + sema_.report.type_text(type) + "` has no FB_Init that takes arguments",
        "write `:=` and a value, or (member := value)");
}

// Arguments stand after the types of variables, members of structures and declared types, and
// there has to be an FB_Init for them.
void Objects::check_start_arguments() {
  std::vector<bool> good(sema_.tree.specs.size());
  for (const Variable& variable : sema_.declared.variables) {
    if (variable.decl == nullptr || !variable.decl->spec.valid()) continue;
    check_start_arguments(variable.decl->spec, variable.type, good);
  }
  auto check = [&](SpecId id) {
    if (!id.valid() || !has_arguments(sema_.tree, id)) return;
    check_start_arguments(id, ask<Types>().resolve_type(id).type, good);
  };
  for (const TypeDecl& decl : sema_.tree.types) check(decl.spec);
  for (const Spec& spec : sema_.tree.specs) {
    if (spec.kind != SpecKind::kStruct) continue;
    for (const VarDecl& field : spec.fields) check(field.spec);
  }
  for (uint32_t i = 0; i < sema_.tree.specs.size(); ++i) {
    const Spec& spec = sema_.tree.specs[i];
    if (good[i] || (!spec.has_args && spec.element_args.count == 0)) continue;
    error(DiagnosticCode::kBadConstruction, spec.span, "arguments of FB_Init have no place here",
          "give them where a variable, a member or a type is declared");
  }
}

// After all interfaces are resolved and the program instances are known.
void Objects::add_start() {
  ask<Pools>().declare();
  check_start_arguments();
  if (sema_.report.has_errors()) return;
  const auto count = static_cast<uint32_t>(sema_.declared.pous.size());
  for (uint32_t i = 0; i < count; ++i) {
    if (!has_members_to_start(sema_.declared.pous[i])) continue;
    sema_.declared.pous[i].start = add_made_method(i, ir::kStartProgram, MadeCode::kStart);
  }
  for (uint32_t i = 0; i < sema_.declared.variables.size(); ++i) {
    const Variable& variable = sema_.declared.variables[i];
    const bool global = variable.storage == Storage::kGlobal && !variable.hidden &&
                        variable.section != VarSection::kExternal && !variable.each_call;
    if (global && starts(variable.type, variable.init)) sema_.started.globals.push_back(VarId(i));
  }
  for (const ir::ProgramInstance& instance : sema_.program.instances) {
    const PouInfo* program = sema_.declared.pou_of(instance.type);
    if (program != nullptr && program->start != kNoPou) {
      sema_.started.globals.push_back(program_global(instance.name, *program));
    }
  }
  for (uint32_t i = 0; i < count; ++i) {
    const PouInfo& program = sema_.declared.pous[i];
    if (!program.as_block || program.start == kNoPou) continue;
    sema_.started.globals.push_back(ask<Variables>().program_variable(program.name, false));
  }
  const bool pools = !sema_.pools.all.empty();
  const bool at_calls =
      std::any_of(sema_.declared.pous.begin(), sema_.declared.pous.end(),
                  [](const PouInfo& info) { return !info.call_instances.empty(); });
  const bool none = sema_.declared.pous.size() == count && sema_.started.globals.empty();
  if (none && !pools && !at_calls) return;
  sema_.started.change_flag = add_hidden_global(
      kChangeFlag, sema_.program.types.elementary(ir::Kind::kDword), base::SourceSpan());
  if (sema_.started.globals.empty() && !pools) return;  // blocks that nobody has an instance of
  add_start_program();
}

bool Objects::has_members_to_start(const PouInfo& info) {
  if (info.owner != kNoPou || !info.self.valid() || !info.id.valid()) return false;
  for (const ir::Member& member : sema_.program.types[info.self].members) {
    if (member.section != ir::Section::kInOut && starts(member.type, member.init)) return true;
  }
  return false;
}

uint32_t Objects::add_made_method(uint32_t block, std::string_view name, MadeCode code) {
  const auto number = static_cast<uint32_t>(sema_.declared.pous.size());
  const PouInfo& owner = sema_.declared.pous[block];
  PouDecl& made = sema_.declared.made_decls.emplace_back();
  made.kind = PouKind::kMethod;
  made.name = {name, owner.decl->name.span};
  made.span = owner.decl->span;
  made.scope = owner.decl->scope;
  PouInfo& info = sema_.declared.pous.emplace_back();
  info.number = number;
  info.decl = &made;
  info.library = owner.library;
  info.owner = block;
  info.self = owner.self;
  info.made = code;
  ask<Collection>().add_code(info, sema_.program.types[owner.self].name + "." + std::string(name));
  ask<Interfaces>().resolve_interface(number);
  return number;
}

// The global through which code reaches a program instance.
VarId Objects::program_global(const std::string& name, const PouInfo& program) {
  if (ir::same_name(name, program.decl->name.text))
    return ask<Variables>().program_variable(name, false);
  return add_hidden_global(sema_.declared.keep_name(name), program.self, program.decl->name.span);
}

VarId Objects::add_hidden_global(std::string_view name, ir::TypeId type, base::SourceSpan span) {
  VarId id(static_cast<uint32_t>(sema_.declared.variables.size()));
  Variable variable;
  variable.name = {name, span};
  variable.section = VarSection::kGlobal;
  variable.storage = Storage::kGlobal;
  variable.used = true;
  variable.hidden = true;
  variable.stamp = name == kChangeFlag;
  variable.type = type;
  variable.progress = Progress::kDone;
  sema_.declared.variables.push_back(variable);
  ask<Variables>().place_global(id);
  return id;
}

// A member that says what has been done with an instance (ir/types/stamps.h). The nearest base
// that needs one has it for all that extend it.
void Objects::add_stamp(PouInfo& block) {
  if (block.base != kNoPou) block.stamp = sema_.declared.pous[block.base].stamp;
  bool needed = false;
  for (std::string_view name : {kFbInit, kFbExit, kFbReinit}) {
    auto found = block.code.find(name);
    needed = needed || (found != block.code.end() && found->second.method != kNoPou);
  }
  needed = needed || !called_after_init(block).empty();
  if (block.stamp.valid() || !needed) return;
  block.stamp = VarId(static_cast<uint32_t>(sema_.declared.variables.size()));
  Variable variable;
  variable.name = {kStampName, block.decl->name.span};
  variable.used = true;
  variable.hidden = true;
  variable.stamp = true;
  variable.pou = block.number;
  variable.index = block.inherited + static_cast<uint32_t>(block.members.size());
  variable.type = sema_.program.types.elementary(ir::Kind::kDword);
  variable.progress = Progress::kDone;
  sema_.declared.variables.push_back(variable);
  block.members.push_back(block.stamp);
}

// By names and types of its members, in whatever order they are declared.
uint32_t Objects::stamp_of(const PouInfo& block) const {
  std::vector<std::string> lines;
  Shapes shapes(sema_.program.types);
  for (const ir::Member& member : sema_.program.types[block.self].members) {
    if (member.section == ir::Section::kStamp) continue;
    lines.push_back(ir::fold_name(member.name) + ":" + shapes.of(member.type));
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line + ";";
  return static_cast<uint32_t>(base::hash64(base::as_bytes(text))) | ir::kFirstShapeStamp;
}

bool Objects::runs_bases(std::string_view name) const {
  return sema_.options.dialect != Dialect::kIec && !ir::same_name(name, kFbReinit);
}

std::vector<uint32_t> Objects::called_after_init(const PouInfo& block) const {
  std::vector<const PouDecl*> from_root;
  for (uint32_t at = block.number; at != kNoPou; at = sema_.declared.pous[at].base) {
    from_root.insert(from_root.begin(), sema_.declared.pous[at].decl);
  }
  std::vector<uint32_t> methods;
  for (const PouDecl* decl : from_root) {
    if (sema_.tree.find_attribute(decl->attributes, kCallAfterInit) == nullptr) continue;
    for (const PouDecl& member : decl->members) {
      if (sema_.tree.find_attribute(member.attributes, kCallAfterInit) == nullptr) continue;
      const uint32_t method = find_code(block.number, member.name.text).code.method;
      const bool known = std::find(methods.begin(), methods.end(), method) != methods.end();
      if (method != kNoPou && !known) methods.push_back(method);
    }
  }
  return methods;
}

void Objects::add_start_program() {
  PouDecl& made = sema_.declared.made_decls.emplace_back();
  made.kind = PouKind::kProgram;
  const VarId first =
      sema_.started.globals.empty() ? sema_.pools.all[0].elements : sema_.started.globals[0];
  made.span = sema_.declared.variables[first.index].name.span;
  made.name = {ir::kStartProgram, made.span};
  const uint32_t number = ask<Collection>().add_pou(made, false, made.name.text);
  sema_.declared.pous[number].made = MadeCode::kStart;
  ask<Interfaces>().resolve_interface(number);
  ir::Task task;
  task.name = ir::kStartProgram;
  task.period_ns = 0;
  task.once = true;
  const auto at = static_cast<uint32_t>(sema_.program.tasks.size());
  sema_.program.tasks.push_back(std::move(task));
  sema_.program.instances.push_back(
      {std::string(ir::kStartProgram), sema_.declared.pous[number].self, at, {}});
}

}  // namespace frontend
