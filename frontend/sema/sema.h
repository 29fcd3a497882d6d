// Meaning of a syntax tree: names, types, constants, initial values, interfaces.
// Sema owns the program under construction and everything known about the tree;
// lowering asks it about expressions. Order of declarations never matters:
// whatever is asked for is resolved on the spot, and circles are reported.
//
// One instance serves one compilation. Every problem is reported once to the
// sink; what cannot be resolved has an invalid id and silences follow-ups.
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/sema/callee.h"
#include "frontend/sema/constant.h"
#include "frontend/sema/declarations.h"
#include "frontend/sema/facts.h"
#include "frontend/sema/namespaces.h"
#include "frontend/sema/objects.h"
#include "frontend/sema/pools.h"
#include "frontend/sema/reporter.h"
#include "frontend/sema/start_values.h"
#include "ir/types/layout.h"

namespace frontend {

enum class Purpose : uint8_t { kRun, kTest };

// Store: a build for tests.
struct Tests {
  std::vector<TestCase> cases;
  uint32_t message = 0;  // member of the globals that takes the message of a failed assertion
  std::vector<MockBody> mock_bodies;
};

class Sema {
 public:
  // Files from `library_file` on are the standard library, the others the project; and so are those
  // that come later.
  Sema(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
       const CompileOptions& options, Purpose purpose, base::Diagnostics& diagnostics);

  // --- declarations (collection.cc, interface.cc, configuration.cc)
  void report_not_supported();  // not_supported.cc
  void resolve_declarations();
  void finish_programs();  // after all bodies
  void mark_used(VarId id);
  void mark_written(VarId id);
  bool for_tests() const { return purpose == Purpose::kTest; }
  bool in_test() const { return scope_.pou != nullptr && scope_.pou->test; }

  // --- types (types.cc, structures.cc, containment.cc)
  TypeUse resolve_type(SpecId spec);
  std::optional<TypeUse> find_type(std::string_view qualified);
  void check_containment();

  // --- variables and members (variables.cc)
  const Variable& resolve(VarId id) {
    const Variable& variable = declared.variables[id.index];
    return variable.progress == Progress::kDone ? variable : resolve_now(id);
  }
  VarId find_variable(const Name& name);
  VarId find_variable(const Expr& name);  // `.name` means a global
  // The global pseudo variable of a direct address.
  uint32_t direct_member(const Expr& expr);
  Fix name_suggestion(std::string_view name, bool callable, bool instruction = false) const;

  // --- expressions (infer*.cc)
  const Note& infer(ExprId expr) {
    Note& known = facts.of(scope_, expr);
    return known.progress == Progress::kDone ? known : infer_now(expr, known);
  }
  ir::TypeId type_of_direct(const ir::DirectAddress& address) const;
  // Is a part of such a structure or array at %I*? Then code cannot assign the whole.
  bool holds_input(ir::TypeId type) const;

  // Has the value that an instruction list keeps the type of its result? (infer_result.cc)
  bool check_result(const Stmt& assignment);

  // --- messages, from the scope that is looked at
  void error(DiagnosticCode code, base::SourceSpan span, std::string text, Fix fix = {}) {
    report.error(scope_, code, span, std::move(text), std::move(fix));
  }
  void warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix = {}) {
    report.warning(code, span, std::move(text), std::move(fix));
  }
  bool allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
    return report.allow_narrowing(scope_, from, to, span);
  }
  void allow_extension(std::string_view what, base::SourceSpan span, std::string fix = {}) {
    report.allow_extension(scope_, what, span, std::move(fix));
  }

  // A phase, for the scope that is looked at.
  template <class Wanted>
  Wanted ask() {
    return Wanted(*this, scope_);
  }

  // The POU whose names are visible; set while anything of it is resolved.
  class Within {
   public:
    Within(Sema& sema, uint32_t pou);
    ~Within();
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

   private:
    Sema& sema_;
    PouScope saved_;
  };

  const base::SourceMap& sources;
  const Tree& tree;
  const CompileOptions& options;
  const Purpose purpose;
  ir::Program program;
  // Stores, which report nothing.
  Declarations declared;
  Library library;
  Facts facts;
  Addresses addresses;
  Tests tests;
  Reporter report;
  BodyLog* log = nullptr;  // of the body that is lowered, where somebody keeps one
  Objects objects{*this};
  StartValues start_values{*this};
  Namespaces namespaces{*this};
  Pools pools{*this};

  using ParameterTypes = std::vector<ir::TypeId>;  // by number in PouInfo::variables

  // interface.cc
  void resolve_interface(uint32_t pou);
  void resolve_globals();
  ir::Member member_of(const Variable& variable, ir::Section section);

  // variables.cc
  const Variable& resolve_now(VarId id);
  void resolve_variable(VarId id);
  void resolve_external(Variable& variable);
  void resolve_initial(Variable& variable);
  void check_binding(const VarDecl& decl, ir::TypeId type);
  void check_placement(const Variable& variable);
  void check_address(const Variable& variable);
  uint32_t address_bits(ir::TypeId type) const;  // located.cc
  std::string address_problem(ir::TypeId type, const ir::DirectAddress& address, bool open);
  bool check_field_address(const VarDecl& field, ir::TypeId type);
  bool holds_instance(ir::TypeId type) const;

  // types.cc
  TypeUse resolve_kind(SpecId id, const Spec& spec);
  TypeUse resolve_named(const Spec& spec);
  TypeUse resolve_string(const Spec& spec);
  TypeUse resolve_array(const Spec& spec);
  TypeUse resolve_struct(SpecId id, const Spec& spec);
  TypeUse resolve_subrange(const Spec& spec);
  TypeUse resolve_enum(SpecId id, const Spec& spec);
  TypeUse resolve_reference(const Spec& spec);
  bool check_overlap(const ir::Type& type, base::SourceSpan span);

  // infer_reference.cc
  Note infer_deref(const Expr& expr);
  Note infer_pointer_index(const Expr& expr, const Note& operand);

  // structures.cc
  struct StructBuild;
  bool add_base(StructBuild& build, const Spec& spec);
  bool is_bit(SpecId spec) const;
  bool add_field(StructBuild& build, const VarDecl& field);
  StructureField add_bit(StructBuild& build, const Name& name, ir::ConstId init, std::string rule);
  void close_bits(StructBuild& build);

  void place_global(VarId id);
  void check_edge(const Variable& variable);

  // infer*.cc
  const Note& infer_now(ExprId id, Note& note);
  Note infer_kind(ExprId id, const Expr& expr);
  Note infer_literal(const Expr& expr);
  Note infer_name(const Expr& expr);
  Note variable_note(VarId id);
  std::optional<Note> infer_list_member(const Expr& expr);
  Note infer_enum_name(const Expr& expr);
  Note infer_qualified(const Expr& expr);
  Note infer_literal_of(std::string_view type, base::SourceSpan span, const Name& wanted);
  Note infer_member(const Expr& expr);
  Note infer_bit(const Expr& expr);
  bool check_part(ir::TypeId whole, uint32_t number, uint8_t size, base::SourceSpan span);
  Note part_note(const Note& whole, uint32_t number, uint8_t size) const;
  std::string_view enumeration_named(const Expr& head);
  std::optional<Note> infer_named_bit(const Expr& expr, const Note& operand);
  Note infer_index(const Expr& expr);
  Note infer_assign(const Expr& expr);
  Note infer_result(const Expr& expr);
  Note infer_unary(const Expr& expr);
  Note infer_character(const Expr& expr, Note note);
  void check_index_list(const Expr& expr, const ir::Type& array);

  // called_programs.cc
  VarId program_variable(std::string_view name, bool called);

  PouScope scope_;  // whose names are visible
};

}  // namespace frontend
