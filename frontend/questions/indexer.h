// Makes the index: walks all sources and looks up what each name means, with what the compilation
// has found out about expressions. It looks only: nothing is resolved that was not before, nothing
// is marked, no message is given.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>

#include "frontend/questions/symbols.h"
#include "frontend/questions/walk.h"
#include "frontend/sema/sema.h"

namespace frontend::questions {

class Indexer : private Walker {
 public:
  explicit Indexer(Sema& sema) : Walker(sema.tree), sema_(sema) {}
  Index run();

 private:
  // --- declarations (index_declarations.cc)
  void find_specs();
  void pou(const PouDecl& decl);
  void blocks(const std::vector<VarBlock>& blocks);
  void block(const VarBlock& block);
  void variable(const VarDecl& decl, const Name& name, VarSection section);
  void initial(ExprId init, ir::TypeId type);
  void steps(const Chart& chart);
  void configuration(const ConfigDecl& config);
  Symbol plain_declaration(SymbolKind kind, const Name& name);
  void visit(const Spec& spec, SpecId id) override;
  VarId declared(const Name& name) const;

  // --- code (index_code.cc)
  void visit(const Expr& expr, ExprId id, Use use) override;
  bool is_part(const Expr& expr) override;
  Use use_by(const Expr& call, uint32_t argument) override;
  std::optional<Symbol> address(const Expr& expr);
  std::optional<Symbol> plain_name(const Expr& expr, const Note& note);
  std::optional<Symbol> member(const Expr& expr, const Note& note);
  std::optional<Symbol> in_block(uint32_t block, const Name& name);
  std::optional<Symbol> declaration_named(std::string_view name);
  void call_arguments(const Expr& call);
  const PouInfo* callee(const Expr& head);
  const PouInfo* called_by(const Expr& call);
  uint32_t block_before_dot(ExprId operand);
  const Note& known(ExprId id) { return sema_.facts.of(scope_, id); }

  // --- symbols (symbols.cc)
  ir::DirectAddress address_of(const Variable& variable) const;
  std::optional<Symbol> variable_symbol(VarId id) const;
  Symbol pou_symbol(const PouInfo& info) const;
  const Name* member_named(ir::TypeId type, std::string_view name) const;
  std::optional<Symbol> field_symbol(ir::TypeId structure, const Name& name) const;
  std::optional<Symbol> enumerator_symbol(ir::TypeId type, std::string_view name) const;
  std::optional<Symbol> type_symbol(std::string_view name) const;
  std::string qualified(const PouInfo& info) const;
  void add(base::SourceSpan span, const std::optional<Symbol>& symbol, Role role);
  uint32_t number_of(const Symbol& symbol);

  Sema& sema_;
  PouScope scope_;  // of what is walked
  Index out_;
  // By place, or by built-in row, or by address.
  std::map<std::tuple<uint32_t, const void*, std::string>, uint32_t> numbers_;
  std::unordered_map<ir::TypeId, SpecId> specs_;           // of structures, unions and enumerations
  std::unordered_map<ir::TypeId, NameMap<Name>> members_;  // likewise: fields and enumerators
  std::unordered_map<uint32_t, VarId> variables_;          // by the place of their name
  std::unordered_map<const PouDecl*, const PouInfo*> infos_;
};

}  // namespace frontend::questions
