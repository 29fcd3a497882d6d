// Inside of the parser: one recursive-descent class whose members are spread over
// the files named below, one file per group of constructs.
//
// Recovery: report() raises `panic_`, further reports are swallowed until the
// enclosing statement or declaration has skipped to its end and lowered it. So
// one mistake gives one message. note_only() reports without panic, where it is
// clear how to go on. Depth is counted by Nesting; every loop takes a token or ends.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/limits.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/literals.h"
#include "frontend/parse/tree.h"

namespace frontend {

class Parser {
 public:
  Parser(const base::SourceMap& sources, uint32_t file, const TokenList& tokens, Tree& tree,
         base::Diagnostics& diagnostics, const DeclarationIndex* declarations);

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
  bool accept(TokenKind wanted) {
    if (kind() != wanted) return false;
    take();
    return true;
  }
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
  base::SourcePos last_end() const {
    if (current_ == first_) return here();
    return {current_[-1].begin + current_[-1].length};
  }
  base::SourceSpan span_from(base::SourcePos begin) const { return {begin, last_end()}; }
  bool on_new_line() const;  // is the current token the first of its line?
  std::string describe(const Token& token) const;
  static std::string with_article(const char* noun);  // "an action"

  // --- messages and recovery: recovery.cc
  void report(Code code, base::SourceSpan span, std::string text, std::string fix = {});
  void note_only(Code code, base::SourceSpan span, std::string text, std::string fix = {});
  void report_here(Code code, std::string text, std::string fix = {});
  void report_missing_end(const Token& opening, TokenKind end, std::string fix = {});
  bool has_open_string(const Token& opening) const;
  void report_problem(const LiteralProblem& problem, const Token& token);
  void report_missing_semicolon(const char* what);
  bool swallowed_by_string() const;
  bool swallowed_by_comment() const;
  void not_supported(base::SourceSpan span, const std::string& what, std::string fix = {});
  void skip_to_statement_end();
  void skip_to_declaration_end();
  void skip_to(TokenKind wanted);  // within the statement
  void skip_past(TokenKind end);   // a construct that is not supported
  void skip_block(TokenKind end);  // the same, but not out of the POU

  // --- content.cc
  ir::SourceContent content_of(const Token* first, const PouDecl& pou,
                               std::span<const Token> head = {}) const;

  // --- attributes.cc
  Range32 take_attributes();
  void add_attribute(base::SourceSpan span);
  void report_lost_rule(base::SourceSpan span);
  void report_lost_rules();  // those after the last declaration
  Range32 join_attributes(Range32 a, Range32 b);

  class Nesting;
  // False, after a report, when nested too deeply.
  bool enter() { return ++depth_ <= base::kMaxNesting || report_too_deep(); }
  bool report_too_deep();

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
  bool at_operator() const;  // a binary one
  ExprId parse_parenthesised();
  ExprId parse_global_name();
  ExprId parse_type_argument();
  bool at_type_argument() const;
  std::string step_fix() const;
  ExprId parse_operator_call();
  ExprId error_expression();
  ExprId add_expression(const Expr& expr);
  ExprId add_binary(ExprId left, const Token& op, ExprId right);
  uint32_t height_below(const Expr& expr) const;
  uint32_t height(ExprId id) const { return id.valid() ? tree_[id].height : 0; }

  // --- postfix.cc
  ExprId parse_variable();  // name or direct address with everything after it
  ExprId parse_postfix(ExprId operand);
  ExprId parse_member(ExprId operand);
  void set_direct(Expr& expr, const Token& token);
  bool at_process_address() const;
  ExprId parse_index(ExprId operand);
  ExprId parse_call(ExprId operand);
  Range32 parse_arguments();
  Arg parse_argument();
  void close_bracket(TokenKind close, const Token& open);

  // --- literal.cc
  ExprId parse_literal(const Name& prefix, base::SourcePos begin, bool negative);
  ExprId parse_typed_literal();
  Name prefix_of(const Token& token) const;
  ExprId add_literal(const Literal& literal, base::SourceSpan span);
  void decode_literal(const Token& token, Literal& literal);
  StringCharset charset_of(const Literal& literal);
  void decode_date_literal(const Token& token, Literal& literal);
  void store_time(const DecodedTime& time, const Token& token, Literal& literal);
  DecodedAddress parse_direct_address(const Token& token);
  Range32 add_levels(const std::vector<uint32_t>& levels);

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
  void parse_jump(StmtKind statement);
  void finish_statement(const char* what);
  bool list_ends(bool in_case);
  bool report_stray_end();
  void add_statement(Stmt stmt) {
    statement_stack_.push_back(StmtId(static_cast<uint32_t>(tree_.stmts.size())));
    tree_.stmts.push_back(stmt);
  }

  // --- assignment.cc
  std::optional<AssignOp> assign_op_here() const;
  void take_assign_op();
  void parse_assignment(ExprId target, AssignOp op, base::SourcePos begin);
  ExprId parse_assigned();
  ExprId parse_assign_expression(ExprId target, AssignOp op);
  ExprId parse_listed_value();
  bool at_member_list() const;

  // --- jump.cc
  bool parse_soft_statement();
  void reject_label();
  void parse_label();
  void parse_jump_to_label();
  void parse_try();
  ExprId parse_catch_variable();
  void parse_mock();
  bool at_mock_function_block() const;

  // --- control.cc
  void parse_if();
  base::SourcePos parse_branch();
  void parse_for();
  void parse_while();
  void parse_repeat_loop();
  void parse_head(TokenKind keyword, const char* where);  // THEN, DO, OF
  Range32 parse_body(TokenKind end);
  void close_statement(const Token& opening, TokenKind end);

  // --- il.cc
  class InstructionList;
  bool at_instruction_list() const;
  bool at_instruction_argument() const;
  bool at_instruction(size_t ahead) const;

  // --- results.cc
  ExprId add_result(base::SourceSpan span, bool at_label);
  void set_values(ExprId result, const std::vector<ExprId>& values);
  ExprId copy_of(ExprId result, base::SourceSpan span);
  ExprId negated(ExprId operand, base::SourceSpan span);

  // --- diagram*.cc, diagram_body.cc
  class Diagram;
  bool at_diagram() const;
  void parse_diagram(PouDecl& pou);
  void report_mixed_body();
  bool skip_stray_diagram();
  void move_memory(PouDecl& action, PouDecl& owner);

  // --- case.cc
  void parse_case();
  void parse_case_arm();
  Range32 parse_case_labels();
  bool at_case_label() const;

  // --- types.cc
  void parse_types(Range32 attributes);
  void parse_type(Range32 attributes);
  SpecId parse_spec();
  SpecId parse_type_name();  // A.B.Name
  SpecId parse_named_spec(bool type_level);
  bool at_subrange() const;
  void parse_qualified(Range32& qualifiers, Name& name);
  void parse_init_arguments(SpecId named);
  Range32 parse_element_arguments();
  SpecId parse_string_spec();
  SpecId parse_array_spec();
  SpecId parse_subrange(SpecId base, base::SourcePos begin);
  bool at_reference() const;
  SpecId parse_reference(SpecKind reference);
  SpecId add_spec(Spec spec);
  // A long list takes room for the rest of the file, as if that went on like this: doubling it
  // would hold up to three times what it needs.
  template <class T>
  void make_room_for_one(std::vector<T>& list) const {
    constexpr size_t kLong = 1 << 16;
    if (list.size() < list.capacity() || list.size() < kLong) return;
    const auto read = static_cast<size_t>(current_ - first_ + 1);
    const auto left = static_cast<size_t>(last_ - current_);
    const size_t more = list.size() * (left + left / 16) / read;
    list.reserve(list.size() + std::clamp(more, list.size() / 8, list.size()));
  }
  SpecId error_spec(base::SourcePos begin);

  // --- aggregates.cc
  SpecId parse_enum(SpecId base, base::SourcePos begin);
  Enumerator parse_enumerator();
  SpecId parse_struct();  // also UNION
  bool at_enumerators() const;

  // --- variables.cc
  bool at_var_block() const;
  void parse_var_block(std::vector<VarBlock>& blocks, Range32 attributes);
  void parse_qualifiers(VarBlock& block);
  void parse_variables(VarBlock& block, const Token& opening);
  void parse_access_path();      // VAR_ACCESS
  void parse_config_variable();  // VAR_CONFIG
  bool variables_end();
  bool end_var_ahead();
  // Declares names : type := value; onto the stack when anything usable was found.
  void parse_variable_declaration();
  base::SlimVector<VarDecl> take_variables(size_t mark);
  void parse_location(VarDecl& decl);
  Edge parse_edge();
  void parse_default(ExprId& init, bool* binds = nullptr);
  void finish_declaration(const char* what);

  // --- pou.cc
  std::optional<PouKind> pou_kind_here() const;
  bool at_soft_declaration() const;
  PouDecl parse_pou(PouKind pou_kind, Range32 attributes);
  void parse_pou_header(PouDecl& pou);
  void parse_specifiers(PouDecl& pou);
  bool at_inheritance() const;
  void parse_inheritance(PouDecl& pou);
  void parse_pou_variables(PouDecl& pou);
  bool parse_inner(PouDecl& pou);
  void parse_pou_body(PouDecl& pou);
  void close_pou(const Token& opening, const PouDecl& pou, TokenKind end);

  // --- chart.cc
  bool at_chart_element() const;
  bool parse_chart_element(PouDecl& pou);
  bool skip_stray_chart_element();
  void parse_step(Chart& chart);
  bool step_ends() const;
  void parse_action_use(ChartStep& step);
  void parse_qualifier(ActionUse& use);
  void parse_action_time(ActionUse& use, const Name& word);
  void parse_transition(Chart& chart);
  void parse_transition_head(ChartTransition& transition);
  void parse_transition_condition(ChartTransition& transition);
  void parse_step_names(std::vector<Name>& out);
  void finish_chart(PouDecl& pou);
  void take_actions(PouDecl& pou);

  // --- member.cc
  static bool takes_members(PouKind kind);
  bool test_ends_later();
  bool pass_misplaced(const PouDecl& pou);
  bool at_member() const;
  void parse_member(PouDecl& owner, Range32 attributes);
  void parse_property(PouDecl& owner, Range32 attributes);
  bool at_accessor() const;
  bool parse_accessor(const PouDecl& head, std::span<const Token> said, PouDecl& owner,
                      size_t first);

  // --- configuration.cc
  void parse_configuration(Range32 attributes);
  void parse_configuration_item(ConfigDecl& config);
  void parse_resource(ConfigDecl& config);
  bool parse_resource_item(ResourceDecl& resource);
  TaskDecl parse_task();
  void parse_task_parameter(TaskDecl& task);
  ProgramDecl parse_program_instance();
  void parse_program_connections(ProgramDecl& program);
  ResourceDecl& unnamed_resource(ConfigDecl& config);

  // --- declaration.cc
  void parse_declaration();
  void open_scope(const Name& name, bool internal);
  void parse_file_pou(PouKind pou_kind, Range32 attributes);
  void parse_outside_member(Range32 attributes);
  void parse_namespace();
  bool open_namespaces();
  void parse_using(std::vector<Range32>& out);
  Range32 parse_path(const char* what);
  void skip_to_next_declaration();

  std::string_view text_;
  uint32_t base_;
  const TokenList& list_;
  const DeclarationIndex* declarations_;  // of all sources; null: not known
  const Token* first_;
  const Token* current_;
  const Token* last_;
  const Token* var_scan_end_;  // see end_var_ahead()
  const Token* test_end_;      // the END_TEST that test_ends_later() has found
  Tree& tree_;
  base::Diagnostics& diagnostics_;
  static constexpr uint32_t kNoOwner = 0xffffffffu;
  bool panic_ = false;
  Diagram* wires_ = nullptr;  // in one of its expressions that has wires
  bool type_level_ = false;   // the specification begins that a TYPE declares
  bool in_property_ = false;  // GET and SET begin accessors
  bool in_instructions_ = false;
  uint32_t depth_ = 0;
  size_t next_pragma_ = 0;
  ScopeId scope_;
  uint32_t owner_ = kNoOwner;           // the POU that a member after it belongs to
  const PouDecl* member_of_ = nullptr;  // the owner of what parse_member() reads
  std::array<uint16_t, 256> open_{};    // open statements, by the TokenKind of their end

  // Lists under construction; nested constructs work above their opener's mark.
  std::vector<ExprId> expr_stack_;
  std::vector<StmtId> statement_stack_;
  std::vector<Arg> arg_stack_;
  std::vector<Branch> branch_stack_;
  std::vector<CaseArm> case_stack_;
  std::vector<CaseLabel> label_stack_;
  std::vector<VarDecl> var_stack_;
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
