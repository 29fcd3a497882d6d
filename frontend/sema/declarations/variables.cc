// Variables and members: what a name means, its type and its initial value.

#include "frontend/sema/declarations/variables.h"

#include <limits>

#include "frontend/parse/il_operators.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"
#include "frontend/sfc/declare.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

constexpr uint32_t kMaxVariableChain = 500;

}  // namespace

VarId Variables::find_variable(const Name& name) {
  if (scope_.pou != nullptr) {
    const PouInfo& pou = *scope_.pou;
    if (auto found = pou.names.find(name.text); found != pou.names.end()) return found->second;
    VarId id = ask<Objects>().find_variable(pou.owner != kNoPou ? pou.owner : pou.base, name.text);
    if (id.valid()) return id;
  }
  if (auto own = sema_.declared.lists.find(scope_.list); own != sema_.declared.lists.end()) {
    auto found = own->second.names.find(name.text);
    if (found != own->second.names.end()) return found->second;
  }
  return sema_.namespaces.find_global(name);
}

VarId Variables::find_variable(const Expr& name) {
  if (!name.global) return find_variable(name.name);
  auto found = sema_.declared.globals.find(name.name.text);
  return found == sema_.declared.globals.end() ? VarId() : found->second;
}

const Variable& Variables::resolve_now(VarId id) {
  Variable& variable = sema_.declared.variables[id.index];
  if (variable.progress == Progress::kBusy || sema_.facts.depth >= kMaxVariableChain) {
    if (!variable.type.valid() || variable.constant) {
      error(DiagnosticCode::kRecursiveConstant, variable.name.span,
            quoted(variable.name) + " is needed to know its own type or value");
    }
    return variable;
  }
  variable.progress = Progress::kBusy;
  ++sema_.facts.depth;
  PouScope scope = sema_.declared.scope_of(variable.pou);
  if (variable.pou == kNoPou) scope.list = variable.list;
  Variables(sema_, scope).resolve_variable(id);
  --sema_.facts.depth;
  variable.progress = Progress::kDone;
  return variable;
}

void Variables::resolve_variable(VarId id) {
  Variable& variable = sema_.declared.variables[id.index];
  if (variable.decl == nullptr) {  // a function's result
    TypeUse use = ask<Types>().resolve_type(sema_.declared.pous[variable.pou].decl->result);
    variable.type = use.type;
    variable.init = use.init;
    if (!ir::holds_instance(sema_.program.types, variable.type)) return;
    error(DiagnosticCode::kSectionNotAllowed, variable.name.span,
          "the result of " + quoted(variable.name) +
              " holds an instance of a function block, as `" +
              sema_.report.type_text(variable.type) + "`, but is made anew at each call",
          "return a REFERENCE TO it, or copy it to a VAR_IN_OUT");
    variable.type = {};
    return;
  }
  if (variable.pou != kNoPou &&
      sema_.declared.pous[variable.pou].decl->kind == PouKind::kInterface) {
    error(DiagnosticCode::kSectionNotAllowed, variable.name.span,
          "an interface has no variables, such as " + quoted(variable.name),
          "make it a PROPERTY, or declare it in the blocks that implement the interface");
  }
  if (variable.takes_any) {
    if (auto record = ask<Types>().find_type("AnyType")) variable.type = record->type;
    return;
  }
  const bool open = !variable.bound.valid() && is_open_array(variable);
  if (open) {
    variable.by_reference = true;
    variable.type = open_array_type(sema_.tree[variable.decl->spec]);
    return;
  }
  TypeUse use = variable.bound.valid() ? TypeUse{variable.bound, {}}
                                       : ask<Types>().resolve_type(variable.decl->spec);
  variable.type = use.type;
  variable.init = use.init;
  if (!variable.type.valid()) return;
  if (variable.section == VarSection::kExternal) {
    resolve_external(variable);
    return;
  }
  check_placement(variable);
  // A slot has no place that another frame could point to (ADR 0006).
  if (variable.section == VarSection::kInOut &&
      sema_.program.types[variable.type].kind == ir::Kind::kFunctionBlock) {
    variable.by_reference = true;
    variable.type = sema_.program.types.reference_to(variable.type);
    variable.init = {};
  }
  check_address(variable);
  check_edge(variable);
  check_binding(*variable.decl, variable.type);
  if (variable.decl->init.valid() && !variable.hidden) resolve_initial(variable);
  // Later than any time: a clock that has never been called stands still once (chart_steps.cc).
  if (variable.decl->implied && variable.name.text.ends_with(sfc::kClock)) {
    constexpr int64_t kLatest = std::numeric_limits<int64_t>::max();
    variable.init = sema_.program.constants.add({static_cast<uint64_t>(kLatest), {}, {}});
  }
}

// `r : REFERENCE TO INT REF= x`
void Variables::check_binding(const VarDecl& decl, ir::TypeId type) {
  if (!decl.binds || sema_.program.types[type].kind == ir::Kind::kReferenceTo) return;
  error(DiagnosticCode::kBadReference, sema_.tree[decl.init].span,
        "`" + sema_.report.type_text(type) + "` is not a REFERENCE TO",
        "give the initial value with `:=`");
}

void Variables::resolve_external(Variable& variable) {
  const VarId found = sema_.namespaces.find_global(variable.name);
  if (!found.valid()) {
    NearestName nearest(variable.name.text);
    nearest.offer_all(sema_.declared.globals);
    error(DiagnosticCode::kUnknownName, variable.name.span,
          "there is no global variable " + quoted(variable.name), nearest.fix());
    variable.type = {};
    return;
  }
  variable.external = found;
  const Variable& global = resolve(found);
  if (global.type.valid() && global.type != variable.type) {
    error(DiagnosticCode::kExternalMismatch, variable.name.span,
          quoted(variable.name) + " is `" + sema_.report.type_text(global.type) +
              "`, declared here as `" + sema_.report.type_text(variable.type) + "`");
    variable.external = {};
    variable.type = {};
  }
}

// Functions' own variables are initialised at each call, so any expression will do.
void Variables::resolve_initial(Variable& variable) {
  ExprId init = variable.decl->init;
  const Expr& expr = sema_.tree[init];
  bool list = expr.kind == ExprKind::kArrayInit || expr.kind == ExprKind::kStructInit;
  bool at_call = variable.section == VarSection::kTemp ||
                 (variable.storage == Storage::kLocal && variable.section == VarSection::kLocal);
  if (at_call && !variable.constant && !list && infer(init).known < Known::kByCall) {
    variable.runtime_init = true;
    return;
  }
  const bool parameter = variable.storage == Storage::kLocal &&
                         (variable.section == VarSection::kInput || variable.constant);
  const Bound bound = variable.constant || parameter ? Bound::kNow : Bound::kAtStart;
  const Known least = at_call && variable.constant ? Known::kByCall : Known::kInitially;
  variable.init = ask<Constants>().initial_value(init, variable.type, variable.init, least, bound);
}

void Variables::check_placement(const Variable& variable) {
  const ir::Type& type = sema_.program.types[variable.type];
  const PouInfo* block = sema_.declared.pou_of(variable.type);
  const bool in_test = variable.pou != kNoPou && sema_.declared.pous[variable.pou].test;
  if (type.kind == ir::Kind::kProgram || (block != nullptr && block->as_block && !in_test)) {
    error(DiagnosticCode::kTypeMismatch, variable.name.span,
          "`" + type.name + "` is a program; a variable cannot be one",
          "make it a FUNCTION_BLOCK, declare the program in a CONFIGURATION, or the variable in a "
          "TEST");
  }
  if (variable.section != VarSection::kInOut)
    ask<Objects>().check_instance(variable.type, variable.name.span);
  // A block alone is a variable like others in functions of codesys and twincat.
  const bool alone = type.kind == ir::Kind::kFunctionBlock;
  const bool holds_instance = ir::holds_instance(sema_.program.types, variable.type);
  bool anew = !variable.each_call &&
              (variable.storage == Storage::kLocal || variable.section == VarSection::kTemp);
  if (holds_instance && anew && variable.section != VarSection::kInOut) {
    error(DiagnosticCode::kSectionNotAllowed, variable.name.span,
          quoted(variable.name) + (alone ? " is an instance of `" : " holds instances, as `") +
              sema_.report.type_text(variable.type) + "`, but is made anew at each call",
          "declare it in VAR of a function block or program, or pass it as VAR_IN_OUT");
  }
}

Fix Variables::name_suggestion(std::string_view name, bool callable, bool instruction) const {
  NearestName nearest(name);
  if (scope_.pou != nullptr) nearest.offer_all(scope_.pou->names);
  for (uint32_t at = sema_.declared.block_of(scope_); at != kNoPou;
       at = sema_.declared.pous[at].base) {
    auto own = sema_.declared.pous[at].names.find(name);
    if (own != sema_.declared.pous[at].names.end() &&
        sema_.declared.variables[own->second.index].section == VarSection::kTemp) {
      return "VAR_TEMP is seen by the body and its actions only; declare it in VAR";
    }
    nearest.offer_all(sema_.declared.pous[at].names);
    nearest.offer_all(sema_.declared.pous[at].code);
  }
  nearest.offer_all(sema_.declared.globals);
  if (callable) {
    nearest.offer_all(sema_.declared.pou_names);
    nearest.offer_all(sema_.library.functions);
    if (sema_.for_tests()) {
      for (const TestCallRow& row : test_calls()) nearest.offer(row.name);
    }
    if (instruction) {
      for (const IlOperator& op : il_operators()) nearest.offer(op.word);
    }
  } else {
    nearest.offer_all(sema_.declared.literals);
  }
  return nearest.fix();
}

}  // namespace frontend
