// Phase: every name that a declaration brings into the world, nothing resolved (collection.cc,
// global_lists.cc, hidden_variables.cc). Reads the tree; writes the declarations, and heads of
// types and POUs into the program. What the library has is collected when its name is first used.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Collection : public Phase {
 public:
  using Phase::Phase;

  void collect();
  bool use_library_type(std::string_view name);
  bool use_library_literal(std::string_view name);
  uint32_t add_pou(const PouDecl& decl, bool of_library, std::string_view name);
  void add_code(PouInfo& info, std::string name);
  void collect_interface(uint32_t pou);
  void number_variables(PouInfo& info);
  bool use_library(std::string_view name);
  bool is_generic_name(std::string_view name) const;
  std::string static_list_name(const PouInfo& info) const;
  // Is it an input of type ANY that the POU has as a record? (any_inputs.cc)
  bool takes_any(const VarDecl& decl, VarSection section, const PouDecl& pou) const;
  static bool is_any_part(std::string_view name);  // pvalue, diSize, TypeClass

 private:
  // collection.cc
  void declared_twice(std::string_view name, base::SourceSpan here, base::SourceSpan other);
  void collect_types();
  void declare_type(const TypeDecl& decl, std::string_view name);
  void collect_library_type(const TypeDecl& decl);
  void forward_declare(const TypeDecl& decl, std::string_view name);
  void collect_enumerators(SpecId spec, ScopeId scope, Access access = Access::kDefault);
  // `head` has the attributes.
  void collect_globals(const VarBlock& block, std::string_view list, const VarBlock& head);
  void collect_globals(const std::vector<VarBlock>& blocks, std::string_view list);
  void collect_variables(uint32_t pou, const VarBlock& block);
  VarId shared_by_original(const PouInfo& info, const Variable& variable) const;
  void collect_pous();
  void add_aliases(PouInfo& info);
  VarId add_variable(Variable variable, NameMap<VarId>& scope, std::string_view name = {});
  // open_functions.cc
  bool is_open(const PouDecl& decl) const;
  VarId add_static(Variable variable, PouInfo& info);
  VarId add_own_static(Variable variable, PouInfo& info);
  VarId add_instance_variable(Variable variable, PouInfo& method);
  // any_inputs.cc
  bool names_any_part(const VarDecl& decl, const PouDecl& pou) const;
  // call_instances.cc
  bool holds_block(SpecId spec, uint32_t depth);
  NameMap<SpecId>& block_names();
  bool is_call_instance(const Variable& variable, const PouInfo& info);
  void add_call_instance(Variable variable, PouInfo& info);
  void add_edge(VarId input, PouInfo& info);
};

}  // namespace frontend
