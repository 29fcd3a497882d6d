// Instruction lists: rows -> instructions.
#include "frontend/parse/instruction_list.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

bool Parser::at_instruction_list() const {
  IlTokens tokens{first_, static_cast<size_t>(last_ - first_) + 1, text_, base_};
  return tokens.is_instruction_list(static_cast<size_t>(current_ - first_));
}

bool Parser::at_instruction(size_t ahead) const {
  IlTokens tokens{first_, static_cast<size_t>(last_ - first_) + 1, text_, base_};
  return tokens.is_instruction(static_cast<size_t>(current_ - first_) + ahead);
}

// `in := (LD a AND b)`: simple instructions compute the argument.
bool Parser::at_instruction_argument() const {
  return in_instructions_ && kind() == TokenKind::kLeftParen && at_instruction(1);
}

void Parser::InstructionList::body() {
  bool outer = p_.in_instructions_;
  p_.in_instructions_ = true;
  while (!p_.list_ends(false)) instruction();
  if (!parentheses_.empty()) report_unclosed(p_.current_->span());
  close_parentheses();
  p_.in_instructions_ = outer;
  expand();
}

ExprId Parser::InstructionList::argument() {
  const Token open = p_.take();
  ExprId value = value_alone(open);
  p_.close_bracket(TokenKind::kRightParen, open);
  return value;
}

ExprId Parser::InstructionList::condition(const Token& opening) {
  bool outer = p_.in_instructions_;
  p_.in_instructions_ = true;
  ExprId value = value_alone(opening);
  p_.in_instructions_ = outer;
  return value;
}

// What the instructions up to a parenthesis that they did not open, or an END_x, leave.
ExprId Parser::InstructionList::value_alone(const Token& opening) {
  value_only_ = true;
  Nesting nesting(p_);
  if (!nesting.entered()) return p_.error_expression();
  while (p_.kind() != TokenKind::kEnd && !is_statement_boundary(p_.kind())) {
    if (p_.kind() == TokenKind::kRightParen && parentheses_.empty()) break;
    instruction();
  }
  if (!parentheses_.empty()) report_unclosed(p_.current_->span());
  close_parentheses();
  expand();
  Instruction end;
  end.word = p_.name_of(opening);
  end.span = opening.span();
  return use(end, true);
}

// One row, or a part of it: a label, an operator with its parenthesis, a closing parenthesis.
void Parser::InstructionList::instruction() {
  const Token first = *p_.current_;
  if (is_name(first.kind) && p_.next_kind() == TokenKind::kColon) return read_label();
  Instruction in;
  in.word = p_.name_of(first);
  if (first.kind == TokenKind::kRightParen && !parentheses_.empty()) {
    p_.take();
    parentheses_.pop_back();
    in.kind = Kind::kClose;
  } else if (p_.accept(TokenKind::kSemicolon)) {
    p_.note_only(Code::kBadInstruction, first.span(),
                 "an instruction ends with its row, not with `;`", "remove it");
    return;
  } else if (is_var_start(first.kind) || is_statement_keyword(first.kind) ||
             (is_name(first.kind) && p_.next_kind() == TokenKind::kAssign)) {
    return structured_text();
  } else if (const IlOperator* op = find_il_operator(in.word.text);
             op != nullptr && (p_.next_kind() != TokenKind::kDot)) {
    in.kind = Kind::kOperator;
    in.op = op;
    p_.take();
    read_operator(in);
  } else if (is_name(first.kind)) {
    read_function(in);
  } else {
    p_.report_here(Code::kBadInstruction,
                   "an instruction begins with its operator, found " + p_.describe(first),
                   "write LD, ST, AND, ... and after it the operand");
    p_.take();
  }
  finish_row(in);
}

void Parser::InstructionList::read_label() {
  Instruction in;
  in.kind = Kind::kLabel;
  in.word = p_.name_of(p_.take());
  in.span = in.word.span;
  p_.take();
  if (!forbidden(in)) add(in);
  p_.panic_ = false;
}

// `&N` is two tokens, side by side, and more in the row.
void Parser::InstructionList::read_operator(Instruction& in) {
  if (in.word.text == "&" && p_.is_word(*p_.current_, "N") && p_.last_end() == p_.here()) {
    base::SourcePos begin = in.word.span.begin;
    const Token letter = p_.take();
    if (row_ended() || p_.kind() == TokenKind::kRightParen) {
      --p_.current_;  // the operand is named N
    } else {
      in.op = find_il_operator("&N");
      in.word.span = {begin, letter.span().end};
      in.word.text = p_.text_.substr(begin.offset - p_.base_, 2);
    }
  }
  if (forbidden(in)) return;
  switch (in.op->action) {
    case IlAction::kNot:
    case IlAction::kReturn:
      return;
    case IlAction::kJump:
      in.target = row_ended() ? Name{} : p_.parse_name("label");
      if (in.target.empty() && !p_.panic_) operand();  // reports
      return;
    case IlAction::kCall:
      return read_call_target(in);
    case IlAction::kBinary:
      if (p_.kind() == TokenKind::kLeftParen && !row_ended()) return read_parenthesis(in);
      break;
    default:
      break;
  }
  in.operand = operand();
}

// `AND( a` is short for `AND(` and `LD a`.
void Parser::InstructionList::read_parenthesis(Instruction& in) {
  const Token open = p_.take();
  parentheses_.push_back(open);
  in.kind = Kind::kOpen;
  bool loads = !row_ended() && !p_.at_instruction(0) && p_.kind() != TokenKind::kRightParen;
  if (!loads) return;
  in.span = {in.word.span.begin, open.span().end};
  Instruction load;
  load.kind = Kind::kOperator;
  load.op = find_il_operator("LD");
  load.word = {in.word.text, in.word.span};
  load.operand = operand();
  load.span = p_.span_from(tree_[load.operand].span.begin);
  add(in);
  in = load;
}

// A function with the current result as first argument, or a complete call.
void Parser::InstructionList::read_function(Instruction& in) {
  TokenKind next = p_.next_kind();
  const Token& behind = p_.peek(1);
  bool variable = next == TokenKind::kLeftParen || next == TokenKind::kDot ||
                  next == TokenKind::kLeftBracket || next == TokenKind::kCaret;
  p_.take();
  bool same_row = !p_.on_new_line();
  --p_.current_;
  if (variable && same_row) {
    in.operand = p_.parse_variable();
    in.kind = Kind::kCall;
    if (p_.panic_) return;
    Expr& call = tree_.exprs[in.operand.index];
    call.instruction = true;
    if (call.kind == ExprKind::kCall) {
      tree_.exprs[call.operand.index].instruction = true;
      return;
    }
    if (call.kind == ExprKind::kMember) {  // Lib.f
      in.kind = Kind::kFunction;
      in.others = operands();
      return;
    }
    p_.report(Code::kBadInstruction, behind.span(),
              "an instruction begins with its operator, and a variable is none",
              "write LD in front of it to load it");
    return;
  }
  in.kind = Kind::kFunction;
  p_.take();
  in.others = operands();
}

// CAL instance, CAL instance(arguments)
void Parser::InstructionList::read_call_target(Instruction& in) {
  in.operand = operand();
  if (p_.panic_ || tree_[in.operand].kind == ExprKind::kCall) return;
  Expr call;
  call.kind = ExprKind::kCall;
  call.operand = in.operand;
  call.span = tree_[in.operand].span;
  call.op = call.span.begin;
  in.operand = p_.add_expression(call);
}

// A variable or a literal, perhaps with a sign.
ExprId Parser::InstructionList::operand() {
  if (row_ended() || p_.kind() == TokenKind::kRightParen) {
    base::SourcePos end = p_.last_end();
    p_.report(Code::kBadInstruction, {end, {end.offset + 1}},
              "the operand of " + p_.describe(p_.current_[-1]) + " is missing",
              "write it in the same row");
    return p_.error_expression();
  }
  bool bracket = p_.kind() == TokenKind::kLeftParen || p_.kind() == TokenKind::kLeftBracket;
  if (!bracket && p_.kind() != TokenKind::kNot) return p_.parse_unary();
  p_.report_here(Code::kBadInstruction,
                 "an operand is a variable or a literal, found " + p_.describe(*p_.current_),
                 "compute it with instructions of its own");
  return p_.error_expression();
}

Range32 Parser::InstructionList::operands() {
  size_t mark = p_.expr_stack_.size();
  if (!row_ended() && p_.kind() != TokenKind::kRightParen) {
    do {
      p_.expr_stack_.push_back(operand());
    } while (!p_.panic_ && p_.accept(TokenKind::kComma));
  }
  return move_tail(p_.expr_stack_, mark, tree_.expr_lists);
}

bool Parser::InstructionList::row_ended() const {
  return p_.on_new_line() || p_.kind() == TokenKind::kEnd || is_statement_boundary(p_.kind());
}

// Inside of parentheses values are computed: nothing is jumped to or called there.
bool Parser::InstructionList::forbidden(const Instruction& in) {
  IlAction action = in.kind == Kind::kLabel ? IlAction::kJump : in.op->action;
  bool flow = action == IlAction::kJump || action == IlAction::kCall || action == IlAction::kReturn;
  bool value = action == IlAction::kLoad || action == IlAction::kBinary || action == IlAction::kNot;
  if (flow && !parentheses_.empty()) {
    report_unclosed(in.word.span);
    close_parentheses();
    return false;
  }
  if (!value_only_ || value) return false;
  p_.report(Code::kBadInstruction, in.word.span,
            "only values are computed in an argument or condition",
            "put the instruction in front of it");
  return true;
}

// The rest of the body is skipped: it may be of either language.
void Parser::InstructionList::structured_text() {
  p_.report_here(Code::kBadInstruction,
                 "a statement of Structured Text stands in an instruction list",
                 "write the whole body in one of the two languages");
  p_.panic_ = false;
  Instruction in;
  in.span = p_.take().span();
  add(in);
  while (p_.kind() != TokenKind::kEnd && !is_pou_end(p_.kind()) && !is_member_end(p_.kind()) &&
         !is_file_level_start(p_.kind()) && !p_.at_member()) {
    p_.take();
  }
}

void Parser::InstructionList::close_parentheses() {
  for (; !parentheses_.empty(); parentheses_.pop_back()) {
    Instruction in;
    in.kind = Kind::kClose;
    in.word = p_.name_of(parentheses_.back());
    in.span = in.word.span;
    add(in);
  }
}

// At the parenthesis, whose place is certain.
void Parser::InstructionList::report_unclosed(base::SourceSpan where) {
  base::Diagnostic diagnostic{Code::kUnclosedBracket,
                              parentheses_.back().span(),
                              "`)` is missing for this parenthesis",
                              "write `)` in a row of its own after the last instruction inside",
                              {}};
  diagnostic.notes.push_back({where, "it was expected before this"});
  if (!p_.panic_) p_.diagnostics_.add(std::move(diagnostic));
}

void Parser::InstructionList::finish_row(const Instruction& read) {
  Instruction in = read;
  bool goes_on = in.kind == Kind::kOpen || p_.kind() == TokenKind::kRightParen ||
                 p_.kind() == TokenKind::kSemicolon || row_ended();
  bool inside = value_only_ || !parentheses_.empty();  // there several may share a row
  if (!goes_on && !p_.panic_ && !(inside && p_.at_instruction(0))) {
    bool text = p_.at_operator();
    p_.report_here(Code::kBadInstruction,
                   "an instruction ends with its row, found " + p_.describe(*p_.current_),
                   text ? "give every operator an instruction of its own" : "begin a new row");
  }
  if (p_.panic_) {
    if (in.kind != Kind::kClose) in.kind = Kind::kDamaged;
    while (!row_ended() && !(value_only_ && p_.kind() == TokenKind::kRightParen)) p_.take();
    p_.panic_ = false;
  }
  if (!in.span.begin.valid()) in.span = p_.span_from(in.word.span.begin);
  add(in);
}

}  // namespace frontend
