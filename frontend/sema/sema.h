// Meaning of a syntax tree: names, types, constants, initial values, interfaces.
// Sema owns the program under construction and everything known about the tree;
// lowering asks it about expressions. Order of declarations never matters:
// whatever is asked for is resolved on the spot, and circles are reported.
//
// One instance serves one compilation. Every problem is reported once to the
// sink; what cannot be resolved has an invalid id and silences follow-ups.
#pragma once

#include <deque>
#include <optional>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/sema/constant.h"
#include "frontend/sema/conversion.h"
#include "frontend/sema/model.h"
#include "stdlib/registry.h"

namespace frontend {

using base::DiagnosticCode;

// What the head of a call expression means.
struct Callee {
  enum class Kind : uint8_t { kError, kFunction, kInstance, kStandard, kConversion };
  Kind kind = Kind::kError;
  uint32_t pou = kNoPou;  // kFunction; kInstance: the block's POU
  const stdlib::FunctionRow* row = nullptr;
  Conversion conversion;
};

// The operator that a standard function of rule kArithmetic, kBitwise or kCompare is.
BinaryOp standard_operator(stdlib::FunctionId id);
// How many leading arguments of a string function are strings.
uint32_t string_arguments(const stdlib::FunctionRow& row, uint32_t count);

class Sema {
 public:
  // Files below `library_file` are the project, the others the standard library.
  Sema(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
       const CompileOptions& options, base::Diagnostics& diagnostics);

  // --- declarations (declarations.cc, interface.cc, configuration.cc)
  void collect();
  void resolve_declarations();
  void configure();
  void report_unused();
  void check_output_tasks();  // after all bodies

  // --- types (types.cc, enumeration.cc, containment.cc)
  TypeUse resolve(SpecId spec);
  std::optional<TypeUse> find_type(std::string_view name);
  void check_containment();

  // --- variables and members (variables.cc)
  const Variable& resolve(VarId id);
  VarId find_variable(std::string_view name);
  // The instance type's POU; the POU's variable of that name.
  const PouInfo* pou_of(ir::TypeId instance) const;
  int32_t find_member(ir::TypeId structure, std::string_view name);
  // The global pseudo variable of a direct address.
  uint32_t direct_member(const Expr& expr);
  std::string name_suggestion(std::string_view name, bool callable) const;

  // --- expressions (infer*.cc)
  const Note& infer(ExprId expr);
  Callee callee(const Expr& call);
  // Arguments of a standard function in the order of its parameters; none when reported.
  std::vector<ExprId> standard_arguments(const Expr& call, const stdlib::FunctionRow& row);
  // Type of the operands of a binary operator that have to agree.
  Note unify(const Note& a, const Note& b, base::SourceSpan span);
  ir::TypeId type_of_direct(const ir::DirectAddress& address) const;

  // --- constants (fold*.cc, initial_values.cc)
  // nullopt when reported. `context` steers literals; may be invalid.
  std::optional<Constant> fold(ExprId expr, ir::TypeId context);
  std::optional<uint64_t> fold_bits(ExprId expr, ir::TypeId target);
  std::optional<int64_t> fold_integer(ExprId expr);
  // Bits of a constant as a value of scalar type `target`; reports what does not fit.
  std::optional<uint64_t> fit(const Constant& value, ir::TypeId target, base::SourceSpan span);
  std::optional<std::string> fit_text(const Constant& value, ir::TypeId target,
                                      base::SourceSpan span);
  // Initial value of any type; invalid when reported.
  ir::ConstId initial_value(ExprId expr, ir::TypeId type);

  // --- messages
  void error(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix = {});
  void warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix = {});
  // Reports an implicit conversion that may lose; false when the dialect forbids it.
  bool allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span);
  std::string type_text(ir::TypeId type) const { return program.types.text(type); }

  // The POU whose names are visible; set while anything of it is resolved.
  class Within {
   public:
    Within(Sema& sema, uint32_t pou) : sema_(sema), saved_(sema.current_pou_) {
      sema_.current_pou_ = pou;
    }
    ~Within() { sema_.current_pou_ = saved_; }
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

   private:
    Sema& sema_;
    uint32_t saved_;
  };

  const base::SourceMap& sources;
  const Tree& tree;
  const CompileOptions& options;
  ir::Program program;
  std::deque<PouInfo> pous;  // stable addresses; grows when library blocks are used

 private:
  friend class Within;
  friend class Folder;

  // declarations.cc
  void collect_types();
  void collect_enumerators(SpecId spec);
  void collect_globals(const std::vector<VarBlock>& blocks);
  void collect_variables(uint32_t pou, const VarBlock& block);
  void collect_pous();
  uint32_t add_pou(const PouDecl& decl, bool library);
  void number_variables(PouInfo& info);
  VarId add_variable(Variable variable, NameMap<VarId>& scope);
  bool use_library(std::string_view name);

  // interface.cc
  void resolve_interface(uint32_t pou);
  void resolve_globals();
  ir::Member member_of(const Variable& variable, ir::Section section) const;
  void check_direct_addresses();

  // variables.cc
  void resolve_variable(VarId id);
  void resolve_external(Variable& variable);
  void resolve_initial(Variable& variable);
  void check_placement(const Variable& variable);
  void check_address(const Variable& variable);

  // types.cc
  TypeUse resolve_kind(SpecId id, const Spec& spec);
  TypeUse resolve_named(const Spec& spec);
  TypeUse resolve_string(const Spec& spec);
  TypeUse resolve_array(const Spec& spec);
  TypeUse resolve_struct(SpecId id, const Spec& spec);
  TypeUse resolve_subrange(const Spec& spec);
  TypeUse resolve_enum(SpecId id, const Spec& spec);
  bool add_field(ir::Type& type, NameMap<uint32_t>& names, const VarDecl& field);

  // infer*.cc
  Note infer_kind(ExprId id, const Expr& expr);
  Note infer_literal(const Expr& expr);
  Note infer_name(const Expr& expr);
  Note infer_enum_name(const Expr& expr);
  Note infer_qualified(const Expr& expr);
  Note infer_member(const Expr& expr);
  Note infer_bit(const Expr& expr);
  Note infer_index(const Expr& expr);
  Note infer_unary(const Expr& expr);
  Note infer_binary(const Expr& expr);
  ir::TypeId infer_name_candidates(std::string_view name);
  Note infer_call(const Expr& expr);
  Note infer_standard(const Expr& expr, const stdlib::FunctionRow& row);
  Note infer_rule(const Expr& expr, const stdlib::FunctionRow& row,
                  const std::vector<ExprId>& args);
  Note infer_string_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row);
  Note infer_conversion(const Expr& expr, const Conversion& conversion);
  void check_real_equality(const Expr& expr);
  Note infer_arithmetic(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  Note infer_time_arithmetic(BinaryOp op, const Note& left, const Note& right,
                             base::SourceSpan span);
  Note infer_bitwise(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  Note infer_comparison(BinaryOp op, const Note& left, const Note& right, base::SourceSpan span);
  Note unify_arguments(const std::vector<ExprId>& args, uint32_t first);
  Callee named_callee(const Expr& head);
  void check_index_list(const Expr& expr, const ir::Type& array);

  // initial_values.cc
  ir::ConstId array_value(const Expr& expr, ir::TypeId type);
  ir::ConstId struct_value(const Expr& expr, ir::TypeId type);
  bool array_item(ExprId id, uint64_t& rounds, std::vector<ExprId>& values);
  bool array_elements(const Expr& list, ir::TypeId type, uint64_t total,
                      std::vector<ir::ConstElement>& out, uint64_t& at);

  // output_tasks.cc
  void check_instance_outputs(const ir::ProgramInstance& instance,
                              std::unordered_map<uint32_t, uint32_t>& owner);

  // configuration.cc
  void default_configuration();
  void configure_resource(const ResourceDecl& resource);
  void add_task(const TaskDecl& decl);
  void add_instance(const ProgramDecl& decl);
  ir::ConstId program_arguments(const ProgramDecl& decl, const PouInfo& info);

  base::Diagnostics& diagnostics_;
  uint32_t library_file_;
  uint32_t current_pou_ = kNoPou;
  uint32_t depth_ = 0;
  std::deque<Variable> variables_;  // stable addresses, as pous
  std::vector<SpecInfo> specs_;
  std::vector<Note> notes_;
  NameMap<VarId> globals_;
  std::vector<VarId> global_order_;
  NameMap<SpecId> types_;
  NameMap<uint32_t> pou_names_;
  NameMap<const PouDecl*> library_;
  NameMap<std::vector<EnumRef>> literals_;
  NameMap<const stdlib::FunctionRow*> standard_;
  std::unordered_map<ir::TypeId, uint32_t> pou_by_type_;
  std::unordered_map<std::string, uint32_t> direct_members_;
  std::unordered_map<ir::TypeId, NameMap<uint32_t>> structures_;
};

}  // namespace frontend
