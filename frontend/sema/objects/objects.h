// What blocks, programs and interfaces have besides variables: methods, actions and
// properties; their bases and interfaces; who may use what. Code of a member is a POU of
// its own in Declarations::pous (PouInfo::owner leads back). docs/adr/0006-objects.md.
//
// Phase, called in this order: collect() with each block, inherit() when
// all names are known, check() when all interfaces are resolved; the questions at any time
// after inherit().
#pragma once

#include "base/diagnostics.h"
#include "frontend/sema/callee.h"
#include "frontend/sema/phase.h"

namespace frontend {

inline constexpr std::string_view kFbInit = "FB_Init";
inline constexpr std::string_view kFbExit = "FB_Exit";
inline constexpr std::string_view kFbReinit = "FB_Reinit";
// Attributes.
inline constexpr std::string_view kCallAfterInit = "call_after_init";
inline constexpr std::string_view kInitializeOnCall = "initialize_on_call";
using base::DiagnosticCode;

// Methods that the code calls for an instance that a handle leads to, and not for THIS; sorted.
std::vector<ir::PouId> called_for_others(const ir::Pou& code);

class Objects : public Phase {
 public:
  using Phase::Phase;

  // --- declarations (objects.cc, inheritance.cc, overriding.cc)
  void collect(uint32_t block);
  void inherit();
  void check();
  // Reports an instance of an ABSTRACT block, alone or in an array.
  void check_instance(ir::TypeId type, base::SourceSpan span);

  // --- names (objects.cc)
  // A variable of the block or of its bases that code outside of its body can see.
  VarId find_variable(uint32_t block, std::string_view name) const;
  // Looks in what is called: a POU with a frame has its own parameters only.
  VarId find_parameter(const PouInfo& callee, std::string_view name) const;
  // In order of declaration, those of bases first.
  std::vector<VarId> variables_of(const PouInfo& pou) const;
  // Invalid for what no source declares.
  VarId member_variable(const PouInfo& block, uint32_t member) const;
  struct Found {
    uint32_t owner = kNoPou;  // kNoPou: there is none
    MemberCode code;
  };
  // A method, action or property of the block, its bases, or the interface and its parents.
  Found find_code(uint32_t block, std::string_view name) const;
  // Is `pou` the same as, or derived from, `base`?
  bool extends(uint32_t pou, uint32_t base) const;
  bool is_drawn(const Name& name) const;
  std::string ways_out(const PouInfo& block) const;
  std::string suggestion(uint32_t block, std::string_view name) const;

  // --- expressions (receivers.cc)
  // THIS, THIS^, SUPER, SUPER^: the own instance.
  bool is_own(const Expr& expr) const;
  // Would a write to it, or a call of it, change what others only read? Reports.
  bool refuse_change(ExprId id);
  bool is_super(const Expr& expr) const;
  // The block or interface that the members after `operand.` are of; kNoPou: it has no such,
  // or none that could be found out (then a message was given).
  uint32_t receiver(ExprId operand);
  // The base of the own block; reports when there is none.
  uint32_t super(base::SourceSpan span);
  // May the code that is looked at use this? Reports when not.
  bool check_access(Access access, uint32_t owner, const Name& name);
  bool check_access(const PouInfo& method, const Name& name);
  Note infer_this(const Expr& expr);

  // --- what names mean (member_names.cc)
  // Is `expr`, without `()`, a method or action? Quiet for plain names.
  bool names_method(const Expr& expr);
  // Was a message given for it?
  bool damaged(ExprId expr);
  // The method or action of that name; nullopt: there is none. Reports when it may not be used.
  std::optional<Callee> method_of(uint32_t owner, const Name& name);
  Callee base_body(const Expr& head);  // SUPER^()
  Callee itself(const Expr& head);     // a function or method inside of itself
  Note infer_member(const Expr& expr, uint32_t owner, Note note);
  Note infer_property(const Name& name, const Found& found);
  // Do GET and SET of a property say who may use them, each for itself?
  bool has_own_access(const MemberCode& code) const;
  // What an accessor gives, or is given: it has the property's name. Invalid: it has no type.
  VarId value_of(const PouInfo& accessor) const;

  // --- FB_Init, FB_Exit, FB_Reinit (start.cc)
  // After configure(): adds the code that runs once.
  void add_start();
  // Does a variable of this type, with this initial value, need anything at the start?
  bool starts(ir::TypeId type, ir::ConstId init);
  // How its author wrote the type: after names of types, as long as they have no arguments.
  const Spec* construction(SpecId spec) const;
  // Are there instances in it that start code visits?
  bool constructs(ir::TypeId type);
  VarId add_hidden_global(std::string_view name, ir::TypeId type, base::SourceSpan span);
  // Returns the method's number in Declarations::pous.
  uint32_t add_made_method(uint32_t block, std::string_view name, MadeCode code);
  // What the stamp of an instance becomes: another number for another layout.
  uint32_t stamp_of(const PouInfo& block) const;
  // With CODESYS and TwinCAT, FB_Init and FB_Exit of a block do not replace those of its bases:
  // all of them run.
  bool runs_bases(std::string_view name) const;
  // What is called after FB_Init and after the values that a declaration gives: methods with
  // 'call_after_init' of blocks with 'call_after_init', those of bases first. An override stands
  // for all that it overrides. Numbers in Declarations::pous.
  std::vector<uint32_t> called_after_init(const PouInfo& block) const;

  // --- calls (recursion.cc)
  // How deep the POU may call itself, by its attribute; 0: not declared.
  uint32_t recursion_depth(const PouDecl& decl);
  void check_recursion();  // after all bodies; again after some were lowered anew

 private:
  bool in_action_of(uint32_t block) const;
  void add_member(uint32_t block, const PouDecl& decl);
  // inheritance.cc
  void inherit(uint32_t pou, uint32_t depth);
  uint32_t named_ancestor(const PouInfo& info, SpecId spec, bool interface);
  bool finish_ancestor(const PouInfo& info, uint32_t ancestor, SpecId spec, uint32_t depth);
  void set_base(PouInfo& info, uint32_t base, base::SourceSpan span);
  // overriding.cc
  void check_names(const PouInfo& info);
  void check_member(const PouInfo& info, const PouDecl& decl);
  bool is_read_only(const Variable& variable) const;
  void check_words(const PouInfo& method, const PouInfo& replaced) const;
  void check_override(const PouInfo& method, const Found& inherited, uint32_t MemberCode::*slot);
  bool check_signature(const PouInfo& method, const PouInfo& wanted, DiagnosticCode code);
  void check_abstract(const PouInfo& info);
  void check_implements(const PouInfo& info, const PouInfo& interface);
  bool inherits(const PouInfo& info, const PouInfo& interface) const;

  void report_circle(const std::vector<uint32_t>& path);
  uint32_t other_instance_in(const std::vector<uint32_t>& circle) const;
  void give_usual_depth(const std::vector<uint32_t>& pous);
  std::vector<uint32_t> find_circle(std::vector<uint8_t>& marks, uint32_t& start) const;
  // start.cc
  void check_start_arguments();
  void check_start_arguments(SpecId spec, ir::TypeId type, std::vector<bool>& good);
  bool has_members_to_start(const PouInfo& info);
  VarId program_global(const std::string& name, const PouInfo& program);
  void add_start_program();
  void add_stamp(PouInfo& block);
};

}  // namespace frontend
