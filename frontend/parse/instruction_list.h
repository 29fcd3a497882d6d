// Inside of the parser: instruction lists. il.cc reads the rows of a body into instructions;
// il_expand.cc makes statements of them. The current result stays an expression while only
// one instruction uses it; where several do, or a label takes it over, it becomes a kResult,
// assigned where it was computed. Everything here is syntax: types are sema's.
//
// il_flow.cc says after which instructions the current result is still needed. Cost is linear
// in the instructions.
#pragma once

#include <string>
#include <unordered_map>

#include "frontend/parse/il_operators.h"
#include "frontend/parse/parser.h"

namespace frontend {

class Parser::InstructionList {
 public:
  explicit InstructionList(Parser& parser) : p_(parser), tree_(parser.tree_) {}
  void body();        // adds statements; ends where a list of statements would
  ExprId argument();  // `( LD a AND b )` as the value of an argument
  // `LD a AND b` as the condition of a transition, up to its end.
  ExprId condition(const Token& opening);

 private:
  enum class Kind : uint8_t {
    kOperator,
    kOpen,      // operator and `(`
    kClose,     // its `)`
    kFunction,  // with operands after the current result
    kCall,      // f(x := 1): operand is the call
    kLabel,
    kDamaged,  // reported
  };
  struct Instruction {
    Kind kind = Kind::kDamaged;
    const IlOperator* op = nullptr;
    Name word;  // of kLabel: the label
    ExprId operand;
    Name target;     // of jumps
    Range32 others;  // operands of kFunction; Tree::expr_lists
    base::SourceSpan span;
  };

  // --- il.cc
  ExprId value_alone(const Token& opening);
  void instruction();
  void read_operator(Instruction& in);
  void read_parenthesis(Instruction& in);
  void read_function(Instruction& in);
  void read_call_target(Instruction& in);
  void read_label();
  ExprId operand();
  Range32 operands();
  bool row_ended() const;
  bool forbidden(const Instruction& in);
  void structured_text();
  void close_parentheses();
  void report_unclosed(base::SourceSpan where);
  void finish_row(const Instruction& in);
  void add(const Instruction& in) { list_.push_back(in); }

  // --- il_flow.cc
  enum class Need : uint8_t { kUnknown, kNo, kYes };
  void find_needs();
  static Need need_of(const Instruction& in);
  bool needed_behind(size_t i) const { return needs_[i + 1] == Need::kYes; }

  // --- il_expand.cc
  struct Result {
    enum class State : uint8_t {
      kNone,   // undefined; `why` says since when
      kValue,  // not evaluated yet
      kKept,   // a kResult, or an expression that was reported
    };
    State state = State::kNone;
    bool literal = false;  // kValue: only of literals, so that it may stand in several places
    ExprId value;
    const char* why = "the list begins here";
  };
  struct Label {
    size_t index = 0;  // the instruction
    ExprId result;     // the kResult that it takes over
    bool passed = false;
    std::vector<ExprId> ways;  // from above
  };
  void expand();
  void expand(size_t i);
  void expand_operator(size_t i);
  void store(const Instruction& in, bool last);
  void set(const Instruction& in, bool last);
  void input(const Instruction& in, bool last);
  ExprId input_call(const Instruction& in, ExprId value);
  void apply(const Instruction& in, ExprId left, ExprId right, bool literal);
  void call_function(size_t i);
  void close(size_t i);

  // --- il_jump.cc
  void label(size_t i);
  void jump(size_t i);
  void leave(size_t i);
  void call(size_t i);
  void guard(const Instruction& in, ExprId condition, const std::vector<Stmt>& body);
  void pass_to(const Instruction& in, const Name& label, bool last, std::vector<Stmt>& out);
  Label* find_label(const Name& name);

  // --- il_result.cc
  ExprId use(const Instruction& in, bool last);
  void define(ExprId value, bool literal);
  void undefine(const char* why) { result_ = {Result::State::kNone, false, {}, why}; }
  void damage(base::SourceSpan span);
  void discard();
  void keep(Result& result);
  void keep_result();
  void keep_outer();
  Stmt keep_statement(ExprId result, ExprId value);
  void emit(Stmt stmt);
  bool is_literal(ExprId id) const;
  bool is_plain(ExprId id) const;

  // Beyond it the current result is kept; a list may be longer than an expression is high.
  static constexpr uint32_t kHighest = 200;

  Parser& p_;
  Tree& tree_;
  std::vector<Instruction> list_;
  std::vector<Need> needs_;  // in front of each instruction, and after the last
  std::unordered_map<std::string, Label> labels_;  // by folded name
  std::vector<Token> parentheses_;                 // open while reading
  bool value_only_ = false;                        // inside of an argument or condition
  Result result_;
  bool reachable_ = true;
  std::vector<Result> outer_;  // what stands in front of each open parenthesis
  std::vector<size_t> opens_;  // their instructions
  size_t kept_outer_ = 0;      // so many of outer_ need no keeping
};

}  // namespace frontend
