// Functions whose parameters leave types open: ANY_NUM and the like, ARRAY[*]. Each
// combination of argument types gives an instance with code of its own. So do STRING
// in-outs whose argument has another capacity: inside, the argument's own one counts.
#include "frontend/sema/calls/open_functions.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/positional.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

constexpr std::string_view kGenericNames[] = {
    "ANY",      "ANY_ELEMENTARY", "ANY_MAGNITUDE", "ANY_NUM",      "ANY_REAL",
    "ANY_INT",  "ANY_SIGNED",     "ANY_UNSIGNED",  "ANY_BIT",      "ANY_CHARS",
    "ANY_CHAR", "ANY_STRING",     "ANY_DATE",      "ANY_DURATION", "ANY_DERIVED",
};

}  // namespace

// The hierarchy of generic types (edition 3, figure 5).
bool OpenFunctions::belongs(const ir::TypeTable& types, std::string_view group, ir::TypeId type) {
  Traits t = traits_of(types, type);
  auto is = [group](std::string_view name) { return ir::same_name(group, name); };
  bool elementary = types.is_scalar(type) || is_string(types, type);
  if (is("ANY")) return true;
  if (is("ANY_DERIVED")) return !elementary || t.enumeration;
  if (is("ANY_ELEMENTARY")) return elementary;
  if (is("ANY_MAGNITUDE")) return t.number() || t.duration;
  if (is("ANY_NUM")) return t.number();
  if (is("ANY_REAL")) return t.real;
  if (is("ANY_INT")) return t.integer;
  if (is("ANY_SIGNED")) return t.integer && ir::is_signed(types.scalar(type));
  if (is("ANY_UNSIGNED")) return t.integer && !ir::is_signed(types.scalar(type));
  if (is("ANY_BIT")) return t.bits || t.boolean;
  if (is("ANY_CHARS")) return t.character || is_string(types, type);
  if (is("ANY_CHAR")) return t.character;
  if (is("ANY_STRING")) return is_string(types, type);
  return is("ANY_DATE") ? t.date : t.duration;
}

bool Collection::is_generic_name(std::string_view name) const {
  for (std::string_view generic : kGenericNames) {
    if (ir::same_name(name, generic)) return true;
  }
  return false;
}

bool Collection::is_open(const PouDecl& decl) const {
  if (decl.kind != PouKind::kFunction) return false;
  for (const VarBlock& block : decl.blocks) {
    if (!is_parameter(block.section)) continue;
    for (const VarDecl& variable : block.vars) {
      if (!variable.spec.valid() || takes_any(variable, block.section, decl)) continue;
      const Spec& spec = sema_.tree[variable.spec];
      bool generic = spec.kind == SpecKind::kNamed && is_generic_name(spec.name.text);
      if (generic || (spec.kind == SpecKind::kArray && spec.open_bounds)) return true;
    }
  }
  return false;
}

// Quiet: what does not match is reported where the call is lowered.
std::vector<Match> OpenFunctions::match(const Expr& call, const PouInfo& callee) const {
  const Arg* const args = sema_.tree.args.data() + call.list.first;
  const Arg* const named =
      std::find_if(args, args + call.list.count, [](const Arg& arg) { return !arg.name.empty(); });
  const std::vector<VarId> parameters = positional_parameters(
      sema_.declared, callee.variables, callee.result, static_cast<uint32_t>(named - args));
  std::vector<Match> matches;
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = sema_.tree.args[call.list.first + i];
    if (!arg.value.valid() || ask<Calls>().is_enable(arg, &callee)) continue;
    if (arg.name.empty()) {
      if (i < parameters.size()) matches.push_back({parameters[i], &arg});
      continue;
    }
    auto found = callee.names.find(arg.name.text);
    if (found != callee.names.end()) matches.push_back({found->second, &arg});
  }
  return matches;
}

Callee OpenFunctions::select_function(const Expr& call, uint32_t first) {
  uint32_t pou = first;
  if (sema_.declared.pous[first].overload != kNoPou) pou = select_overload(call, first);
  if (pou == kNoPou) return {};
  if (sema_.declared.pous[pou].open) return bind_open(call, pou);
  Callee callee;
  callee.kind = Callee::Kind::kFunction;
  callee.pou = string_variant(call, pou);
  return callee;
}

Callee OpenFunctions::bind_open(const Expr& call, uint32_t pou) {
  const PouInfo& info = sema_.declared.pous[pou];
  NameMap<Note> generic;
  ParameterTypes types(info.variables.size());
  for (const Match& match : this->match(call, info)) {
    const Variable& parameter = sema_.declared.variables[match.parameter.index];
    const Spec& spec = sema_.tree[parameter.decl->spec];
    bool named = spec.kind == SpecKind::kNamed && !parameter.takes_any &&
                 ask<Collection>().is_generic_name(spec.name.text);
    if (named && !bind_generic(match, spec, generic)) return {};
    bool open = spec.kind == SpecKind::kArray && spec.open_bounds;
    if (open && !bind_array(match, spec, generic)) return {};
  }
  NameMap<ir::TypeId> bound;
  for (const auto& [name, note] : generic) bound.emplace(name, note.type);
  for (const Match& match : this->match(call, info)) {
    const Variable& parameter = sema_.declared.variables[match.parameter.index];
    const Spec& spec = sema_.tree[parameter.decl->spec];
    bool open = spec.kind == SpecKind::kArray && spec.open_bounds;
    bool generic_name = spec.kind == SpecKind::kNamed && bound.contains(spec.name.text);
    bool exact = generic_name || spec.kind == SpecKind::kString;  // in-outs; ANY_INT of a subrange
    if (!open && !(exact && parameter.section == VarSection::kInOut)) continue;
    for (size_t i = 0; i < info.variables.size(); ++i) {
      if (info.variables[i] == match.parameter) types[i] = infer(match.arg->value).type;
    }
  }
  for (size_t i = 0; i < info.variables.size(); ++i) {
    const Variable& parameter = sema_.declared.variables[info.variables[i].index];
    if (parameter.decl == nullptr) continue;
    const Spec& spec = sema_.tree[parameter.decl->spec];
    if (spec.kind == SpecKind::kArray && spec.open_bounds && !types[i].valid()) {
      error(DiagnosticCode::kMissingInOut, call.span,
            "`" + std::string(parameter.name.text) + "` of `" + std::string(info.decl->name.text) +
                "` is not connected");
      return {};
    }
    bool named = spec.kind == SpecKind::kNamed && !parameter.takes_any &&
                 ask<Collection>().is_generic_name(spec.name.text);
    if (!named || bound.contains(spec.name.text)) continue;
    error(DiagnosticCode::kBadGenericArgument, call.span,
          "no argument says what `" + std::string(spec.name.text) + "` is for `" +
              std::string(parameter.name.text) + "`",
          "give that argument");
    return {};
  }
  Callee callee;
  callee.kind = Callee::Kind::kFunction;
  callee.pou = instance_of(pou, types, std::move(bound));
  return callee;
}

// One name stands for one type in a call; literals take the others' type.
bool OpenFunctions::bind_generic(const Match& match, const Spec& spec, NameMap<Note>& generic) {
  const Note& argument = infer(match.arg->value);
  if (!argument.type.valid()) return false;
  auto [known, first] = generic.try_emplace(spec.name.text, argument);
  base::SourceSpan span = sema_.tree[match.arg->value].span;
  if (!first) known->second = ask<OperatorTypes>().unify(known->second, argument, span);
  if (!known->second.type.valid()) return false;
  known->second.type = without_range(sema_.program.types, known->second.type);
  if (belongs(sema_.program.types, spec.name.text, known->second.type)) return true;
  error(DiagnosticCode::kBadGenericArgument, span,
        "`" + sema_.report.type_text(argument.type) + "` is no " + std::string(spec.name.text));
  return false;
}

bool OpenFunctions::bind_array(const Match& match, const Spec& spec, NameMap<Note>& generic) {
  const Note& argument = infer(match.arg->value);
  if (!argument.type.valid()) return false;
  const ir::Type& array = sema_.program.types[argument.type];
  base::SourceSpan span = sema_.tree[match.arg->value].span;
  const OpenArray* open = sema_.declared.open_array(argument.type);
  const Variable& parameter = sema_.declared.variables[match.parameter.index];
  if (open != nullptr && open->dims == spec.dims.size() &&
      parameter.section == VarSection::kInOut) {
    return bind_element(open->element, spec, span, generic);
  }
  if (array.kind != ir::Kind::kArray || array.dims.size() != spec.dims.size()) {
    error(DiagnosticCode::kBadGenericArgument, span,
          "`" + sema_.report.type_text(argument.type) + "` is no array with " +
              std::to_string(spec.dims.size()) + " dimensions");
    return false;
  }
  return bind_element(array.base, spec, span, generic);
}

bool OpenFunctions::bind_element(ir::TypeId given, const Spec& spec, base::SourceSpan span,
                                 NameMap<Note>& generic) {
  const Spec& element = sema_.tree[spec.element];
  if (element.kind == SpecKind::kNamed && ask<Collection>().is_generic_name(element.name.text)) {
    Note note;
    note.type = given;
    generic.try_emplace(element.name.text, note);
    return true;
  }
  ir::TypeId wanted = Types(sema_).resolve_type(spec.element).type;
  if (!wanted.valid() || wanted == given) return wanted.valid();
  error(DiagnosticCode::kBadGenericArgument, span,
        "an array of `" + sema_.report.type_text(given) + "` where one of `" +
            sema_.report.type_text(wanted) + "` is needed");
  return false;
}

// In-out strings keep the capacity that the argument has.
uint32_t OpenFunctions::string_variant(const Expr& call, uint32_t pou) {
  const PouInfo& info = sema_.declared.pous[pou];
  ParameterTypes types(info.variables.size());
  bool other = false;
  for (const Match& match : this->match(call, info)) {
    if (sema_.declared.variables[match.parameter.index].section != VarSection::kInOut) continue;
    ir::TypeId parameter = resolve(match.parameter).type;
    ir::TypeId given = infer(match.arg->value).type;
    if (!is_string(sema_.program.types, parameter) || !is_string(sema_.program.types, given))
      continue;
    const ir::Type& wanted = sema_.program.types[parameter];
    const ir::Type& string = sema_.program.types[given];
    bool fits = sema_.options.dialect != Dialect::kIec || string.capacity >= wanted.capacity;
    if (wanted.kind != string.kind || wanted.capacity == string.capacity || !fits) continue;
    for (size_t i = 0; i < info.variables.size(); ++i) {
      if (info.variables[i] == match.parameter) types[i] = given;
    }
    other = true;
  }
  return other ? instance_of(pou, types, {}) : pou;
}

uint32_t OpenFunctions::instance_of(uint32_t pou, const ParameterTypes& types,
                                    NameMap<ir::TypeId> generic) {
  const PouInfo& original = sema_.declared.pous[pou];
  std::vector<uint32_t> key;
  std::string name;
  for (size_t i = 0; i < types.size(); ++i) {
    const Variable& variable = sema_.declared.variables[original.variables[i].index];
    ir::TypeId type = types[i];
    if (!type.valid() && variable.decl != nullptr) {
      auto found = generic.find(sema_.tree[variable.decl->spec].name.text);
      if (found != generic.end()) type = found->second;
    }
    key.push_back(type.index);
    if (type.valid()) name += (name.empty() ? "" : ",") + sema_.report.type_text(type);
  }
  auto [known, added] = sema_.declared.instances.try_emplace(
      {pou, std::move(key)}, static_cast<uint32_t>(sema_.declared.pous.size()));
  if (!added) return known->second;
  uint32_t number = known->second;
  PouInfo& info = sema_.declared.pous.emplace_back();
  info.number = number;
  info.decl = original.decl;
  info.name = original.name;
  info.library = original.library;
  info.meaning = std::make_unique<Meaning>();
  info.meaning->generic = std::move(generic);
  info.id = ir::PouId(static_cast<uint32_t>(sema_.program.pous.size()));
  ir::Pou code;
  code.name = std::string(info.name) + "(" + name + ")";
  while (sema_.program.find_pou(code.name).valid()) code.name += "'";
  sema_.program.pous.push_back(std::move(code));
  ask<Collection>().collect_interface(number);
  for (size_t i = 0; i < types.size() && i < info.variables.size(); ++i) {
    sema_.declared.variables[info.variables[i].index].bound = types[i];
  }
  if (sema_.declared.complete) ask<Interfaces>().resolve_interface(number);
  return number;
}

}  // namespace frontend
