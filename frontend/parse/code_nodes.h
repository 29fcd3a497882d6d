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
  std::string_view from;   // {migration of := 'T', from := 'S'}
  std::string_view part;   // {renamed '.part' from := 'old'}
};

// --- expressions -------------------------------------------------------------
enum class ExprKind : uint8_t {
  kError,
  kLiteral,
  kName,        // name; `global`: `.name`, looked up among the globals only
  kQualified,   // prefix#name : typed enumeration literal; operand: Lib of Lib.E#a
  kMember,      // operand . name
  kBit,         // operand . number, operand.%X3 %B1 %W1 %D0: bit_size, number
  kIndex,       // operand [ list ]
  kDeref,       // operand ^
  kCall,        // operand ( list )
  kUnary,       // op operand
  kBinary,      // operand op right
  kDirect,      // %IX0.0 : its text kept in name; operand: Resource.%IX0.0
  kArrayInit,   // [ list ] of values and kRepeat
  kRepeat,      // operand ( list ) : operand = count
  kStructInit,  // ( list ): names and values; without names as list of FB_Init's arguments
  kThis,        // THIS; `THIS^` is a kDeref of it, `THIS.x` a kMember
  kSuper,       // SUPER; likewise
  kType,        // a type as an argument, __NEW(ARRAY[0..3] OF INT). A plain name is kName
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

// Expressions, statements and literals are most of a tree, and read all the time: what is seldom
// there is kept beside them.
inline constexpr uint32_t kNoNumber = 0xffffffffu;

struct Literal {
  LiteralKind kind = LiteralKind::kInteger;
  bool based = false;
  bool too_large = false;  // does not fit 64 bits (already reported)
  bool is_long = false;    // LT# LD# LTOD# LDT#
  bool negative = false;
  uint32_t prefix = kNoNumber;  // Tree::names: "INT" of INT#5, "WORD" of WORD#16#AF
  uint32_t text = kNoNumber;    // Tree::texts
  uint64_t integer = 0;         // magnitude; a sign inside a typed literal sets `negative`
  double real = 0;
};
static_assert(sizeof(Literal) == 32);

struct Arg {
  Name name;             // empty: positional
  bool output = false;   // name => expr
  bool negated = false;  // NOT name => expr
  ExprId value;          // invalid: `name :=` or `name =>` with nothing after it
  base::SourceSpan span;
};

struct Direct {  // of kDirect
  ir::DirectAddress address;
  Range32 levels;  // with more levels than byte.bit: Tree::levels; address then has area and size
};

struct Expr {
  ExprKind kind = ExprKind::kError;
  UnaryOp unary = UnaryOp::kNegate;
  BinaryOp binary = BinaryOp::kOr;
  AssignOp assign = AssignOp::kAssign;  // kAssign
  uint8_t bit_size = 1;                 // kBit: 1, 8, 16, 32
  bool global : 1 = false;              // kName
  bool parenthesised : 1 = false;
  bool instruction : 1 = false;  // kCall, kBinary, kName of a function: of an instruction list
  bool open_list : 1 = false;    // kCall: a comma stands behind the last argument
  // The height of the tree below, at most kMaxExpressionHeight: recursion over it is safe.
  uint16_t height = 1;
  base::SourceSpan span;
  base::SourcePos op;  // of the operator, the dot, the bracket
  ExprId operand;
  ExprId right;
  // kBit: of the part. Elsewhere the index of what belongs to it: kLiteral in Tree::literals,
  // kResult in Tree::results, kDirect in Tree::directs, kType in Tree::specs; kQualified: of the
  // prefix, and kCall: of the type that a box of a diagram names, in Tree::names.
  uint32_t number = kNoNumber;
  Range32 list;  // kCall, kStructInit: of Tree::args; kIndex, kArrayInit, kRepeat: Tree::expr_lists
  Name name;

  SpecId spec() const { return SpecId(number); }  // of kType
};
static_assert(sizeof(Expr) == 64);

// --- statements --------------------------------------------------------------
enum class StmtKind : uint8_t {
  kError,
  kEmpty,
  kAssign,  // target := value, with `assign`; the rest of a chain is a kAssign expression
  kCall,    // value is the kCall expression
  kIf,      // arms; else_body
  kCase,    // value, arms, else_body
  kFor,     // target, from, to, by (may be invalid), body
  kWhile,   // value, body
  kRepeat,  // body, value
  kExit,
  kContinue,
  kReturn,
  kJump,   // JMP name
  kLabel,  // name:
  kTry,    // body; has_catch: target = its variable (may be invalid); arms: CATCH's and FINALLY's
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
  AssignOp assign = AssignOp::kAssign;
  bool has_else : 1 = false;
  bool has_catch : 1 = false;
  bool has_finally : 1 = false;
  // Is it part of an instruction list? S and R of an instance are calls: kAssign then has the call
  // in `from`.
  bool instruction : 1 = false;
  base::SourceSpan span;  // kFor..kIf: of the head line
  ExprId target;
  ExprId value;
  ExprId from, to, by;
  Range32 arms;  // kIf, kTry: of Tree::branches; kCase: of Tree::cases
  Range32 body;  // Tree::stmt_lists
  Range32 else_body;
  uint32_t name = kNoNumber;  // Tree::names
};
static_assert(sizeof(Stmt) == 60);

}  // namespace frontend
