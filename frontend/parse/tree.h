// The syntax tree of one compilation: what the sources say, nothing resolved.
// One Tree owns all nodes of all files in flat stores; nodes refer to each other
// by id and to text by views into the SourceMap, which must outlive the tree.
// Immutable once parsing ends. Ladder, FBD and IL lower to the same nodes (diagrams are kept
// beside them, for tools); sequential function charts are a model of their own (chart.h). The
// former have a single node of their own: kResult, a variable without a name whose type is that
// of the values assigned to it. Damaged input still gives a tree: kError nodes stand where nothing
// could be understood, and a diagnostic was reported for each.
//
// Attributes (`{attribute 'name' := 'value'}`) stay with the declaration that they
// stand before. Namespaces do not nest in the tree: each declaration names its scope.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "base/inline_vector.h"
#include "base/slim_vector.h"
#include "frontend/network/network.h"
#include "frontend/parse/chart.h"
#include "frontend/parse/code_nodes.h"
#include "frontend/parse/expr_store.h"
#include "ir/program/source_content.h"

namespace frontend {

// --- types and variables -----------------------------------------------------
enum class SpecKind : uint8_t {
  kError,
  kNamed,        // [qualifiers .] name (elementary or declared); args when has_args
  kString,       // length (may be invalid); wide
  kArray,        // dims, element, element_args; open_bounds: ARRAY[*, *]
  kStruct,       // fields; overlap; element = its base (EXTENDS), may be invalid
  kUnion,        // fields
  kEnum,         // enumerators; element = base type (may be invalid)
  kSubrange,     // element, low, high
  kPointer,      // POINTER TO element
  kRefTo,        // REF_TO element
  kReferenceTo,  // REFERENCE TO element
};

struct DimSpec {
  ExprId low;  // both invalid: `*`
  ExprId high;
};
struct Enumerator {
  Name name;
  ExprId value;  // may be invalid
  Range32 attributes;
};

enum class Edge : uint8_t { kNone, kRising, kFalling };

// An address without an area (AT %B4 in a structure) is relative to the structure; `%I*`
// has an area and `incomplete`, and a size when one is written (%IW*).
struct VarDecl {
  base::InlineVector<Name, 1> names;  // several share one spec; none in VAR_CONFIG
  SpecId spec;
  ExprId init;  // may be invalid
  bool has_address = false;
  bool incomplete = false;    // AT %I*
  ir::DirectAddress address;  // AT %QX0.0
  Range32 levels;             // as in Expr
  Edge edge = Edge::kNone;
  ExprId path;            // VAR_ACCESS: what the name opens; VAR_CONFIG: what is completed
  bool writable = false;  // VAR_ACCESS: READ_WRITE
  bool binds = false;     // REF= in front of `init`
  bool implied = false;   // by a chart (sfc/declare.h): code reads it, only the chart writes it
  Range32 attributes;     // Tree::attributes
  base::SourceSpan span;
};

struct Spec {
  SpecKind kind = SpecKind::kError;
  base::SourceSpan span;
  Name name;
  Range32 qualifiers;  // kNamed: A, B of A.B.Name; Tree::names
  bool wide = false;
  bool overlap = false;
  bool open_bounds = false;
  bool has_args = false;
  Range32 args;          // kNamed: Pump(5), the arguments of FB_Init; Tree::args
  Range32 element_args;  // kArray: Pump[(1), (2)], a kStructInit per element; Tree::expr_lists
  ExprId length;
  SpecId element;
  ExprId low, high;
  base::SlimVector<DimSpec> dims;
  base::SlimVector<VarDecl> fields;
  Range32 attributes;  // kStruct, kUnion: those in front of the declaration
  base::SlimVector<Enumerator> enumerators;
};

enum class VarSection : uint8_t {
  kLocal,
  kInput,
  kOutput,
  kInOut,
  kTemp,
  kExternal,
  kGlobal,
  kStatic,    // VAR_STAT: one for all instances and calls
  kInstance,  // VAR_INST: of a method, lives in its instance
  kAccess,    // VAR_ACCESS
  kConfig,    // VAR_CONFIG
};

// Does a call give it, or get it?
constexpr bool is_parameter(VarSection section) {
  return section == VarSection::kInput || section == VarSection::kOutput ||
         section == VarSection::kInOut;
}

enum class Access : uint8_t { kDefault, kPublic, kPrivate, kProtected, kInternal };

struct VarBlock {
  VarSection section = VarSection::kLocal;
  bool constant = false;
  bool retain = false;      // RETAIN or PERSISTENT
  bool non_retain = false;  // NON_RETAIN, written out
  Access access = Access::kDefault;
  Range32 attributes;    // of the block: {attribute 'qualified_only'} in front of VAR_GLOBAL
  bool goes_on = false;  // VAR_GLOBAL right behind the END_VAR of another one, without attributes
  ScopeId scope;
  base::SourceSpan span;
  base::SlimVector<VarDecl> vars;
};

// --- declarations ------------------------------------------------------------
// A file (no name, no parent) or a namespace: `NAMESPACE A.B` is two scopes. Several may have the
// same path; what they declare belongs together.
struct Scope {
  Name name;
  ScopeId parent;
  bool internal = false;
  std::vector<Range32> usings;  // USING A.B; a path in Tree::names each
  base::SourceSpan span;
};

struct TypeDecl {
  Name name;
  SpecId spec;
  ExprId init;  // default of a derived type
  Access access = Access::kDefault;
  Range32 attributes;
  ScopeId scope;
};

enum class PouKind : uint8_t {
  kFunction,
  kFunctionBlock,
  kProgram,
  kClass,
  kInterface,
  // Members of the above, in PouDecl::members:
  kMethod,
  kAction,
  kGetter,  // PROPERTY name : result, its GET; reads as a function of that name
  kSetter,  // its SET: `result` is the type of the value, which has the property's name
  // In Tree::tests:
  kTest,          // TEST 'name': the text without quotes is the name
  kSetup,         // no name
  kTeardown,      // no name
  kMockFunction,  // also a member of a kTest
};

inline constexpr uint32_t kNoChart = 0xffffffffu;
inline constexpr uint32_t kNoDiagram = 0xffffffffu;

struct PouDecl {
  PouKind kind = PouKind::kFunction;
  Name name;
  Range32 qualifiers;  // kMockFunction: A, B of A.B.Name; Tree::names
  SpecId result;       // functions, methods, properties; may be invalid
  std::vector<VarBlock> blocks;
  Range32 body;                   // Tree::stmt_lists
  uint32_t chart = kNoChart;      // Tree::charts: the body is that chart, `body` is empty
  uint32_t diagram = kNoDiagram;  // Tree::diagrams: what `body` was made of
  base::SourceSpan span;          // PROGRAM ... END_PROGRAM
  // From the last word in front of the statements to the word after them; invalid where other
  // things than statements stand between them.
  base::SourceSpan code = {};
  Access access = Access::kDefault;
  bool is_abstract = false;
  bool is_final = false;
  bool is_override = false;
  std::vector<SpecId> extends;     // kNamed; several for interfaces only
  std::vector<SpecId> implements;  // kNamed
  std::vector<PouDecl> members;    // in source order
  std::vector<Range32> usings;     // as in Scope
  Range32 attributes;
  ScopeId scope;  // of members too
  Range32 exprs;  // numbers among all expressions of bodies (expr_store.h): of its own and members'
  ir::SourceContent content;  // without members: what no layout, comment or case changes (E-02)
};

struct TaskDecl {
  Name name;
  ExprId interval;  // may be invalid
  ExprId priority;
  ExprId single;
  Range32 attributes;
  base::SourceSpan span;
};

struct BlockTask {  // fb WITH task
  Name block;
  Name task;
};

struct ProgramDecl {  // PROGRAM p WITH t : T(...)
  Name name;
  Name task;  // may be empty
  Range32 qualifiers;
  Name type;
  bool retain = false;
  bool non_retain = false;
  Range32 args;
  std::vector<BlockTask> block_tasks;
  Range32 attributes;
  base::SourceSpan span;
};

struct ResourceDecl {
  Name name;
  Name type;                      // ON type; may be empty
  std::vector<VarBlock> globals;  // also VAR_ACCESS and VAR_CONFIG, as in ConfigDecl
  std::vector<TaskDecl> tasks;
  std::vector<ProgramDecl> programs;
  Range32 attributes;
};

struct ConfigDecl {
  Name name;
  std::vector<VarBlock> globals;        // VAR_GLOBAL, VAR_ACCESS, VAR_CONFIG
  std::vector<ResourceDecl> resources;  // a single unnamed one when RESOURCE is left out
  Range32 attributes;
  ScopeId scope;
  base::SourceSpan span;
};

// What an instruction list keeps of its current result, or a diagram of power and values. `values`
// are those that come from above; at a label, jumps from below assign others. Power that leaves a
// box by an output is kept as at a label: the call assigns it.
struct KeptResult {
  Range32 values;  // Tree::expr_lists
  bool at_label = false;
  ExprId target = {};  // of a diagram: the variable it goes to, whose type literals take
};

struct Tree {
  ExprStore exprs;
  std::vector<Stmt> stmts;
  std::vector<Spec> specs;
  std::vector<Literal> literals;
  std::vector<std::string> texts;  // of string literals: escapes resolved, WSTRING as UTF-16LE
  std::vector<Direct> directs;
  std::vector<Arg> args;
  std::vector<Branch> branches;
  std::vector<CaseArm> cases;
  std::vector<CaseLabel> labels;
  std::vector<ExprId> expr_lists;
  std::vector<StmtId> stmt_lists;
  std::vector<Attribute> attributes;
  std::vector<Name> names;
  std::vector<uint32_t> levels;
  std::vector<KeptResult> results;  // of kResult
  std::vector<Scope> scopes;
  std::vector<Chart> charts;
  std::vector<network::Body> diagrams;
  std::deque<std::string> made_names;  // of implied variables, which no source spells

  std::vector<TypeDecl> types;
  std::vector<PouDecl> pous;
  std::vector<VarBlock> globals;  // VAR_GLOBAL and VAR_CONFIG outside CONFIGURATION
  std::vector<ConfigDecl> configs;
  std::vector<PouDecl> tests;

  const Expr& operator[](ExprId id) const { return exprs[id.index]; }
  const Stmt& operator[](StmtId id) const { return stmts[id.index]; }
  const Spec& operator[](SpecId id) const { return specs[id.index]; }
  const Scope& operator[](ScopeId id) const { return scopes[id.index]; }
  // The name of that number, or an empty one for kNoNumber.
  Name name(uint32_t number) const { return number == kNoNumber ? Name{} : names[number]; }
  uint32_t add_name(const Name& name);
  // The attribute of that name, or null.
  const Attribute* find_attribute(Range32 of, std::string_view name) const;
  // Is `scope` inside a namespace?
  bool in_namespace(ScopeId scope) const { return scope.valid() && !(*this)[scope].name.empty(); }
};

// For `stc dump --tree` and golden tests.
std::string print(const Tree& tree);

}  // namespace frontend
