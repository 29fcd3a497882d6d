// The syntax tree of one compilation: what the sources say, nothing resolved.
// One Tree owns all nodes of all files in flat stores; nodes refer to each other
// by id and to text by views into the SourceMap, which must outlive the tree.
// Immutable once parsing ends. Later languages (ladder, FBD, SFC, IL) lower to
// the same nodes. Damaged input still gives a tree: kError nodes stand where
// nothing could be understood, and a diagnostic was reported for each.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/ids.h"
#include "base/source.h"
#include "ir/types/types.h"

namespace frontend {

struct ExprTag;
struct StmtTag;
struct SpecTag;
using ExprId = base::Id<ExprTag>;
using StmtId = base::Id<StmtTag>;
using SpecId = base::Id<SpecTag>;

struct Name {
  std::string_view text;
  base::SourceSpan span;
  bool empty() const { return text.empty(); }
};

// --- expressions -------------------------------------------------------------
enum class ExprKind : uint8_t {
  kError,
  kLiteral,     // literal
  kName,        // name
  kQualified,   // prefix#name : typed enumeration literal; name, prefix
  kMember,      // operand . name
  kBit,         // operand . number, operand.%X3 %B1 %W1 %D0: bit_size, number
  kIndex,       // operand [ list ]
  kDeref,       // operand ^
  kCall,        // operand ( args )
  kUnary,       // op operand
  kBinary,      // operand op right
  kDirect,      // %IX0.0 : address; "" text kept in name
  kArrayInit,   // [ list ] of values and kRepeat
  kRepeat,      // operand ( list ) : operand = count
  kStructInit,  // ( args ) with names
};

enum class UnaryOp : uint8_t { kNegate, kPlus, kNot };
enum class BinaryOp : uint8_t {
  kOr,
  kOrElse,
  kXor,
  kAnd,
  kAndThen,
  kEq,
  kNe,
  kLt,
  kLe,
  kGt,
  kGe,
  kAdd,
  kSub,
  kMul,
  kDiv,
  kMod,
  kPower,
};

enum class LiteralKind : uint8_t {
  kInteger,   // integer; based: written 2# 8# 16#
  kReal,      // real
  kBool,      // integer 0/1 (TRUE, FALSE)
  kString,    // text, escapes resolved
  kWstring,   // text, UTF-16LE bytes
  kDuration,  // integer = ns
  kDate,
  kTimeOfDay,
  kDateAndTime,  // integer = ns
};

struct Literal {
  LiteralKind kind = LiteralKind::kInteger;
  bool based = false;
  bool too_large = false;  // does not fit 64 bits (already reported)
  bool is_long = false;    // LT# LD# LTOD# LDT#
  Name prefix;             // "INT" of INT#5, "WORD" of WORD#16#AF; empty when untyped
  uint64_t integer = 0;    // magnitude; a sign inside a typed literal sets `negative`
  bool negative = false;
  double real = 0;
  std::string text;
};

struct Arg {
  Name name;             // empty: positional
  bool output = false;   // name => expr
  bool negated = false;  // NOT name => expr
  ExprId value;          // invalid: `name :=` or `name =>` with nothing behind it
  base::SourceSpan span;
};

struct Range32 {  // slice of one of the Tree's lists
  uint32_t first = 0;
  uint32_t count = 0;
};

struct Expr {
  ExprKind kind = ExprKind::kError;
  uint16_t height =
      1;  // of the tree below, at most kMaxExpressionHeight: recursion over it is safe
  base::SourceSpan span;
  UnaryOp unary = UnaryOp::kNegate;
  BinaryOp binary = BinaryOp::kOr;
  base::SourceSpan op_span;
  ExprId operand;
  ExprId right;
  Name name;
  Name prefix;
  uint32_t literal = 0;  // Tree::literals
  Range32 list;          // Tree::expr_lists
  Range32 args;          // Tree::args
  uint32_t number = 0;   // kBit
  uint8_t bit_size = 1;  // kBit: 1, 8, 16, 32
  ir::DirectAddress address;
  bool parenthesised = false;
};

// --- statements --------------------------------------------------------------
enum class StmtKind : uint8_t {
  kError,
  kEmpty,
  kAssign,  // target := value
  kCall,    // value is the kCall expression
  kIf,      // branches; else_body
  kCase,    // value, cases, else_body
  kFor,     // target, from, to, by (may be invalid), body
  kWhile,   // value, body
  kRepeat,  // body, value
  kExit,
  kContinue,
  kReturn,
};

struct Branch {  // IF / ELSIF
  ExprId condition;
  Range32 body;  // Tree::stmt_lists
};
struct CaseLabel {
  ExprId low;
  ExprId high;  // invalid: single value
};
struct CaseArm {
  Range32 labels;  // Tree::labels
  Range32 body;
  base::SourceSpan span;
};

struct Stmt {
  StmtKind kind = StmtKind::kEmpty;
  base::SourceSpan span;  // kFor..kIf: of the head line
  ExprId target;
  ExprId value;
  ExprId from, to, by;
  Range32 branches;  // Tree::branches
  Range32 cases;     // Tree::cases
  Range32 body;      // Tree::stmt_lists
  Range32 else_body;
  bool has_else = false;
};

// --- types and variables -----------------------------------------------------
enum class SpecKind : uint8_t {
  kError,
  kNamed,     // name (elementary or declared)
  kString,    // length (may be invalid); wide
  kArray,     // dims, element
  kStruct,    // fields
  kEnum,      // enumerators; element = base type (may be invalid)
  kSubrange,  // element, low, high
};

struct DimSpec {
  ExprId low;
  ExprId high;
};
struct Enumerator {
  Name name;
  ExprId value;  // may be invalid
};

struct VarDecl {
  std::vector<Name> names;  // several share one spec
  SpecId spec;
  ExprId init;  // may be invalid
  bool has_address = false;
  ir::DirectAddress address;  // AT %QX0.0
  base::SourceSpan span;
};

struct Spec {
  SpecKind kind = SpecKind::kError;
  base::SourceSpan span;
  Name name;
  bool wide = false;
  ExprId length;
  SpecId element;
  ExprId low, high;
  std::vector<DimSpec> dims;
  std::vector<VarDecl> fields;
  std::vector<Enumerator> enumerators;
};

enum class VarSection : uint8_t {
  kLocal,
  kInput,
  kOutput,
  kInOut,
  kTemp,
  kExternal,
  kGlobal,
};

struct VarBlock {
  VarSection section = VarSection::kLocal;
  bool constant = false;
  bool retain = false;  // RETAIN or PERSISTENT
  base::SourceSpan span;
  std::vector<VarDecl> vars;
};

// --- declarations ------------------------------------------------------------
struct TypeDecl {
  Name name;
  SpecId spec;
  ExprId init;  // default of a derived type
};

enum class PouKind : uint8_t { kFunction, kFunctionBlock, kProgram };

struct PouDecl {
  PouKind kind = PouKind::kFunction;
  Name name;
  SpecId result;  // functions; may be invalid
  std::vector<VarBlock> blocks;
  Range32 body;           // Tree::stmt_lists
  base::SourceSpan span;  // PROGRAM ... END_PROGRAM
};

struct TaskDecl {
  Name name;
  ExprId interval;  // may be invalid
  ExprId priority;
  ExprId single;
  base::SourceSpan span;
};

struct ProgramDecl {  // PROGRAM p WITH t : T(...)
  Name name;
  Name task;  // may be empty
  Name type;
  Range32 args;
  base::SourceSpan span;
};

struct ResourceDecl {
  Name name;
  std::vector<VarBlock> globals;
  std::vector<TaskDecl> tasks;
  std::vector<ProgramDecl> programs;
};

struct ConfigDecl {
  Name name;
  std::vector<VarBlock> globals;
  std::vector<ResourceDecl> resources;  // a single unnamed one when RESOURCE is left out
  base::SourceSpan span;
};

struct Tree {
  std::vector<Expr> exprs;
  std::vector<Stmt> stmts;
  std::vector<Spec> specs;
  std::vector<Literal> literals;
  std::vector<Arg> args;
  std::vector<Branch> branches;
  std::vector<CaseArm> cases;
  std::vector<CaseLabel> labels;
  std::vector<ExprId> expr_lists;
  std::vector<StmtId> stmt_lists;

  std::vector<TypeDecl> types;
  std::vector<PouDecl> pous;
  std::vector<VarBlock> globals;  // VAR_GLOBAL outside CONFIGURATION
  std::vector<ConfigDecl> configs;

  const Expr& operator[](ExprId id) const { return exprs[id.index]; }
  const Stmt& operator[](StmtId id) const { return stmts[id.index]; }
  const Spec& operator[](SpecId id) const { return specs[id.index]; }
};

// For `stc dump --tree` and golden tests.
std::string print(const Tree& tree);

}  // namespace frontend
