// Boxes of a diagram: calls of functions and function blocks.
#include <optional>

#include "frontend/parse/diagram.h"
#include "ir/types/types.h"

namespace frontend {

using network::Kind;
using network::Link;

bool Parser::Diagram::is_result(const Element& element, uint32_t output) const {
  if (!element.operand.empty()) return false;
  for (uint32_t i = 0; i < output; ++i) {
    if (!ir::same_name(element.outputs[i].name, "ENO")) return false;
  }
  return !ir::same_name(element.outputs[output].name, "ENO");
}

// A function block's outputs are read from its instance; a function's are kept.
void Parser::Diagram::block(uint32_t number, const Element& element) {
  bool function = element.operand.empty();
  Expr call;
  call.kind = ExprKind::kCall;
  call.span = element.span;
  call.operand = callee(element);
  Value enable;
  call.list = arguments(number, element, &enable);
  if (!function) call.number = tree_.add_name({made(element.type.text), element.type.span});
  ExprId value = p_.add_expression(call);
  bool result = false;
  for (uint32_t i = 0; i < element.outputs.size(); ++i) {
    if (!is_result(element, i) || outputs_[number][i].uses == 0) continue;
    ExprId kept = keep(value, element.span);
    const Element& user = network_->elements[outputs_[number][i].user];
    if (user.kind == Kind::kSink && !element.outputs[i].negated) {
      tree_.results[tree_[kept].number].target = parse(user.operand, true);
    }
    outputs_[number][i].kept = kept;
    result = true;
  }
  if (!result) {
    Stmt stmt;
    stmt.kind = StmtKind::kCall;
    stmt.value = value;
    emit(stmt, element.span);
  }
  // Power is what the box has given, whatever happens to the instance behind it. What is named by
  // the instance is read where it stands, unless another box of it comes first.
  for (uint32_t i = 0; !element.operand.empty() && i < element.outputs.size(); ++i) {
    Output& output = outputs_[number][i];
    if (output.uses == 0 || output.user <= number || output.kept.valid()) continue;
    if (!ladder_ && next_box_[number] >= output.user) continue;
    const base::SourceSpan user = network_->elements[output.user].span;
    ExprId now = member(parse(element.operand, true), element.outputs[i].name, user);
    output.kept = keep(now, element.span);
  }
  if (enable.expr.valid() && !enable.power) conditions_[number] = enable.expr;
  for (uint32_t i = 0; i < element.outputs.size(); ++i) {
    bool eno = ir::same_name(element.outputs[i].name, "ENO");
    if (eno && outputs_[number][i].kept.valid()) conditions_[number] = outputs_[number][i].kept;
  }
}

ExprId Parser::Diagram::callee(const Element& element) {
  if (!element.operand.empty()) return parse(element.operand);
  if (element.type.text.find('.') != std::string::npos) return parse(element.type);
  return name({made(element.type.text), element.type.span});
}

Range32 Parser::Diagram::arguments(uint32_t number, const Element& element, Value* enable) {
  std::vector<Arg> args;
  std::optional<Arg> en;  // stands behind the others, which may have no names
  for (const network::Input& each : element.inputs) {
    Value value = input(each);
    base::SourceSpan span = each.span.begin.valid() ? each.span : here_;
    if (!value.expr.valid()) continue;
    const bool enables = ir::same_name(each.name, "EN");
    if (enables) {
      if (value.power) continue;  // always
      value.expr = keep(value.expr, span);
      *enable = value;
      value.expr = p_.copy_of(value.expr, span);
    }
    Arg arg;
    arg.span = span;
    if (!each.name.empty()) arg.name = {made(each.name), span};
    arg.value = value.expr;
    if (enables && !en) {
      en = arg;
    } else {
      args.push_back(arg);
    }
  }
  if (en) args.push_back(*en);
  size_t mark = p_.arg_stack_.size();
  for (const Arg& arg : args) p_.arg_stack_.push_back(arg);
  add_eno(number, element);
  if (element.operand.empty()) add_outputs(number, element);
  return move_tail(p_.arg_stack_, mark, tree_.args);
}

void Parser::Diagram::add_eno(uint32_t number, const Element& element) {
  for (uint32_t i = 0; i < element.outputs.size(); ++i) {
    if (!ir::same_name(element.outputs[i].name, "ENO") || outputs_[number][i].uses == 0) continue;
    Arg arg;
    arg.span = element.span;
    arg.name = {"ENO", element.span};
    arg.output = true;
    ExprId kept = new_result(boolean(true, element.span), element.span);
    arg.value = p_.copy_of(kept, element.span);
    outputs_[number][i].kept = kept;
    p_.arg_stack_.push_back(arg);
  }
}

// Outputs of a function beside its result: the call itself writes the variables behind them.
void Parser::Diagram::add_outputs(uint32_t number, const Element& element) {
  for (uint32_t i = 0; i < element.outputs.size(); ++i) {
    bool eno = ir::same_name(element.outputs[i].name, "ENO");
    if (eno || is_result(element, i) || outputs_[number][i].uses == 0) continue;
    if (outputs_[number][i].power) {
      add_power(number, i);
      continue;
    }
    const Element* to = only_sink({number, i});
    const bool late = to != nullptr && !is_right_below(number, *to);
    if (to == nullptr || late) {
      const std::string output =
          "the output `" + element.outputs[i].name + "` of `" + element.type.text + "` ";
      if (late) {
        p_.note_only(Code::kOutputNeedsVariable, to->span,
                     output + "is written by the call, so nothing may stand in between",
                     "write this row right below the box, to a variable of its own");
      } else {
        const bool several = outputs_[number][i].uses > 1;
        p_.note_only(Code::kOutputNeedsVariable, element.span,
                     output + (several ? "goes to more than one place" : "goes to no variable"),
                     "connect it with one variable, and use that elsewhere");
      }
      Expr error;
      error.span = element.span;
      outputs_[number][i].kept = p_.add_expression(error);
      continue;
    }
    Arg arg;
    arg.span = to->span;
    arg.name = {made(element.outputs[i].name), element.span};
    arg.output = true;
    arg.negated = (to->modifier == network::Modifier::kNegated) != element.outputs[i].negated;
    arg.value = parse(to->operand);
    done_[static_cast<size_t>(to - network_->elements.data())] = true;
    p_.arg_stack_.push_back(arg);
  }
}

// Power that leaves by an output beside the result: none while the box does not run.
void Parser::Diagram::add_power(uint32_t number, uint32_t output) {
  const Element& element = network_->elements[number];
  const ExprId kept = p_.add_result(element.span, true);  // a local: the call may not write it
  const ExprId none = boolean(false, element.span);
  p_.set_values(kept, {none});
  emit_assign(p_.copy_of(kept, element.span), none, AssignOp::kAssign, element.span);
  Arg arg;
  arg.span = element.span;
  arg.name = {made(element.outputs[output].name), element.span};
  arg.output = true;
  arg.value = p_.copy_of(kept, element.span);
  outputs_[number][output].kept = kept;
  p_.arg_stack_.push_back(arg);
}

// In a ladder everything but a variable gets power from elsewhere; boxes have it at EN.
bool Parser::Diagram::takes_power(const Element& element, const network::Input& input) const {
  switch (element.kind) {
    case Kind::kContact:
    case Kind::kCoil:
    case Kind::kJump:
    case Kind::kReturn:
      return true;
    case Kind::kBlock:
      return ladder_ || ir::same_name(input.name, "EN");
    default:
      return false;
  }
}

// Is nothing done between the box and the variable behind its output but writing others of its
// outputs, which does not change what variable that is?
bool Parser::Diagram::is_right_below(uint32_t box, const Element& sink) const {
  constexpr size_t kMostRows = 256;  // looked at for each output
  const auto end = static_cast<size_t>(&sink - network_->elements.data());
  if (end > box + kMostRows) return false;
  const std::string operand = ir::fold_name(sink.operand.text);
  for (size_t i = box + 1; i < end; ++i) {
    const Element& between = network_->elements[i];
    if (between.kind == Kind::kSource) continue;
    const bool of_box = between.kind == Kind::kSink && between.inputs[0].from.size() == 1 &&
                        between.inputs[0].from[0].element == box;
    if (!of_box || operand.find(ir::fold_name(between.operand.text)) != std::string::npos) {
      return false;
    }
  }
  return true;
}

// The variable behind an output, when that is all it goes to and stores it as it is.
const network::Element* Parser::Diagram::only_sink(Link link) const {
  const Output& output = outputs_[link.element][link.output];
  const Element& element = network_->elements[output.user];
  if (output.uses != 1 || element.kind != Kind::kSink) return nullptr;
  bool plain = element.modifier <= network::Modifier::kNegated &&
               element.inputs[0].from.size() == 1 &&
               element.inputs[0].modifier == network::Modifier::kNone;
  return plain ? &element : nullptr;
}

// --- expressions and statements

// The tokens of an operand, in the place where it is written.
ExprId Parser::Diagram::parse(const network::Text& operand, bool quiet) {
  base::Diagnostics unheard;  // the reader has reported what no token is
  std::string_view text = p_.text_.substr(operand.span.begin.offset - p_.base_,
                                          operand.span.end.offset - operand.span.begin.offset);
  TokenList tokens = lex(text, operand.span.begin, unheard);
  const Token* first = p_.first_;
  const Token* current = p_.current_;
  const Token* last = p_.last_;
  p_.first_ = p_.current_ = tokens.tokens.data();
  p_.last_ = p_.first_ + tokens.tokens.size() - 1;
  p_.panic_ = quiet;
  ExprId out = p_.parse_expression();
  if (p_.kind() != TokenKind::kEnd) {
    p_.report_here(Code::kExpected,
                   "expected the end of the operand, found " + p_.describe(*p_.current_));
  }
  p_.panic_ = false;
  p_.first_ = first;
  p_.current_ = current;
  p_.last_ = last;
  return out;
}

ExprId Parser::Diagram::boolean(bool value, base::SourceSpan span) {
  Literal literal;
  literal.kind = LiteralKind::kBool;
  literal.integer = value ? 1 : 0;
  return p_.add_literal(std::move(literal), span);
}

ExprId Parser::Diagram::name(const Name& name) {
  Expr expr;
  expr.kind = ExprKind::kName;
  expr.name = name;
  expr.span = name.span;
  return p_.add_expression(expr);
}

ExprId Parser::Diagram::binary(BinaryOp op, ExprId left, ExprId right, base::SourceSpan span) {
  Expr expr;
  expr.kind = ExprKind::kBinary;
  expr.binary = op;
  expr.operand = left;
  expr.right = right;
  expr.op = span.begin;
  expr.span = span;
  return p_.add_expression(expr);
}

ExprId Parser::Diagram::member(ExprId operand, const std::string& name, base::SourceSpan span) {
  Expr expr;
  expr.kind = ExprKind::kMember;
  expr.operand = operand;
  expr.name = {made(name), span};
  expr.span = span;
  return p_.add_expression(expr);
}

ExprId Parser::Diagram::new_result(ExprId value, base::SourceSpan span) {
  ExprId result = p_.add_result(span, false);
  p_.set_values(result, {value});
  return result;
}

// A value that is used later, or in several places.
ExprId Parser::Diagram::keep(ExprId value, base::SourceSpan span) {
  if (tree_[value].kind == ExprKind::kResult) return value;
  ExprId result = new_result(value, span);
  emit_assign(p_.copy_of(result, span), value, AssignOp::kAssign, span);
  return result;
}

void Parser::Diagram::emit(Stmt stmt, base::SourceSpan span) {
  if (!stmt.span.begin.valid()) stmt.span = span;
  stmt.instruction = true;
  p_.add_statement(stmt);
}

void Parser::Diagram::emit_assign(ExprId target, ExprId value, AssignOp op, base::SourceSpan span) {
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.target = target;
  stmt.value = value;
  stmt.assign = op;
  emit(stmt, span);
}

void Parser::Diagram::emit_if(ExprId condition, const Stmt& then, base::SourceSpan span) {
  size_t mark = p_.statement_stack_.size();
  emit(then, span);
  Branch branch;
  branch.condition = condition;
  branch.body = move_tail(p_.statement_stack_, mark, tree_.stmt_lists);
  Stmt stmt;
  stmt.kind = StmtKind::kIf;
  stmt.arms = {static_cast<uint32_t>(tree_.branches.size()), 1};
  tree_.branches.push_back(branch);
  emit(stmt, span);
}

std::string_view Parser::Diagram::made(std::string text) {
  tree_.made_names.push_back(std::move(text));
  return tree_.made_names.back();
}

}  // namespace frontend
