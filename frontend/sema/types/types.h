// Phase: what type expressions mean (types.cc, structures.cc, containment.cc). Reads the tree and
// the declarations; writes types and default values into the program, and Sema::facts.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

inline constexpr std::string_view kPackMode = "pack_mode";  // an attribute
// ir::Type::capacity of a structure with these attributes. 0: it is not packed, or the value is no
// pack mode.
uint32_t packing_of(const Tree& tree, Range32 attributes);

class Types : public Phase {
 public:
  using Phase::Phase;

  // --- types (types.cc, structures.cc, containment.cc)
  TypeUse resolve_type(SpecId spec);
  std::optional<TypeUse> find_type(std::string_view qualified);
  void check_containment();

 private:
  struct StructBuild;
  // types.cc
  TypeUse resolve_kind(SpecId id, const Spec& spec);
  TypeUse resolve_named(const Spec& spec);
  TypeUse resolve_string(const Spec& spec);
  TypeUse resolve_array(const Spec& spec);
  TypeUse resolve_struct(SpecId id, const Spec& spec);
  TypeUse resolve_subrange(const Spec& spec);
  TypeUse resolve_enum(SpecId id, const Spec& spec);
  void know_own_literal(ExprId default_value, ir::TypeId type);
  TypeUse resolve_reference(const Spec& spec);
  bool check_overlap(const ir::Type& type, base::SourceSpan span);
  bool add_base(StructBuild& build, const Spec& spec);
  bool is_bit(SpecId spec) const;
  bool add_field(StructBuild& build, const VarDecl& field);
  StructureField add_bit(StructBuild& build, const Name& name, ir::ConstId init, std::string rule);
  void close_bits(StructBuild& build);
};

}  // namespace frontend
