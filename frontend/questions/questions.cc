#include "frontend/questions/questions.h"

#include "frontend/parse/section_word.h"
#include "frontend/questions/walk.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"

namespace frontend::questions {
namespace {

std::string_view head_word(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::kFunction:
      return "FUNCTION ";
    case SymbolKind::kFunctionBlock:
      return "FUNCTION_BLOCK ";
    case SymbolKind::kProgram:
      return "PROGRAM ";
    case SymbolKind::kClass:
      return "CLASS ";
    case SymbolKind::kInterface:
      return "INTERFACE ";
    case SymbolKind::kMethod:
      return "METHOD ";
    case SymbolKind::kAction:
      return "ACTION ";
    case SymbolKind::kProperty:
      return "PROPERTY ";
    case SymbolKind::kType:
      return "TYPE ";
    case SymbolKind::kTransition:
      return "TRANSITION ";
    case SymbolKind::kTask:
      return "TASK ";
    case SymbolKind::kInstance:
      return "PROGRAM ";
    default:
      return "";
  }
}

// Looks for the innermost expression at a place, in the code around it.
class Finder : private Walker {
 public:
  Finder(Sema& sema, base::SourcePos pos) : Walker(sema.tree), sema_(sema), pos_(pos) {}

  void run() {
    for (const PouInfo& info : sema_.declared.pous) {
      if (info.library || info.open || info.made != MadeCode::kNone) continue;
      if (!holds(info.decl->span)) continue;
      scope_ = PouScope(info);
      for (const VarBlock& block : info.decl->blocks) declarations(block);
      statements(info.decl->body);
      if (info.decl->chart != kNoChart) chart(tree_.charts[info.decl->chart]);
    }
    scope_ = {};
    for (const VarBlock& block : tree_.globals) declarations(block);
  }

  std::optional<TypedExpression> typed;  // with a type
  base::SourcePos called;                // of the name of what is called

 private:
  bool holds(base::SourceSpan span) const {
    return span.begin.valid() && !(pos_ < sema_.sources.current(span.begin)) &&
           !(sema_.sources.current(span.end) < pos_);
  }
  void declarations(const VarBlock& block) {
    for (const VarDecl& decl : block.vars) {
      if (!decl.implied) expression(decl.init);
    }
  }
  void visit(const Expr& expr, ExprId id, Use) override {
    if (!holds(expr.span)) return;
    if (expr.kind == ExprKind::kCall) called = name_in(tree_[expr.operand]);
    const Note& note = sema_.facts.of(scope_, id);
    if (!note.type.valid()) return;
    const base::SourceSpan now{sema_.sources.current(expr.span.begin),
                               sema_.sources.current(expr.span.end)};
    typed = TypedExpression{now, sema_.report.type_text(note.type)};
  }
  base::SourcePos name_in(const Expr& head) const {
    const base::SourcePos begin = head.name.empty() ? head.span.begin : head.name.span.begin;
    return sema_.sources.current(begin);
  }

  Sema& sema_;
  base::SourcePos pos_;
  PouScope scope_;
};

}  // namespace

base::SourcePos Questions::place(std::string_view name, uint32_t line, uint32_t column) const {
  const base::SourceMap& sources = sema_.sources;
  for (uint32_t file = sources.file_count(); file-- > 0;) {  // the last text of an edited file
    if (sources.file_name(file) != name) continue;
    const std::string_view text = sources.text(file);
    size_t begin = 0;
    for (uint32_t at = 1; at < line; ++at) {
      begin = text.find('\n', begin);
      if (begin == std::string_view::npos) return {};
      ++begin;
    }
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (line == 0 || column == 0 || column - 1 > end - begin) return {};
    return {sources.begin(file).offset + static_cast<uint32_t>(begin) + column - 1};
  }
  return {};
}

base::SourceLocation Questions::locate(base::SourcePos pos) const {
  return sema_.sources.locate(pos);
}

const Index& Questions::index() {
  if (!index_) index_ = questions::index(sema_);
  return *index_;
}

const Symbol* Questions::symbol_at(base::SourcePos pos) {
  const Occurrence* found = pos.valid() ? index().at(pos) : nullptr;
  return found == nullptr ? nullptr : &index_->symbols[found->symbol];
}

const Symbol* Questions::symbol_named(std::string_view name) {
  for (const Symbol& symbol : index().symbols) {
    if (ir::same_name(symbol.name, name)) return &symbol;
  }
  return nullptr;
}

std::vector<const Symbol*> Questions::symbols_at(const ir::DirectAddress& address) {
  std::vector<const Symbol*> out;
  const uint64_t end = uint64_t{address.bit_offset} + address.bit_size;
  for (const Symbol& symbol : index().symbols) {
    const uint64_t begin = symbol.address.bit_offset;
    const bool shares = symbol.address.area == address.area && begin < end &&
                        address.bit_offset < begin + symbol.address.bit_size;
    if (shares) out.push_back(&symbol);
  }
  return out;
}

std::vector<Occurrence> Questions::uses_of(const Symbol& symbol) {
  const Index& all = index();
  const auto number = static_cast<size_t>(&symbol - all.symbols.data());
  std::vector<Occurrence> out;
  if (number >= all.uses.size()) return out;
  for (const uint32_t use : all.uses[number]) out.push_back(all.occurrences[use]);
  return out;
}

std::optional<TypedExpression> Questions::type_at(base::SourcePos pos) {
  Finder finder(sema_, pos);
  finder.run();
  return finder.typed;
}

const Symbol* Questions::called_at(base::SourcePos pos) {
  Finder finder(sema_, pos);
  finder.run();
  return symbol_at(finder.called);
}

std::string Questions::documentation_of(const Symbol& symbol) {
  if (symbol.row != nullptr) return std::string(symbol.row->meaning);
  const uint32_t file = sema_.sources.file_of(symbol.defined.begin);
  if (file == sema_.sources.file_count()) return {};
  const bool below = symbol.pou != kNoPou;
  const Documentation& all = documented_.try_emplace(file, sema_.sources.text(file)).first->second;
  return all.at(symbol.defined.begin.offset - sema_.sources.begin(file).offset, below);
}

void Questions::describe_call(const PouInfo& info, Signature& out) const {
  const auto& variables = sema_.declared.variables;
  std::string inside;
  for (const VarId id : Objects(sema_).variables_of(info)) {
    const Variable& variable = variables[id.index];
    if (!is_parameter(variable.section) || id == info.result || variable.hidden) continue;
    if (variable.decl == nullptr) continue;
    Parameter parameter{std::string(variable.name.text), sema_.report.type_text(variable.type),
                        section_word(variable.section)};
    inside += inside.empty() ? "" : ", ";
    if (variable.section != VarSection::kInput) inside += std::string(parameter.section) + ' ';
    inside += parameter.name + " : " + parameter.type;
    out.parameters.push_back(std::move(parameter));
  }
  const bool called = info.decl->kind != PouKind::kInterface &&
                      info.decl->kind != PouKind::kGetter && info.decl->kind != PouKind::kSetter;
  if (called) out.text += '(' + inside + ')';
  if (info.result.valid() && variables[info.result.index].type.valid()) {
    out.text += " : " + sema_.report.type_text(variables[info.result.index].type);
  }
}

Signature Questions::signature_of(const Symbol& symbol) {
  Signature out;
  out.documentation = documentation_of(symbol);
  if (symbol.row != nullptr) {
    out.text = symbol.name + '(' + std::string(symbol.row->parameters) + ") " +
               std::string(symbol.row->signature);
    return out;
  }
  if (symbol.kind == SymbolKind::kVariable) {
    const Variable& variable = sema_.declared.variables[symbol.variable.index];
    out.text =
        std::string(section_word(variable.section)) + (variable.constant ? " CONSTANT " : " ");
  }
  out.text += std::string(head_word(symbol.kind)) + symbol.name;
  if (symbol.kind == SymbolKind::kVariable && symbol.address.area != ir::DirectArea::kNone) {
    const Variable& variable = sema_.declared.variables[symbol.variable.index];
    out.text += " AT " + ir::address_text(variable.decl->address);
  }
  if (symbol.pou != kNoPou) {
    describe_call(sema_.declared.pous[symbol.pou], out);
  } else if (symbol.type.valid() && symbol.kind != SymbolKind::kType) {
    out.text += " : " + sema_.report.type_text(symbol.type);
  }
  return out;
}

}  // namespace frontend::questions
