#include "frontend/questions/symbols.h"

#include <algorithm>

#include "frontend/questions/indexer.h"

namespace frontend::questions {
namespace {

SymbolKind kind_of(PouKind kind) {
  switch (kind) {
    case PouKind::kFunction:
    case PouKind::kMockFunction:
      return SymbolKind::kFunction;
    case PouKind::kFunctionBlock:
      return SymbolKind::kFunctionBlock;
    case PouKind::kClass:
      return SymbolKind::kClass;
    case PouKind::kInterface:
      return SymbolKind::kInterface;
    case PouKind::kMethod:
      return SymbolKind::kMethod;
    case PouKind::kAction:
      return SymbolKind::kAction;
    case PouKind::kGetter:
    case PouKind::kSetter:
      return SymbolKind::kProperty;
    default:
      return SymbolKind::kProgram;
  }
}

}  // namespace

std::string_view word_of(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::kVariable:
      return "variable";
    case SymbolKind::kField:
      return "field";
    case SymbolKind::kEnumerator:
      return "enumerator";
    case SymbolKind::kType:
      return "type";
    case SymbolKind::kFunction:
      return "function";
    case SymbolKind::kFunctionBlock:
      return "functionBlock";
    case SymbolKind::kProgram:
      return "program";
    case SymbolKind::kClass:
      return "class";
    case SymbolKind::kInterface:
      return "interface";
    case SymbolKind::kMethod:
      return "method";
    case SymbolKind::kAction:
      return "action";
    case SymbolKind::kProperty:
      return "property";
    case SymbolKind::kTransition:
      return "transition";
    case SymbolKind::kTask:
      return "task";
    case SymbolKind::kInstance:
      return "instance";
    case SymbolKind::kStandardFunction:
      return "standardFunction";
    case SymbolKind::kAddress:
      return "address";
  }
  return "";
}

const Occurrence* Index::at(base::SourcePos pos) const {
  auto after = std::upper_bound(
      occurrences.begin(), occurrences.end(), pos,
      [](base::SourcePos wanted, const Occurrence& one) { return wanted < one.span.begin; });
  if (after == occurrences.begin()) return nullptr;
  --after;
  return after->span.end < pos ? nullptr : &*after;
}

std::string Indexer::qualified(const PouInfo& info) const {
  const std::string name(info.name);
  return info.owner == kNoPou ? name : qualified(sema_.declared.pous[info.owner]) + '.' + name;
}

// AT %QB0, with the size of all elements; none: it has none, or one that is given elsewhere.
ir::DirectAddress Indexer::address_of(const Variable& variable) const {
  const VarDecl* const decl = variable.decl;
  const bool located = decl != nullptr && decl->has_address && !decl->incomplete &&
                       decl->levels.count == 0 && decl->address.bit_offset != ir::kOpenAddress;
  if (!located || !variable.type.valid()) return {};
  ir::DirectAddress out = decl->address;
  const ir::TypeTable& types = sema_.program.types;
  const ir::Type& type = types[variable.type];
  if (type.kind != ir::Kind::kArray || !types.is_scalar(type.base)) return out;
  // The elements of an array of BOOL have a bit each behind %X.
  uint64_t bits = out.bit_size == 1 ? 1 : 8 * ir::scalar_size(types.scalar(type.base));
  for (const ir::Dimension& dim : type.dims) bits *= dim.count();
  out.bit_size = static_cast<uint32_t>(std::min<uint64_t>(bits, 0xffffffff));
  return out;
}

std::optional<Symbol> Indexer::variable_symbol(VarId id) const {
  if (!id.valid()) return std::nullopt;
  const Variable* variable = &sema_.declared.variables[id.index];
  if (variable->external.valid()) {
    id = variable->external;
    variable = &sema_.declared.variables[id.index];
  }
  if (variable->decl == nullptr && variable->pou != kNoPou) {  // a result has its POU's name
    return pou_symbol(sema_.declared.pous[variable->pou]);
  }
  Symbol symbol;
  symbol.kind = SymbolKind::kVariable;
  symbol.variable = id;
  symbol.type = variable->type;
  symbol.defined = variable->name.span;
  symbol.name = std::string(variable->name.text);
  symbol.address = address_of(*variable);
  if (variable->pou != kNoPou) {
    symbol.name = qualified(sema_.declared.pous[variable->pou]) + '.' + symbol.name;
  } else if (!variable->list.empty()) {
    symbol.name = std::string(variable->list) + '.' + symbol.name;
  }
  return symbol;
}

Symbol Indexer::pou_symbol(const PouInfo& info) const {
  Symbol symbol;
  symbol.kind = kind_of(info.decl->kind);
  symbol.name = qualified(info);
  symbol.defined = info.decl->name.span;
  symbol.pou = info.number;
  if (info.owner == kNoPou) symbol.type = info.self;
  return symbol;
}

const Name* Indexer::member_named(ir::TypeId type, std::string_view name) const {
  const auto members = members_.find(type);
  if (members == members_.end()) return nullptr;
  const auto found = members->second.find(name);
  return found == members->second.end() ? nullptr : &found->second;
}

std::optional<Symbol> Indexer::field_symbol(ir::TypeId structure, const Name& name) const {
  if (const Name* const own = member_named(structure, name.text)) {
    Symbol symbol;
    symbol.kind = SymbolKind::kField;
    symbol.name = sema_.report.type_text(structure) + '.' + std::string(own->text);
    symbol.defined = own->span;
    const StructureField* place = sema_.declared.find_field(structure, own->text);
    if (place != nullptr && place->bit < 0) {
      symbol.type = sema_.program.types[structure].members[place->member].type;
    }
    return symbol;
  }
  const auto found = specs_.find(structure);
  if (found == specs_.end()) return std::nullopt;
  const Spec& spec = tree_[found->second];
  if (spec.kind != SpecKind::kStruct || !spec.element.valid()) return std::nullopt;
  return field_symbol(sema_.facts.specs[spec.element.index].use.type, name);  // of its base
}

std::optional<Symbol> Indexer::enumerator_symbol(ir::TypeId type, std::string_view name) const {
  const Name* const own = member_named(type, name);
  if (own == nullptr) return std::nullopt;
  Symbol symbol;
  symbol.kind = SymbolKind::kEnumerator;
  symbol.name = sema_.report.type_text(type) + '#' + std::string(own->text);
  symbol.defined = own->span;
  symbol.type = type;
  return symbol;
}

std::optional<Symbol> Indexer::type_symbol(std::string_view name) const {
  const auto found = sema_.declared.types.find(name);
  if (found == sema_.declared.types.end()) return std::nullopt;
  const SpecInfo& info = sema_.facts.specs[found->second.index];
  Symbol symbol;
  symbol.kind = SymbolKind::kType;
  symbol.name = std::string(info.name.text);
  symbol.defined = info.name.span;
  symbol.type = info.use.type;
  return symbol;
}

uint32_t Indexer::number_of(const Symbol& symbol) {
  const auto next = static_cast<uint32_t>(out_.symbols.size());
  const void* row = symbol.defined.begin.valid() ? nullptr : symbol.row;
  const bool bare = symbol.kind == SymbolKind::kAddress;
  const auto [found, added] =
      numbers_.try_emplace({symbol.defined.begin.offset, row, bare ? symbol.name : ""}, next);
  if (added) {
    Symbol& own = out_.symbols.emplace_back(symbol);
    own.library = sema_.library.holds(symbol.defined);
    own.defined = {sema_.sources.current(symbol.defined.begin),
                   sema_.sources.current(symbol.defined.end)};
  }
  return found->second;
}

void Indexer::add(base::SourceSpan span, const std::optional<Symbol>& symbol, Role role) {
  if (!symbol || !span.begin.valid()) return;
  const base::SourceSpan now{sema_.sources.current(span.begin), sema_.sources.current(span.end)};
  out_.occurrences.push_back({now, number_of(*symbol), role});
}

Index index(Sema& sema) {
  const Reporter::Silence silence(sema.report);
  return Indexer(sema).run();
}

}  // namespace frontend::questions
