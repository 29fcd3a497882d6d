// Builds one random program: types first, then POUs, each with the names that it sees. Everything
// is decided by the seed. What the compiler refuses by rule (overflow of constants, labels
// that overlap, recursion, endless loops) is never built; what traps is, now and then.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frontend/parse/tree.h"
#include "stdlib/registry.h"
#include "tests/differential/generator.h"
#include "tests/differential/random.h"
#include "tests/differential/tree.h"

namespace differential {

inline constexpr uint32_t kMaxRounds = 60;  // of nested loops, together

// Where a value can stand: "parts[@0].m3", with an index per hole.
struct Place {
  std::string pattern;
  std::vector<Bounds> holes;
  TypeRef type = kNoType;
  bool writable = true;
  bool constant = false;
};

// `runner` goes through the `elements` behind `begin`, `step` bytes each.
struct Walker {
  std::string begin;
  std::string runner;
  std::string number;   // an integer that may hold an address for a moment
  std::string element;  // its type
  uint32_t elements = 0;
  uint32_t step = 0;
};

// Of a function, method or function block, as its callers see it.
struct Interface {
  std::string name;
  TypeRef result = kNoType;
  TypeRef block = kNoType;  // the type of instances
  std::vector<Variable> inputs;
  std::vector<Variable> outputs;
  std::vector<Variable> in_outs;
  bool callable = true;    // a class has no body
  bool recursive = false;  // its first input, `depth`, counts down
  uint32_t rank = 0;       // of a method: it calls those of lower rank only
  std::string visibility;  // "PROTECTED "
  std::vector<Interface> methods;
  std::vector<Variable> properties;
  std::vector<std::string> actions;
  bool constructed = false;            // has an FB_Init
  std::vector<Variable> construction;  // what it takes
};

struct Seen {
  Variable variable;
  bool writable = true;
  bool constant = false;
};

// A function block with methods, and what its methods and what extends it see of it.
struct Class {
  Interface face;
  std::vector<Seen> seen;
  std::vector<std::pair<std::string, TypeRef>> loops;
  std::vector<std::string> missing;  // methods that are still abstract
};

// An interface, a base that implements it, and what extends that.
struct Family {
  bool plain = false;  // of CLASS
  bool abstract = false;
  Interface contract;
  std::string self;  // a method that gives the object; none: ""
  std::string wide;  // the interface that the contract extends, or itself
  std::vector<Interface> helpers;
  TypeRef base = kNoType;
  std::vector<TypeRef> concrete;
};

// What methods are called on: "THIS^.", "itf3.".
struct Receiver {
  std::string text;
  Interface face;
};

// Instances of a family in a POU, and the variables that lead to one of them.
struct Handles {
  Family family;
  std::vector<Variable> instances;
  std::string face;
  std::string asked;
  std::string pointer;  // to the base
  std::string down;     // to the last that extends it
};

class Builder {
 public:
  Builder(uint64_t seed, bool construction, bool iec);
  Program run();

 private:
  // --- types (types.cc)
  void declare_types();
  void declare_enum();
  void declare_subrange();
  void declare_struct();
  void declare_array();
  void declare_union();
  void declare_node();
  TypeRef add_type(Type type);
  TypeRef declared(Type type);
  TypeRef string_type(bool wide, uint32_t capacity);
  TypeRef array_of(TypeRef element, std::vector<Bounds> dims);
  TypeRef named(Form form, std::string name,
                TypeRef base);         // made once: a reference, an open array
  TypeRef pointer_to(TypeRef target);  // or REF_TO
  TypeRef open_array(TypeRef element, uint32_t dims);
  TypeRef any_of(const std::vector<TypeRef>& list) { return list[below(count(list))]; }
  TypeRef any_scalar();  // elementary, enumeration, subrange or string
  TypeRef any_elementary();
  TypeRef any_data();  // also aggregates
  bool is(TypeRef type, Form form) const { return program_[type].form == form; }
  bool is_text(TypeRef type) const { return is(type, Form::kString) || is(type, Form::kWstring); }
  bool is_aggregate(TypeRef type) const {
    return is(type, Form::kArray) || is(type, Form::kStruct) || is(type, Form::kUnion);
  }
  ir::Group group(TypeRef type) const;
  bool is_integer(TypeRef type) const;
  bool is_bits(TypeRef type) const;  // without BOOL
  bool is_number(TypeRef type) const { return is_integer(type) || group(type) == ir::Group::kReal; }
  std::string name_of(TypeRef type) const { return type_text(program_, type); }
  // The range of an integer or subrange, cut to 64 bits signed.
  Bounds range(TypeRef type) const;

  bool holds_block(TypeRef type) const;
  std::optional<uint32_t> bytes_of(TypeRef type) const;  // of plain numbers, and arrays of them
  uint64_t most_bytes(TypeRef type) const;               // with what alignment may take

  // --- literals (literals.cc)
  Expr literal(TypeRef type, bool bare = false);
  Expr constant_text(TypeRef type, std::string text);
  std::string integer_text(TypeRef type, int64_t value, bool bare);
  std::string random_integer(TypeRef type, bool bare);
  std::string random_real(TypeRef type, bool bare);
  std::string random_time(TypeRef type);
  std::string random_text(bool wide, uint32_t length);
  Expr initial(TypeRef type);

  // --- names in sight (places.cc)
  void see(const Variable& variable, bool writable, bool constant = false);
  void see_inside(Place place);
  void see_elements(const Place& place, const Type& type);
  void see_members(const Place& place, const std::vector<Variable>& members, bool writable);
  void forget();
  const Place* find(TypeRef type, bool writable);
  const Place* find_text(bool wide, bool writable);
  const Place* find_open(TypeRef open, bool writable);  // an array of that element type
  const Place* find_any();                              // something writable of any type
  Expr use(const Place& place, int depth);
  Expr index(Bounds bounds, int depth);
  std::optional<Expr> variable(TypeRef type);  // any text of the kind for strings
  std::optional<Expr> target(TypeRef type);    // to be written, exactly that type
  Expr read(TypeRef type);                     // a variable, or something not constant

  // --- references (references.cc)
  void references(Pou& pou);
  void refer(Pou& pou);
  void walk(Pou& pou);
  void link_nodes(Pou& pou);
  void own_target(Pou& pou, const Variable& parameter);
  Expr pointer_value(TypeRef type, int depth);
  std::optional<Expr> address_of(TypeRef pointer, int depth);
  std::optional<Expr> pointer_test(int depth);
  std::optional<Stmt> retarget();
  std::optional<Stmt> step();
  Stmt excursion(const Walker& walker);
  Variable unseen(Pou& pou, Section kind, TypeRef type);
  std::string address_word(TypeRef pointer) const;
  bool bound_at_start(const Expr& to) const;

  // --- expressions (expressions.cc, operators.cc, standard.cc)
  bool possible(TypeRef type);
  Expr expression(TypeRef type, int depth);
  Expr operation(TypeRef type, int depth);
  Expr node(TypeRef type, std::string pattern, std::vector<Expr> operands);
  Expr enum_operation(TypeRef type, int depth);
  Expr subrange_operation(TypeRef type, int depth);
  Expr bool_operation(int depth);
  Expr integer_operation(TypeRef type, int depth);
  Expr bits_operation(TypeRef type, int depth);
  Expr real_operation(TypeRef type, int depth);
  Expr duration_operation(TypeRef type, int depth);
  Expr date_operation(TypeRef type, int depth);
  Expr text_operation(TypeRef type, int depth);
  Expr division(TypeRef type, int depth);
  Expr conversion(TypeRef to, int depth);
  bool convertible(TypeRef from, TypeRef to) const;
  std::string plain_name(TypeRef type) const;
  Expr small_real(TypeRef type, int depth);
  Expr small_integer(TypeRef type, int64_t low, int64_t high, int depth);
  std::optional<TypeRef> narrower(TypeRef type);
  std::optional<Expr> standard(TypeRef type, int depth);
  bool gives(const stdlib::FunctionRow& row, TypeRef type) const;
  std::vector<Expr> standard_operands(const stdlib::FunctionRow& row, TypeRef type, int depth);
  static TypeRef named_type(std::string_view name);
  std::vector<Expr> moment_parts(const stdlib::FunctionRow& row, int depth);
  static std::string parameter_name(const stdlib::FunctionRow& row, uint32_t number);
  std::optional<Stmt> split_call(int depth);
  std::optional<Expr> function_call(TypeRef type, int depth);
  std::optional<Expr> character(TypeRef type, bool writable, int depth);

  // --- calls (calls.cc)
  std::optional<std::vector<Expr>> arguments(const Interface& callee, bool block, int depth);
  bool callable(const Interface& callee);
  void read_library();
  void library_block(const frontend::Tree& tree, const frontend::PouDecl& pou);
  TypeRef library_type(const frontend::Spec& spec);

  // --- objects (objects.cc, receivers.cc)
  void family();
  Interface method_face(const char* prefix);
  void declare_contract(Family& family);
  Pou head_of(const Interface& face);
  // Without a word a method is PUBLIC, and PROTECTED by the standard.
  std::string visibility_words(const Interface& face) const {
    return iec_ && face.visibility.empty() ? "PUBLIC " : face.visibility;
  }
  Pou self_method(const Family& family, bool with_body);
  Class declare_class(const Class* base, const Family& family, bool last);
  void class_parameters(Pou& pou, Interface& face);
  void class_methods(Pou& pou, Class& out, const Class* base, const Family& family);
  void class_members(Pou& pou, Class& out, const Class* base, const Family& family);
  void see_own(const Class& one);
  void own_receivers(const Class& owner, const Class* base, uint32_t rank);
  Pou method(const Class& owner, const Interface& face, const Class* base);
  void without_loops(const std::vector<Seen>& seen);
  bool passes_addresses(const Pou& pou) const;
  Stmt action(const std::vector<Seen>& seen, const std::string& name);
  Stmt property(const Class& owner, const Variable& one);
  void construct(Pou& pou, Interface& face, const Class* base);
  std::string construction_arguments(TypeRef type);
  void objects(Pou& pou);
  std::optional<std::pair<Expr, Interface>> any_receiver();
  std::optional<Expr> method_call(TypeRef type, int depth);
  std::optional<Stmt> method_statement(int depth);
  std::optional<Stmt> rebind();
  Stmt tested(const Handles& one);
  Stmt asked(const Handles& one);

  // --- traps that are caught, recursion (tries.cc)
  Stmt fault();
  Stmt try_statement(int depth);
  void descend(Pou& pou, const Interface& face, const std::string& receiver);
  void recursive_functions();
  Expr descent();

  // --- charts (charts.cc)
  void chart(Pou& pou);
  std::string qualifier();
  std::string step(Pou& pou, bool initial);
  void transition(Pou& pou, const std::string& from, const std::string& to);
  std::string segment(Pou& pou, const std::string& from);

  // --- instruction lists (lists.cc)
  void instruction_list(Pou& pou, uint32_t groups);
  void row(std::vector<Stmt>& out, std::string text, std::vector<Expr> operands,
           bool pinned = false);
  Expr operand(TypeRef type);
  void rows(std::vector<Stmt>& out);
  void rows_of_values(std::vector<Stmt>& out);
  void rows_of_bools(std::vector<Stmt>& out);
  void rows_of_call(std::vector<Stmt>& out);
  void rows_of_function(std::vector<Stmt>& out);
  void rows_over(std::vector<Stmt>& out);
  void rows_again(std::vector<Stmt>& out);
  void store_bool(std::vector<Stmt>& out);

  // --- functions of many types (generics.cc)
  void declare_generics();
  std::optional<Expr> generic_call(TypeRef type, int depth);
  std::optional<Stmt> swap_call();

  // --- statements (statements.cc, loops.cc)
  std::vector<Stmt> statements(uint32_t count, int depth);
  Stmt statement(int depth);
  Stmt simple(std::string head, std::vector<Expr> operands);
  Stmt assignment();
  std::optional<Stmt> aggregate_assignment();
  std::optional<Stmt> bit_assignment();
  std::optional<Stmt> block_call(int depth);
  std::optional<Stmt> call_statement(int depth);
  std::optional<Stmt> chain();
  std::optional<Stmt> set_or_reset();
  Stmt jump_over(int depth);
  std::optional<Stmt> jump_back(int depth);
  std::optional<Stmt> character_assignment();
  Stmt if_statement(int depth);
  Stmt case_statement(int depth);
  Stmt case_integer(int depth);
  Stmt case_enum(TypeRef type, int depth);
  Stmt for_statement(int depth);
  Stmt while_statement(int depth);
  Stmt leave(const char* word);

  // --- configuration (configuration.cc)
  void exchange(Task& task);
  void tasks(uint32_t count);
  void connect(Task& task, const Interface& face);
  void configure(Pou& pou);

  // --- declarations (pous.cc)
  void globals();
  void shared_globals();
  void function(uint32_t index);
  void block(uint32_t index);
  void block_body(Pou& pou);
  std::string place_in_space(Pou& pou);
  void program(uint32_t index, uint32_t count);
  void program_action(Pou& pou);
  void side_program();
  void call_side();
  void global_instances();
  void external(Pou& pou);
  VarBlock& section(Pou& pou, Section kind);
  Variable& declare(Pou& pou, Section kind, TypeRef type, bool with_initial = true);
  void name_initial(Variable& variable);
  TypeRef any_block();
  void parameters(Pou& pou, Interface& face);
  void locals(Pou& pou, uint32_t count);
  void loop_variables(Pou& pou);
  void instances(Pou& pou);
  void body(Pou& pou, uint32_t count, int depth);

  template <class T>
  static uint32_t count(const std::vector<T>& list) {
    return static_cast<uint32_t>(list.size());
  }
  bool trap_in(uint32_t n) { return caught_ > 0 ? one_in(1 + n / 4) : risky_ && one_in(n); }
  // A function or method: its variables begin anew at each call.
  bool has_frame() const { return kind_ == PouKind::kFunction || kind_ == PouKind::kMethod; }
  // Written by loops only.
  static bool is_counter_name(const std::string& name) {
    return name.starts_with("loop") || name == "guard";
  }
  uint32_t below(uint32_t n) { return random_.below(n); }
  bool one_in(uint32_t n) { return random_.one_in(n); }
  std::string fresh(const char* prefix) { return prefix + std::to_string(next_name_++); }

  Random random_;
  bool construction_;
  bool iec_;  // the dialect
  Program program_;
  std::map<TypeRef, std::vector<Place>> places_;
  std::map<std::pair<bool, uint32_t>, TypeRef> strings_;
  std::vector<TypeRef> enums_;
  std::vector<TypeRef> subranges_;
  std::vector<TypeRef> structs_;
  std::vector<TypeRef> arrays_;
  std::vector<TypeRef> unions_;
  std::vector<TypeRef> nodes_;    // structures that refer to their own type
  std::vector<TypeRef> holders_;  // structures with function blocks in them
  std::vector<Interface> functions_;
  std::vector<Interface> blocks_;   // of the program, callable by those that follow
  std::vector<Interface> library_;  // standard function blocks
  std::vector<Variable> global_variables_;
  std::vector<Variable> global_constants_;
  std::vector<Interface> programs_;
  std::map<std::string, TypeRef> named_;  // types that have no declaration
  std::vector<Place> bits_;               // BIT members
  std::vector<Variable> nameable_;        // what an initial value may name
  std::vector<Stmt> prologue_;            // of the body: references are set there
  std::vector<Variable> pointers_;        // of the POU, that may be set to something else
  std::vector<Walker> walkers_;
  std::map<TypeRef, Interface> faces_;                  // by the type of instances
  std::vector<std::pair<std::string, TypeRef>> loops_;  // counters that the POU has
  std::vector<Seen> own_;  // variables of the POU that its methods and actions see
  std::vector<Receiver> receivers_;
  std::vector<Handles> handles_;
  std::vector<Family> families_;
  std::map<TypeRef, std::vector<TypeRef>> derived_;
  std::vector<std::string> actions_;  // of the chart
  std::optional<Interface> side_;     // a program that others call
  std::vector<std::string> spaces_;   // namespaces with something in them
  uint32_t next_rank_ = 0;
  uint32_t next_point_ = 0;  // %M
  uint32_t caught_ = 0;      // open __TRY
  uint32_t in_loop_ = 0;     // open FOR, WHILE, REPEAT
  bool descending_ = false;  // a recursive body: no other recursion in it
  bool configured_ = false;  // has a CONFIGURATION
  uint32_t loop_level_ = 0;
  uint32_t rounds_ = 1;  // of all open loops together
  uint32_t next_name_ = 0;
  uint32_t inside_index_ = 0;
  bool risky_ = false;     // traps now and then
  bool generics_ = false;  // has the functions of generics.cc
  bool guarded_ = false;   // a WHILE or REPEAT is open
  PouKind kind_ = PouKind::kFunction;
};

}  // namespace differential
