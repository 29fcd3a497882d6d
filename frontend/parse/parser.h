// Inside of the parser: one recursive-descent class whose members are spread over
// the files named below, one file per group of constructs.
//
// Recovery: report() raises `panic_`, further reports are swallowed until the
// enclosing statement or declaration has skipped to its end and lowered it. So
// one mistake gives one message. note_only() reports without panic, where it is
// clear how to go on. Depth is counted by Nesting; every loop takes a token or ends.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/literals.h"
#include "frontend/parse/tree.h"

namespace frontend {

class Parser {
 public:
  Parser(const base::SourceMap& sources, uint32_t file, const TokenList& tokens, Tree& tree,
         base::Diagnostics& diagnostics);

  void parse_file();  // declaration.cc

 private:
  using Code = base::DiagnosticCode;

  // --- tokens: parser.cc
  TokenKind kind() const { return current_->kind; }
  const Token& peek(size_t ahead) const {
    return static_cast<size_t>(last_ - current_) < ahead ? *last_ : current_[ahead];
  }
  TokenKind next_kind() const { return peek(1).kind; }
  const Token& take() { return current_ == last_ ? *last_ : *current_++; }
  bool accept(TokenKind wanted);
  // Takes `wanted`, or reports that it is missing; `where` continues "expected X".
  bool expect(TokenKind wanted, const char* where);
  std::string_view text(const Token& token) const {
    return text_.substr(token.begin - base_, token.length);
  }
  bool is_word(const Token& token, std::string_view word) const;
  Name name_of(const Token& token) const { return {text(token), token.span()}; }
  // A name, or an empty one after a report; `what` is "variable", "program", ...
  Name parse_name(const char* what);
  base::SourcePos here() const { return {current_->begin}; }
  base::SourcePos last_end() const;
  base::SourceSpan span_from(base::SourcePos begin) const { return {begin, last_end()}; }
  bool on_new_line() const;  // is the current token the first of its line?
  std::string describe(const Token& token) const;

  // --- messages and recovery: recovery.cc
  void report(Code code, base::SourceSpan span, std::string text, std::string fix = {});
  void note_only(Code code, base::SourceSpan span, std::string text, std::string fix = {});
  void report_here(Code code, std::string text, std::string fix = {});
  void report_missing_end(const Token& opening, TokenKind end);
  void report_problem(const LiteralProblem& problem, const Token& token);
  void report_missing_semicolon(const char* what);
  bool swallowed_by_string() const;
  void not_supported(base::SourceSpan span, const std::string& what, std::string fix = {});
  void skip_to_statement_end();
  void skip_to_declaration_end();
  void skip_to(TokenKind wanted);  // within the statement
  void skip_past(TokenKind end);   // a construct that is not supported
  void skip_block(TokenKind end);  // the same, but not out of the POU
  bool skip_unsupported_block();

  class Nesting;
  bool enter();  // false, after a report, when nested too deeply

  template <class T>
  static Range32 move_tail(std::vector<T>& stack, size_t mark, std::vector<T>& store) {
    Range32 range{static_cast<uint32_t>(store.size()), static_cast<uint32_t>(stack.size() - mark)};
    store.insert(store.end(), std::make_move_iterator(stack.begin() + static_cast<long>(mark)),
                 std::make_move_iterator(stack.end()));
    stack.resize(mark);
    return range;
  }

  // --- expression.cc
  ExprId parse_expression();
  ExprId parse_condition();  // the same; understands `:=` for `=`
  ExprId parse_binary(uint32_t above);
  ExprId parse_operators(ExprId left, uint32_t above);
  ExprId parse_unary();
  ExprId parse_primary();
  ExprId parse_parenthesised();
  ExprId parse_operator_call();
  ExprId error_expression();
  ExprId add_expression(const Expr& expr);
  ExprId add_binary(ExprId left, const Token& op, ExprId right);
  uint32_t height_below(const Expr& expr) const;
  uint32_t height(ExprId id) const { return id.valid() ? tree_[id].height : 0; }

  // --- postfix.cc
  ExprId parse_variable();  // name or direct address with everything behind it
  ExprId parse_postfix(ExprId operand);
  ExprId parse_member(ExprId operand);
  ExprId parse_index(ExprId operand);
  ExprId parse_call(ExprId operand);
  Range32 parse_arguments();
  Arg parse_argument();
  void close_bracket(TokenKind close, const Token& open);

  // --- literal.cc
  ExprId parse_literal(const Name& prefix, base::SourcePos begin, bool negative);
  ExprId parse_typed_literal();
  ExprId add_literal(Literal literal, base::SourceSpan span);
  void decode_literal(const Token& token, Literal& literal);
  void decode_date_literal(const Token& token, Literal& literal);
  void store_time(const DecodedTime& time, const Token& token, Literal& literal);
  ir::DirectAddress parse_direct_address(const Token& token);

  // --- initializer.cc
  ExprId parse_initializer();
  ExprId parse_initializer_value();
  ExprId parse_array_initializer();
  ExprId parse_open_array_initializer(ExprId first, base::SourcePos begin);
  ExprId parse_repeat();
  ExprId parse_struct_initializer();

  // --- statement.cc
  Range32 parse_statements(bool in_case = false);
  void parse_statement();
  void parse_simple_statement();
  void finish_simple(ExprId left, base::SourcePos begin);
  void parse_assignment(ExprId target, base::SourcePos begin);
  void parse_jump(StmtKind statement);
  bool parse_unsupported_statement();
  void finish_statement(const char* what);
  bool list_ends(bool in_case);
  bool report_stray_end();
  void add_statement(Stmt stmt) {
    statement_stack_.push_back(StmtId(static_cast<uint32_t>(tree_.stmts.size())));
    tree_.stmts.push_back(stmt);
  }

  // --- control.cc
  void parse_if();
  base::SourcePos parse_branch();
  void parse_for();
  void parse_while();
  void parse_repeat_loop();
  void parse_head(TokenKind keyword, const char* where);  // THEN, DO, OF
  Range32 parse_body(TokenKind end);
  void close_statement(const Token& opening, TokenKind end);

  // --- case.cc
  void parse_case();
  void parse_case_arm();
  Range32 parse_case_labels();
  bool at_case_label() const;

  // --- types.cc
  void parse_types();
  void parse_type();
  SpecId parse_spec();
  SpecId parse_named_spec();
  SpecId parse_string_spec();
  SpecId parse_array_spec();
  SpecId parse_subrange(SpecId base, base::SourcePos begin);
  SpecId unsupported_reference();
  SpecId add_spec(Spec spec);
  SpecId error_spec(base::SourcePos begin);

  // --- aggregates.cc
  SpecId parse_enum(SpecId base, base::SourcePos begin);
  Enumerator parse_enumerator();
  SpecId parse_struct();
  bool at_enumerators() const;

  // --- variables.cc
  bool at_var_block() const;
  void parse_var_block(std::vector<VarBlock>& blocks);
  void parse_qualifiers(VarBlock& block);
  void parse_variables(VarBlock& block, const Token& opening);
  bool variables_end();
  bool end_var_ahead();
  // Declares names : type := value; appends when anything usable was found.
  void parse_variable_declaration(std::vector<VarDecl>& out);
  void parse_location(VarDecl& decl);
  void parse_edge();
  void parse_default(ExprId& init);
  void finish_declaration(const char* what);

  // --- pou.cc
  void parse_pou(PouKind pou_kind, TokenKind end);
  void parse_pou_header(PouDecl& pou);
  void parse_inheritance();
  void skip_access_specifiers();
  void close_pou(const Token& opening, TokenKind end);

  // --- configuration.cc
  void parse_configuration();
  void parse_configuration_item(ConfigDecl& config);
  void parse_resource(ConfigDecl& config);
  bool parse_resource_item(ResourceDecl& resource);
  TaskDecl parse_task();
  void parse_task_parameter(TaskDecl& task);
  ProgramDecl parse_program_instance();
  ResourceDecl& unnamed_resource(ConfigDecl& config);

  // --- declaration.cc
  void parse_declaration();
  void skip_to_next_declaration();

  std::string_view text_;
  uint32_t base_;
  const Token* first_;
  const Token* current_;
  const Token* last_;
  const Token* var_scan_end_;  // see end_var_ahead()
  Tree& tree_;
  base::Diagnostics& diagnostics_;
  bool latin1_;
  bool panic_ = false;
  uint32_t depth_ = 0;
  std::array<uint16_t, 256> open_{};  // open statements, by the TokenKind of their end

  // Lists under construction; nested constructs work above their opener's mark.
  std::vector<ExprId> expr_stack_;
  std::vector<StmtId> statement_stack_;
  std::vector<Arg> arg_stack_;
  std::vector<Branch> branch_stack_;
  std::vector<CaseArm> case_stack_;
  std::vector<CaseLabel> label_stack_;
};

// Counts a level of nesting for as long as it lives.
class Parser::Nesting {
 public:
  explicit Nesting(Parser& parser) : parser_(parser), entered_(parser.enter()) {}
  ~Nesting() { --parser_.depth_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  bool entered() const { return entered_; }

 private:
  Parser& parser_;
  bool entered_;
};

}  // namespace frontend
