// A random program as the generator built it: a tree that can be printed, shrunk and edited
// without reading text again. It knows types and holes, not the grammar of every construct: an
// expression or the head of a statement is a pattern whose holes are filled by operands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ir/types/types.h"

namespace differential {

using TypeRef = uint32_t;  // Program::types; the elementary types stand first, in ir::Kind's order
inline constexpr TypeRef kNoType = 0xffffffffu;

// `@0` in the pattern stands for operands[0]; `@*` for all operands, separated by commas.
struct Expr {
  TypeRef type = kNoType;  // kNoType: an argument with its name, a type, ...
  std::string pattern;
  std::vector<Expr> operands;
  bool constant = false;  // the compiler computes it, and refuses overflow
  bool fixed = false;     // a variable has to stand here; only what is inside it shrinks
};

struct Stmt;

// A head and the statements below it: "IF @0 THEN", "ELSE", "1..3:".
struct Clause {
  std::string head;
  std::vector<Expr> operands;
  std::vector<Stmt> body;
  bool optional = false;  // the statement is complete without it
};

struct Stmt {
  std::vector<Clause> clauses;
  std::string tail;     // "END_IF;"
  bool pinned = false;  // a loop's own counter: the program would not end without it
};

struct Variable {
  std::string name;
  TypeRef type = kNoType;
  std::optional<Expr> initial = {};
  std::string address = {};    // "%QX0.0"
  std::string edge = {};       // "R_EDGE"
  bool bit = false;            // a BIT member; its type is BOOL
  std::string arguments = {};  // of FB_Init: "(1, x := 2)"
};

enum class Section : uint8_t {
  kLocal,
  kInput,
  kOutput,
  kInOut,
  kTemp,
  kRetain,
  kConstant,
  kStatic,
  kInst,
  kExternal,
  kGlobal,
  kGlobalRetain,
  kGlobalConstant,
};
const char* section_text(Section section);  // "VAR_INPUT"

struct VarBlock {
  Section section = Section::kLocal;
  std::vector<Variable> variables;
  std::string list = {};  // globals that only `list.x` names
};

enum class Form : uint8_t {
  kElementary,
  kString,
  kWstring,
  kEnum,
  kSubrange,
  kArray,
  kStruct,
  kUnion,
  kBlock,
  kPointer,    // POINTER TO, REF_TO
  kReference,  // REFERENCE TO
  kOpenArray,  // ARRAY[*]: of a parameter; dims has indices that are tried
  kGeneric,    // ANY_NUM: of a parameter
  kInterface,
};

struct Bounds {
  int64_t low = 0;
  int64_t high = 0;
};

struct Type {
  Form form = Form::kElementary;
  std::string name;        // as variables name it; empty for an array written out
  TypeRef base = kNoType;  // elements, target, what a structure extends
  int64_t low = 0;
  int64_t high = 0;
  uint32_t capacity = 0;
  std::vector<Bounds> dims;
  std::vector<std::string> literals;
  std::vector<int64_t> values;  // of the literals
  std::vector<Variable> members;
  bool declared = false;  // has a place in TYPE
  bool overlap = false;   // a union written as STRUCT OVERLAP
};

enum class PouKind : uint8_t { kFunction, kFunctionBlock, kProgram, kClass, kMethod, kInterface };

struct Pou {
  PouKind kind = PouKind::kFunction;
  std::string name;
  TypeRef result = kNoType;
  std::vector<VarBlock> blocks;
  std::vector<Stmt> body;      // statements, rows of a list, or steps and transitions
  std::string attribute = {};  // "{attribute 'recursion_depth' := '5'}"
  std::string words = {};      // "ABSTRACT ", "OVERRIDE "
  std::string relations = {};  // " EXTENDS Class1 IMPLEMENTS Contract2"
  std::string space = {};      // the namespace it stands in
  std::string uses = {};       // one whose names stand alone in it
  std::vector<Pou> methods = {};
  std::vector<Stmt> members = {};  // actions and properties
};

struct Task {
  std::string name;
  uint32_t period_ms = 10;
  uint32_t priority = 1;
  std::string program;                        // its type; the instance is called Run<type>
  std::string event = {};                     // SINGLE
  std::vector<std::string> connections = {};  // "v1 := g2", "v3 => g4", "v5 WITH Task1"
  std::vector<std::string> attributes = {};   // "'exchange' := 'own'"
};

struct Program {
  std::vector<Type> types;
  std::vector<TypeRef> declared;  // order in TYPE
  std::vector<VarBlock> globals;
  std::vector<Pou> pous;
  std::vector<Task> tasks;                   // empty: no CONFIGURATION
  std::vector<std::string> accesses = {};    // of VAR_ACCESS
  std::vector<std::string> configured = {};  // of VAR_CONFIG

  const Type& operator[](TypeRef type) const { return types[type]; }
};

inline TypeRef elementary(ir::Kind kind) { return static_cast<TypeRef>(kind); }
inline bool is_elementary(TypeRef type) { return type < ir::kElementaryCount; }
// Of a structure, with what it extends; of a union.
std::vector<Variable> members_of(const Program& program, TypeRef type);
std::string type_text(const Program& program, TypeRef type);
std::string text(const Expr& expr);
std::string print(const Program& program);

}  // namespace differential
