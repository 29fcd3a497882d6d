// Phase: which variable a name or address means, and its type, place and initial value
// (variables.cc, located.cc, called_programs.cc, hidden_variables.cc). Reads declarations; writes
// what they become, and hidden globals of the program.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Variables : public Phase {
 public:
  using Phase::Phase;

  // Phase::resolve() asks it.
  const Variable& resolve_now(VarId id);
  void check_binding(const VarDecl& decl, ir::TypeId type);
  uint32_t address_bits(ir::TypeId type) const;  // located.cc
  std::string address_problem(ir::TypeId type, const ir::DirectAddress& address, bool open);
  bool check_field_address(const VarDecl& field, ir::TypeId type);
  // Is a part of such a structure or array at %I*? Then code cannot assign the whole.
  bool holds_input(ir::TypeId type) const;
  ir::TypeId type_of_direct(const ir::DirectAddress& address) const;
  // The global pseudo variable of a direct address.
  uint32_t direct_member(const Expr& expr);
  VarId find_variable(const Name& name);
  VarId find_variable(const Expr& name);  // `.name` means a global
  // called_programs.cc
  VarId program_variable(std::string_view name, bool called);
  void place_global(VarId id);
  Fix name_suggestion(std::string_view name, bool callable, bool instruction = false) const;

 private:
  // variables.cc
  void resolve_variable(VarId id);
  void resolve_external(Variable& variable);
  void resolve_initial(Variable& variable);
  void check_placement(const Variable& variable);
  void check_address(const Variable& variable);
  void check_edge(const Variable& variable);
  // open_arrays.cc
  bool is_open_array(const Variable& variable) const;
  ir::TypeId open_array_type(const Spec& spec);
};

}  // namespace frontend
