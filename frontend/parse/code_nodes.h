// The nodes of code: expressions, literals, statements. They live in the stores of a
// Tree (tree.h) and are named by ids; slices are of the store that their comment names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/ids.h"
#include "base/source.h"
#include "ir/types/types.h"

namespace frontend {

struct ExprTag;
struct StmtTag;
struct SpecTag;
struct ScopeTag;
using ExprId = base::Id<ExprTag>;
using StmtId = base::Id<StmtTag>;
using SpecId = base::Id<SpecTag>;
using ScopeId = base::Id<ScopeTag>;

struct Name {
  std::string_view text;
  base::SourceSpan span;
  bool empty() const { return text.empty(); }
};

struct Range32 {  // slice of one of the Tree's lists
  uint32_t first = 0;
  uint32_t count = 0;
};

struct Attribute {  // names are compared without case
  Name name;
  bool has_value = false;
  std::string_view value;  // between the quotes, escapes as written
  bool marked = false;     // {migration of := 'T', inverse}
  std::string_view part;   // {renamed '.part' from := 'old'}
};

// --- expressions -------------------------------------------------------------
enum class ExprKind : uint8_t {
  kError,
  kLiteral,     // literal
  kName,        // name; `global`: `.name`, looked up among the globals only
  kQualified,   // prefix#name : typed enumeration literal; name, prefix; operand: Lib of Lib.E#a
  kMember,      // operand . name
  kBit,         // operand . number, operand.%X3 %B1 %W1 %D0: bit_size, number
  kIndex,       // operand [ list ]
  kDeref,       // operand ^
  kCall,        // operand ( args )
  kUnary,       // op operand
  kBinary,      // operand op right
  kDirect,      // %IX0.0 : address, levels; its text kept in name; operand: Resource.%IX0.0
  kArrayInit,   // [ list ] of values and kRepeat
  kRepeat,      // operand ( list ) : operand = count
  kStructInit,  // ( args ): names and values; without names as list of FB_Init's arguments
  kThis,        // THIS; `THIS^` is a kDeref of it, `THIS.x` a kMember
  kSuper,       // SUPER; likewise
  kType,        // spec: a type as an argument, __NEW(ARRAY[0..3] OF INT). A plain name is kName
  kAssign,      // operand := right, with `assign`; right-associative: a := b := 3
  kResult,      // what an instruction list keeps of its current result: number in Tree::results
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

enum class AssignOp : uint8_t {
  kAssign,     // :=
  kSet,        // S=   TRUE when the value is TRUE, else unchanged
  kReset,      // R=   FALSE when the value is TRUE, else unchanged
  kReference,  // REF=  binds a REFERENCE TO
  kAttempt,    // ?=   binds what the target's type allows, else NULL
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
  uint32_t number = 0;   // kBit, kResult
  uint8_t bit_size = 1;  // kBit: 1, 8, 16, 32
  ir::DirectAddress address;
  Range32 levels;  // kDirect with more levels than byte.bit: Tree::levels; address then has area
                   // and size only
  SpecId spec;     // kType
  AssignOp assign = AssignOp::kAssign;  // kAssign
  bool global = false;                  // kName
  bool parenthesised = false;
  bool instruction = false;  // kCall, kBinary, kName of a function: of an instruction list
};

// --- statements --------------------------------------------------------------
enum class StmtKind : uint8_t {
  kError,
  kEmpty,
  kAssign,  // target := value, with `assign`; the rest of a chain is a kAssign expression
  kCall,    // value is the kCall expression
  kIf,      // branches; else_body
  kCase,    // value, cases, else_body
  kFor,     // target, from, to, by (may be invalid), body
  kWhile,   // value, body
  kRepeat,  // body, value
  kExit,
  kContinue,
  kReturn,
  kJump,   // JMP name
  kLabel,  // name:
  kTry,    // body; has_catch: catch_body, target = its variable (may be invalid); finally_body
  kMock,   // MOCK target: the instance's body does nothing in this test
  kMockFunction,  // MOCK_FUNCTION target RETURNS value (may be invalid)
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
  AssignOp assign = AssignOp::kAssign;
  Name name;
  bool has_catch = false;
  bool has_finally = false;
  Range32 catch_body;
  Range32 finally_body;
  // Of an instruction list. S and R of an instance are calls: kAssign then has the call in `from`.
  bool instruction = false;
};

}  // namespace frontend
