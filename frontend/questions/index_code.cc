// What names in code mean.
#include "frontend/questions/indexer.h"
#include "frontend/sema/calls/positional.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "ir/types/address_text.h"

namespace frontend::questions {

static Role role_of(Use use) {
  return use == Use::kBoth      ? Role::kReadWritten
         : use == Use::kWritten ? Role::kWritten
                                : Role::kRead;
}

void Indexer::visit(const Expr& expr, ExprId id, Use use) {
  const Role role = role_of(use);
  switch (expr.kind) {
    case ExprKind::kName:
      add(expr.name.span, plain_name(expr, known(id)), role);
      return;
    case ExprKind::kMember:
      add(expr.name.span, member(expr, known(id)), role);
      return;
    case ExprKind::kQualified: {
      const Note& note = known(id);
      const Name type = tree_.name(expr.number);
      add(type.span, declaration_named(sema_.namespaces.find(NameSort::kDeclaration, type)),
          Role::kRead);
      if (note.type.valid()) {
        add(expr.name.span, enumerator_symbol(note.type, expr.name.text), Role::kRead);
      }
      return;
    }
    case ExprKind::kDirect:
      add(expr.span, address(expr), role);
      return;
    case ExprKind::kCall:
      call_arguments(expr);
      return;
    default:
      return;
  }
}

// %IX0.0; one with levels, or of another resource, is no place that can be asked for.
std::optional<Symbol> Indexer::address(const Expr& expr) {
  const ir::DirectAddress at = tree_.directs[expr.number].address;
  if (at.area == ir::DirectArea::kNone || expr.operand.valid()) return std::nullopt;
  Symbol symbol;
  symbol.kind = SymbolKind::kAddress;
  symbol.name = ir::address_text(at);
  symbol.type = type_of_direct(sema_.program.types, at);
  symbol.address = at;
  return symbol;
}

std::optional<Symbol> Indexer::declaration_named(std::string_view name) {
  if (name.empty()) return std::nullopt;
  if (const PouInfo* pou = sema_.declared.find_pou(name)) return pou_symbol(*pou);
  if (auto type = type_symbol(name)) return type;
  const auto row = sema_.library.functions.find(name);
  if (row == sema_.library.functions.end()) return std::nullopt;
  Symbol symbol;
  symbol.kind = SymbolKind::kStandardFunction;
  symbol.name = std::string(row->second->name);
  symbol.row = row->second;
  return symbol;
}

// A variable, method, action or property of the block or its bases.
std::optional<Symbol> Indexer::in_block(uint32_t block, const Name& name) {
  if (block == kNoPou) return std::nullopt;
  for (uint32_t at = block; at != kNoPou; at = sema_.declared.pous[at].base) {
    const auto& names = sema_.declared.pous[at].names;
    if (const auto found = names.find(name.text); found != names.end()) {
      return variable_symbol(found->second);
    }
  }
  const Objects::Found found = Objects(sema_, scope_).find_code(block, name.text);
  if (found.owner == kNoPou) return std::nullopt;
  const MemberCode& code = found.code;
  const uint32_t number = code.method != kNoPou   ? code.method
                          : code.getter != kNoPou ? code.getter
                                                  : code.setter;
  return pou_symbol(sema_.declared.pous[number]);
}

std::optional<Symbol> Indexer::plain_name(const Expr& expr, const Note& note) {
  if (note.variable.valid()) return variable_symbol(note.variable);
  if (const VarId id = Variables(sema_, scope_).find_variable(expr); id.valid()) {
    return variable_symbol(id);
  }
  if (expr.global) return std::nullopt;
  if (auto own = in_block(sema_.declared.block_of(scope_), expr.name)) return own;
  const bool literal = note.type.valid() && note.constant;
  if (literal) {
    if (auto found = enumerator_symbol(note.type, expr.name.text)) return found;
  }
  return declaration_named(sema_.namespaces.find(NameSort::kDeclaration, scope_, expr));
}

// The block or interface whose members stand after the dot.
uint32_t Indexer::block_before_dot(ExprId operand) {
  const Expr& expr = tree_[operand];
  const uint32_t own = sema_.declared.block_of(scope_);
  if (Objects(sema_, scope_).is_own(expr)) {
    const bool super = Objects(sema_, scope_).is_super(expr);
    return own == kNoPou || !super ? own : sema_.declared.pous[own].base;
  }
  ir::TypeId type = known(operand).type;
  if (!type.valid()) return kNoPou;
  if (is_interface(sema_.program.types, type)) type = sema_.program.types[type].base;
  const PouInfo* pou = sema_.declared.pou_of(type);
  return pou == nullptr ? kNoPou : pou->number;
}

std::optional<Symbol> Indexer::member(const Expr& expr, const Note& note) {
  if (note.variable.valid()) return variable_symbol(note.variable);  // of a list, or a namespace
  if (auto found = in_block(block_before_dot(expr.operand), expr.name)) return found;
  const ir::TypeId before = known(expr.operand).type;
  if (before.valid() && ir::is_structure(sema_.program.types[before].kind)) {
    return field_symbol(before, expr.name);
  }
  if (note.type.valid() && note.constant) {
    if (auto found = enumerator_symbol(note.type, expr.name.text)) return found;
  }
  if (before.valid()) return variable_symbol(Variables(sema_, scope_).find_variable(expr.name));
  if (const VarId global = sema_.namespaces.find_global(scope_, expr); global.valid()) {
    return variable_symbol(global);
  }
  return declaration_named(sema_.namespaces.find(NameSort::kDeclaration, scope_, expr));
}

// What is called, by the head of the call: a POU with parameters.
const PouInfo* Indexer::callee(const Expr& head) {
  std::optional<Symbol> symbol;
  if (head.kind == ExprKind::kName) symbol = plain_name(head, Note());
  if (head.kind == ExprKind::kMember) symbol = member(head, Note());
  if (symbol && symbol->pou != kNoPou) return &sema_.declared.pous[symbol->pou];
  if (!symbol && !Objects(sema_, scope_).is_own(head)) return nullptr;
  if (symbol) return symbol->type.valid() ? sema_.declared.pou_of(symbol->type) : nullptr;
  const uint32_t own = sema_.declared.block_of(scope_);
  const bool super = own != kNoPou && Objects(sema_, scope_).is_super(head);
  const uint32_t number = super ? sema_.declared.pous[own].base : own;
  return number == kNoPou ? nullptr : &sema_.declared.pous[number];
}

const PouInfo* Indexer::called_by(const Expr& call) {
  const Note& head = known(call.operand);
  const PouInfo* pou = head.type.valid() ? sema_.declared.pou_of(head.type) : nullptr;
  return pou != nullptr ? pou : callee(tree_[call.operand]);
}

// What a pointer, an instance or an interface leads to is no part of it.
bool Indexer::is_part(const Expr& expr) {
  const ir::TypeId whole = known(expr.operand).type;
  if (!whole.valid()) return true;
  const ir::TypeTable& types = sema_.program.types;
  return !types.is_reference(whole) && !types.is_instance(whole) && !is_interface(types, whole);
}

Use Indexer::use_by(const Expr& call, uint32_t argument) {
  const Arg& arg = tree_.args[call.list.first + argument];
  if (arg.output) return Use::kWritten;
  const PouInfo* const pou = called_by(call);
  if (pou == nullptr) return Use::kRead;
  const Objects objects(sema_, scope_);
  VarId parameter;
  if (!arg.name.empty()) {
    parameter = objects.find_parameter(*pou, arg.name.text);
  } else {
    const std::vector<VarId> parameters = positional_parameters(
        sema_.declared, objects.variables_of(*pou), pou->result, call.list.count);
    if (argument < parameters.size()) parameter = parameters[argument];
  }
  if (!parameter.valid()) return Use::kRead;
  const Variable& variable = sema_.declared.variables[parameter.index];
  if (variable.section == VarSection::kOutput) return Use::kWritten;
  const bool may_write = variable.section == VarSection::kInOut && !variable.constant;
  return may_write ? Use::kBoth : Use::kRead;
}

void Indexer::call_arguments(const Expr& call) {
  if (const Name box = tree_.name(call.number); !box.empty()) {
    add(box.span, declaration_named(sema_.namespaces.find(NameSort::kDeclaration, box)),
        Role::kRead);
  }
  const PouInfo* const pou = called_by(call);
  if (pou == nullptr) return;
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = tree_.args[call.list.first + i];
    if (arg.name.empty()) continue;
    const bool both = use_by(call, i) == Use::kBoth;
    add(arg.name.span, variable_symbol(Objects(sema_, scope_).find_parameter(*pou, arg.name.text)),
        arg.output ? Role::kRead
        : both     ? Role::kReadWritten
                   : Role::kWritten);
  }
}

}  // namespace frontend::questions
