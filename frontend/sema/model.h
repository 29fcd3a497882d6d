// What declarations mean: the records that the passes of sema fill and lowering
// reads. All of them belong to one Sema and live as long as it does.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "frontend/parse/tree.h"
#include "frontend/sema/names.h"
#include "ir/program/ir.h"

namespace frontend {

struct VariableTag;
using VarId = base::Id<VariableTag>;

// Declarations are resolved when somebody first needs them, in any order; meeting
// one that is busy means that it depends on itself.
enum class Progress : uint8_t { kNew, kBusy, kDone };

enum class Storage : uint8_t { kMember, kLocal, kGlobal };

inline constexpr uint32_t kNoPou = 0xffffffffu;

// Parameters, a result, and variables that live during one call?
constexpr bool has_frame(PouKind kind) {
  return kind == PouKind::kFunction || (kind >= PouKind::kMethod && kind <= PouKind::kSetter);
}

// Where a view of shared bytes is (shared_addresses.h).
struct AddressView {
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t global = kNone;  // member of the globals
  uint32_t member = 0;      // of its type
  int32_t bit = -1;         // a BOOL at that bit of the member, which is a BYTE
};

struct Variable {
  Name name;
  const VarDecl* decl = nullptr;  // null: a function's result, or what a setter is given
  VarSection section = VarSection::kLocal;
  Access access = Access::kDefault;
  bool constant = false;  // is not written; whether its value is known: has_known_value()
  bool retain = false;
  bool non_retain = false;  // says NON_RETAIN
  bool used = false;
  bool written = false;       // by code, or its address was taken
  bool hidden = false;        // not of the source: see hidden_variables.cc
  bool stamp = false;         // of start code: ir::Section::kStamp
  bool by_reference = false;  // in-out of a function block: a REFERENCE TO bound at each call
  bool each_call = false;     // an instance that each call makes anew (call_instances.cc)
  bool takes_any = false;     // an input of type ANY, as a record (any_inputs.cc)
  bool runtime_init = false;  // the initialiser runs at each call
  Progress progress = Progress::kNew;
  Storage storage = Storage::kMember;
  uint32_t index = 0;  // member or local number
  uint32_t pou = kNoPou;
  VarId external;             // the global that a VAR_EXTERNAL means
  std::string_view list;      // of a global that is visible as `List.name` only
  std::string_view method;    // whose VAR_INST it is
  AddressView view;           // it shares bytes with others
  VarId same_as;              // it is that global, under another name
  ir::DirectAddress address;  // of shared bytes themselves
  VarId edge, last;           // R_EDGE, F_EDGE: what the body sees, and the level before
  ir::TypeId bound;           // of an open parameter: the type that this instance gives it
  ir::TypeId type;            // invalid: could not be resolved (already reported)
  ir::ConstId init;           // invalid: the type's default
};

// CONSTANT inputs and in-outs are only read here: who calls says what they are.
inline bool has_known_value(const Variable& variable) {
  return variable.constant && variable.section != VarSection::kInput &&
         variable.section != VarSection::kInOut;
}

// The global variables of one file, CONFIGURATION, RESOURCE or {attribute 'list' := 'Name'}.
struct GlobalList {
  NameMap<VarId> names;
};

// An argument of a program instance that is copied at each scan: of Tree::args, by number, for the
// list moves when later texts are read.
struct Connection {
  VarId parameter;
  uint32_t arg;
};

// What stands at an address: a variable, or the address itself in code.
struct Located {
  ir::DirectAddress address;
  ir::TypeId type;
  base::SourceSpan span;
  std::string name;
  bool configured = false;  // by VAR_CONFIG
};

// located.cc: does a TEST stand there? No name begins as an address_key() does.
bool is_in_test(const Tree& tree, base::SourcePos at);
std::string address_key(const ir::DirectAddress& address, ir::TypeId type);
// BOOL for %X, BYTE for %B and so on.
ir::TypeId type_of_direct(const ir::TypeTable& types, const ir::DirectAddress& address);

// What is known of addresses beside the variables that have them.
struct Addresses {
  std::unordered_map<std::string, AddressView> views;        // of bare ones, by address_key()
  bool direct_shares = false;                                // a bare one shares its place
  std::vector<Located> direct_uses;                          // bare ones that are globals
  std::vector<Located> configured;                           // by VAR_CONFIG
  std::unordered_map<std::string, uint32_t> direct_members;  // bare ones that are globals
};

// A write to the output image, found in a body.
struct OutputWrite {
  ir::DirectAddress address;
  ir::TypeId type;
  base::SourceSpan span;
};

// A body names a global that is declared outside every RESOURCE of several; `span` where it writes
// it, or takes its address.
struct OuterUse {
  VarId global;
  bool written = false;
  base::SourceSpan span = {};
};

// Where a structure keeps what a name means.
struct StructureField {
  uint32_t member = 0;
  int32_t bit = -1;  // of a BIT member: its number in the BYTE
  SpecId spec = {};  // as written
  base::SourceSpan name = {};
};

// A MOCK_FUNCTION declaration, and the POU that it became.
struct MockBody {
  const PouDecl* decl;
  bool inside_test;
  uint32_t pou;
};

// A type expression after resolution. `init` is the default of a derived type.
struct TypeUse {
  ir::TypeId type;
  ir::ConstId init;
};

struct SpecInfo {
  Name name;  // of the TYPE declaration whose whole content this is
  ExprId default_value;
  Progress progress = Progress::kNew;
  TypeUse use;
  ir::TypeId forward;  // structures and unions: known by name before their content
};

struct EnumRef {
  SpecId spec;
  uint32_t index = 0;
};

// The type of an expression before its context has spoken.
enum class Flex : uint8_t {
  kNone,     // `type` it is
  kInteger,  // any numeric type; `type` if the context does not care
  kReal,     // any real type
  kText,     // string literal: also CHAR or WCHAR
  kEnum,     // literal of several enumerations: the context's one
  kNull,     // NULL, ADR(x): any pointer or reference
};

// What the compiler may know of a value. Bodies only take kConstant as known: calls of
// standard functions there stay calls, with their traps.
enum class Known : uint8_t {
  kNo,
  kInitially,  // from initial values of variables: in initial values only
  kByCall,     // standard functions of constants: wherever a constant is asked for
  kConstant,
};

// Of an integer or bit string below 32 bits: what an operator does with it (docs/LANGUAGE.md,
// "Width of intermediate results").
enum class Width : uint8_t {
  kOwn,     // it has the width of its type
  kWide,    // codesys, twincat: an operator made it, as a DINT; it counts as its `type`
  kWraps,   // iec: it is what `+`, `-` or `*` has cut to its type, or one of several such
  kCopies,  // iec: a conversion of what is kWraps, which has the same number of bits
};

struct Note {
  ir::TypeId type;  // invalid: erroneous, already reported
  Flex flex = Flex::kNone;
  Width width = Width::kOwn;
  Progress progress = Progress::kNew;
  bool constant = false;
  Known known = Known::kNo;  // kConstant where `constant` is set
  uint8_t bit_size = 0;      // x.3, x.%B1, x.NUMBER: size and number of the part; else 0
  uint32_t bit_number = 0;
  int32_t bit_member = -1;  // of a BIT member: the member of the structure that holds it
  // A DINT or LINT that is never negative: in the context of UDINT, ULINT and bit strings of its
  // size it is computed in them (width.h).
  bool any_sign = false;
  bool view = false;   // with bit_size: a BOOL at a bit of shared bytes, by its name
  bool calls = false;  // contains a call of a POU
  bool can_trap = false;
  VarId variable;  // kName: the variable meant
  // The block or interface whose property of this name the expression is.
  uint32_t property = kNoPou;
  // Valid: the expression is a REFERENCE TO of this type and stands for its target; `type` is the
  // target's.
  ir::TypeId reference;
};

// What a body did beside its own code (resident.h).
struct BodyLog {
  std::vector<uint32_t> marks;  // twice the number of a variable that it uses; odd: writes
  bool other_lines = false;     // its code has lines of other declarations
};

// What the declaration means in one instance of it: its expressions and types differ from
// those of other instances.
struct Meaning {
  std::unordered_map<uint32_t, Note> notes;      // by expression
  std::unordered_map<uint32_t, SpecInfo> specs;  // by type expression
  NameMap<ir::TypeId> generic;                   // ANY_NUM -> INT
};

// What a build for tests adds to a POU, so that a test can replace it and count its calls.
// Function blocks: member numbers. Functions: members of the globals.
struct MockSlots {
  bool present = false;
  uint32_t active = 0;  // DINT; 0: not mocked, 1: by RETURNS or MOCK, else 2 + number of the body
  uint32_t calls = 0;   // UDINT
  uint32_t value = 0;   // of a function with a result
  std::vector<uint32_t> bodies;  // POUs of MOCK_FUNCTION declarations
};

// What a block, program or interface has under one name besides variables: a method or action,
// or the accessors of a property. Numbers of POUs.
struct MemberCode {
  uint32_t method = kNoPou;
  uint32_t getter = kNoPou;
  uint32_t setter = kNoPou;
  bool is_property() const { return getter != kNoPou || setter != kNoPou; }
};

// Code without a body in the source: __START, and the methods __RESET and __LEAVE.
enum class MadeCode : uint8_t { kNone, kStart, kReset, kLeave };

struct PouInfo {
  uint32_t number = 0;  // in Declarations::pous
  const PouDecl* decl = nullptr;
  std::string_view name;           // qualified: A.B.Pump; of a method: its own
  const PouDecl* setup = nullptr;  // of a TEST: runs before and after its body
  const PouDecl* teardown = nullptr;
  bool as_block = false;  // a PROGRAM in a build for tests, which have instances of it
  bool test = false;      // a TEST, or a mock's body: it may use what is private
  MockSlots mock;
  bool library = false;
  ir::PouId id;
  ir::TypeId self;          // instance type; invalid for functions; of a method: its owner's
  uint32_t owner = kNoPou;  // of a method: the block, program or interface
  uint32_t base = kNoPou;   // EXTENDS of a block
  std::vector<uint32_t> interfaces;  // IMPLEMENTS of a block, EXTENDS of an interface
  uint32_t inherited = 0;            // members of the instance that are the base's
  Progress inheritance = Progress::kNew;
  uint32_t start = kNoPou;          // its method __START, where members need one
  VarId stamp;                      // of it or its base, where FB_Init and the like are
  bool shares_temporaries = false;  // its VAR_TEMP are members, which actions see
  uint32_t reset = kNoPou;          // its methods for pools: pools.h
  uint32_t leave = kNoPou;
  MadeCode made = MadeCode::kNone;  // what it is itself
  NameMap<MemberCode> code;         // its own methods, actions and properties
  std::vector<uint32_t> overrides;  // of a method: what a virtual call of it may run instead
  NameMap<VarId> names;
  std::vector<VarId> variables;       // in declaration order
  std::vector<VarId> locals;          // by local number
  std::vector<VarId> members;         // its own, in order: member `inherited` is the first
  std::vector<VarId> call_instances;  // the variables with `each_call`
  VarId result;
  // Parameters of open types (ANY_NUM, ARRAY[*]): no code of its own, only instances have.
  bool open = false;
  bool resolved = false;                // its interface is in the program
  std::string_view old_name;            // by a rule in front of it, qualified as `name`; "": none
  std::string_view static_list;         // in front of the names of VAR_STAT variables
  uint32_t overload = kNoPou;           // the next function of that name
  std::unique_ptr<Meaning> meaning;     // of an instance
  std::vector<Connection> connections;  // of a program instance
  VarId global;                         // of a program that others use: called_programs.cc
  bool called = false;                  // by other POUs
  uint32_t usual_depth = 0;             // of calls by other instances in a circle (recursion.cc)
  std::vector<OutputWrite> writes;      // filled by lowering, like callees
  std::vector<uint32_t> callees;
  std::vector<OuterUse> outer_uses;
  bool reaches_out = false;  // an FB_Init that tells others of its instance, or writes elsewhere
};

// What __NEW takes from (pools.h).
struct Pool {
  std::string_view name;    // of the type, qualified
  ir::TypeId type;          // what a pointer to an element points to
  uint32_t block = kNoPou;  // of the instances
  bool boxed = false;
  uint32_t count = 0;
  VarId elements;  // ARRAY[1..count] OF the block
  VarId states;    // ARRAY[1..count] OF BYTE: kPoolFree and so on
};

// Store: all pools, and what start code visits (objects.h).
struct Pooled {
  std::vector<Pool> all;
  bool declared = false;
};
struct Started {
  std::unordered_map<ir::TypeId, bool> constructs;  // are there instances in it to be visited?
  std::vector<VarId> globals;                       // what __START begins with, then programs
  VarId change_flag;  // a global, not 0 where a change is what start code runs for
};

// Whose names are visible. A value: who resolves something of another POU makes another one.
struct PouScope {
  PouScope() = default;  // outside of all POUs
  explicit PouScope(const PouInfo& info) : pou(&info), meaning(info.meaning.get()) {}
  uint32_t number() const { return pou == nullptr ? kNoPou : pou->number; }

  const PouInfo* pou = nullptr;
  Meaning* meaning = nullptr;  // of its own, if the POU is an instance
  // Of declarations in a list of globals that others see as `List.name` only: their own list.
  std::string_view list;
};

}  // namespace frontend
