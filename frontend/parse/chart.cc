// Sequential function charts in textual form: INITIAL_STEP, STEP, TRANSITION. An ACTION
// of a POU whose body is a chart is an action of the chart.
#include "frontend/parse/instruction_list.h"
#include "frontend/parse/token_sets.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

struct QualifierWord {
  const char* word;
  ActionQualifier qualifier;
};
constexpr QualifierWord kQualifiers[] = {
    {"N", ActionQualifier::kN},   {"R", ActionQualifier::kR},   {"S", ActionQualifier::kS},
    {"L", ActionQualifier::kL},   {"D", ActionQualifier::kD},   {"P", ActionQualifier::kP},
    {"P0", ActionQualifier::kP0}, {"P1", ActionQualifier::kP1}, {"SD", ActionQualifier::kSD},
    {"DS", ActionQualifier::kDS}, {"SL", ActionQualifier::kSL},
};

}  // namespace

// STEP, TRANSITION and ACTION are names elsewhere. Two names side by side are never part of a
// statement, except in `step S= x`; a call `transition(x := 1)` is not followed by FROM.
bool Parser::at_chart_element() const {
  bool step = kind() == TokenKind::kStep || kind() == TokenKind::kInitialStep;
  if (!step && kind() != TokenKind::kTransition) return false;
  if (is_name(next_kind())) return peek(2).kind != TokenKind::kEqual;
  return !step && next_kind() == TokenKind::kLeftParen && is_name(peek(2).kind) &&
         peek(3).kind == TokenKind::kAssign && peek(5).kind == TokenKind::kRightParen &&
         is_word(peek(6), "FROM");
}

// False when there is none, or when it cannot belong to `pou` but to what is around it.
bool Parser::parse_chart_element(PouDecl& pou) {
  if (!at_chart_element()) return false;
  bool member = pou.kind >= PouKind::kMethod && pou.kind <= PouKind::kSetter;
  if (member) return false;
  Chart refused;
  Chart* chart = &refused;
  if (pou.kind == PouKind::kProgram || pou.kind == PouKind::kFunctionBlock) {
    if (pou.chart == kNoChart) {
      pou.chart = static_cast<uint32_t>(tree_.charts.size());
      tree_.charts.emplace_back().span = current_->span();
    }
    chart = &tree_.charts[pou.chart];
  } else {
    note_only(Code::kNoChartHere, current_->span(),
              describe(*current_) + " stands in something that is no program or function block",
              "a chart goes on from scan to scan: put it into a FUNCTION_BLOCK and call that");
  }
  if (kind() == TokenKind::kTransition) {
    parse_transition(*chart);
  } else {
    parse_step(*chart);
  }
  panic_ = false;
  return true;
}

// A step or transition outside of any POU.
bool Parser::skip_stray_chart_element() {
  if (!at_chart_element()) return false;
  note_only(Code::kNoChartHere, current_->span(),
            describe(*current_) + " stands outside of any POU",
            "put the chart into a PROGRAM or FUNCTION_BLOCK");
  Chart dropped;
  if (kind() == TokenKind::kTransition) {
    parse_transition(dropped);
  } else {
    parse_step(dropped);
  }
  panic_ = false;
  return true;
}

// STEP name : action(qualifier); ... END_STEP
void Parser::parse_step(Chart& chart) {
  ChartStep step;
  step.attributes = take_attributes();
  const Token opening = take();
  step.initial = opening.kind == TokenKind::kInitialStep;
  step.name = parse_name("step");
  if (!panic_) expect(TokenKind::kColon, "after the name of the step");
  panic_ = false;
  while (!step_ends()) {
    if (!accept(TokenKind::kSemicolon)) parse_action_use(step);
  }
  if (!accept(TokenKind::kEndStep)) report_missing_end(opening, TokenKind::kEndStep);
  accept(TokenKind::kSemicolon);
  if (!step.name.empty()) chart.steps.push_back(std::move(step));
}

bool Parser::step_ends() const {
  return kind() == TokenKind::kEnd || is_closing(kind()) || is_file_level_start(kind()) ||
         at_chart_element() || at_member();
}

void Parser::parse_action_use(ChartStep& step) {
  if (!is_name(kind())) {
    report_here(Code::kExpectedName,
                "expected an action such as `Fill(N);` or END_STEP, found " + describe(*current_));
    take();
    return skip_to_declaration_end();
  }
  ActionUse use;
  const Token& name = take();
  use.action = name_of(name);
  use.span = name.span();
  Expr target;
  target.kind = ExprKind::kName;
  target.name = use.action;
  target.span = use.span;
  use.target = add_expression(target);
  const Token open = *current_;
  if (expect(TokenKind::kLeftParen, "after the name of the action")) {
    parse_qualifier(use);
    while (!panic_ && accept(TokenKind::kComma)) {
      ExprId indicator = parse_expression();
      ExprKind what = tree_[indicator].kind;
      if (what != ExprKind::kName && what != ExprKind::kMember && what != ExprKind::kDirect) {
        report(Code::kBadActionTime, tree_[indicator].span,
               "this qualifier of `" + std::string(use.action.text) +
                   "` takes no time; an indicator variable belongs here",
               "times belong to L, D, SD, DS and SL");
      }
      use.indicators.push_back(indicator);
    }
    close_bracket(TokenKind::kRightParen, open);
  }
  finish_declaration("action");
  step.uses.push_back(std::move(use));
}

// [N | R | S | ... ] [, time]
void Parser::parse_qualifier(ActionUse& use) {
  if (kind() == TokenKind::kComma || kind() == TokenKind::kRightParen) return;
  const Name word = name_of(*current_);
  for (const QualifierWord& row : kQualifiers) {
    if (!is_name(kind()) || !ir::same_name(word.text, row.word)) continue;
    use.qualifier = row.qualifier;
    take();
    if (needs_time(row.qualifier)) parse_action_time(use, word);
    return;
  }
  report_here(Code::kBadActionQualifier, describe(*current_) + " is no action qualifier",
              "write one of N R S L D P P0 P1 SD DS SL");
}

void Parser::parse_action_time(ActionUse& use, const Name& word) {
  if (!accept(TokenKind::kComma)) {
    report(Code::kBadActionTime, word.span,
           "`" + std::string(word.text) + "` needs a time after it",
           "write for example " + std::string(word.text) + ", T#5s");
    return;
  }
  use.time = parse_expression();
  if (panic_) return;
  ExprKind what = tree_[use.time].kind;
  bool simple = what == ExprKind::kLiteral || what == ExprKind::kName ||
                what == ExprKind::kMember || what == ExprKind::kIndex;
  if (simple) return;
  report(Code::kBadActionTime, tree_[use.time].span,
         "the time of an action is a literal or a variable",
         "compute it in front of the chart's call, or in another action");
}

// TRANSITION [name] [(PRIORITY := n)] FROM a TO (b, c) := condition; END_TRANSITION
void Parser::parse_transition(Chart& chart) {
  const Token opening = take();
  ChartTransition transition;
  parse_transition_head(transition);
  transition.span = span_from({opening.begin});
  if (!panic_) parse_transition_condition(transition);
  if (panic_) {
    while (kind() != TokenKind::kEndTransition && !step_ends()) take();
    panic_ = false;
  }
  if (!accept(TokenKind::kEndTransition)) report_missing_end(opening, TokenKind::kEndTransition);
  accept(TokenKind::kSemicolon);
  chart.transitions.push_back(std::move(transition));
}

void Parser::parse_transition_head(ChartTransition& transition) {
  if (is_name(kind()) && !is_word(*current_, "FROM")) transition.name = name_of(take());
  if (kind() == TokenKind::kLeftParen) {
    const Token open = take();
    if (!is_word(*current_, "PRIORITY")) {
      return report_here(Code::kExpected, "expected PRIORITY, found " + describe(*current_));
    }
    take();
    if (!expect(TokenKind::kAssign, "after PRIORITY")) return;
    const Expr& number = tree_[parse_expression()];
    bool good = number.kind == ExprKind::kLiteral;
    if (good) {
      const Literal& literal = tree_.literals[number.number];
      good = literal.kind == LiteralKind::kInteger && !literal.negative &&
             literal.integer <= 0xffffffffu;
      transition.has_priority = good;
      transition.priority = static_cast<uint32_t>(literal.integer);
    }
    if (!good) {
      report(Code::kExpected, number.span, "the priority of a transition is an integer literal");
    }
    close_bracket(TokenKind::kRightParen, open);
    if (panic_) return;
  }
  if (!is_word(*current_, "FROM")) {
    return report_here(Code::kExpected,
                       "expected `FROM` and the steps that this transition "
                       "leaves, found " +
                           describe(*current_));
  }
  take();
  parse_step_names(transition.from);
  if (!panic_ && expect(TokenKind::kTo, "after the steps that this transition leaves")) {
    parse_step_names(transition.to);
  }
}

// name, or (name, name, ...)
void Parser::parse_step_names(std::vector<Name>& out) {
  const Token open = *current_;
  bool list = accept(TokenKind::kLeftParen);
  do {
    Name name = parse_name("step");
    if (!panic_) out.push_back(name);
  } while (list && !panic_ && accept(TokenKind::kComma));
  if (list) close_bracket(TokenKind::kRightParen, open);
}

void Parser::parse_transition_condition(ChartTransition& transition) {
  if (kind() == TokenKind::kColon && at_instruction(1)) {
    const Token colon = take();
    transition.condition = InstructionList(*this).condition(colon);
    return;
  }
  if (kind() == TokenKind::kColon) {
    not_supported(take().span(), "conditions as a network are",
                  "write `:= condition;` in Structured Text");
    if (at_diagram()) {
      take();
      take();
      return;
    }
    panic_ = true;  // skips to the end, silently
    return;
  }
  if (!expect(TokenKind::kAssign, "and the condition of the transition")) return;
  transition.condition = parse_condition();
  finish_declaration("condition");
}

// After the last element of a POU's body.
void Parser::finish_chart(PouDecl& pou) {
  if (pou.chart == kNoChart) return;
  for (uint32_t i = 0; i < pou.body.count; ++i) {
    const Stmt& stmt = tree_[tree_.stmt_lists[pou.body.first + i]];
    if (stmt.kind == StmtKind::kError) continue;
    note_only(Code::kChartAndStatements, stmt.span,
              "a statement stands beside the steps and transitions of a chart",
              "put it into an ACTION, and that into a step");
    break;
  }
  pou.body = {};
  take_actions(pou);
}

void Parser::take_actions(PouDecl& pou) {
  if (pou.chart == kNoChart) return;
  std::vector<PouDecl> others;
  for (PouDecl& member : pou.members) {
    if (member.kind == PouKind::kAction) {
      tree_.charts[pou.chart].actions.push_back(
          {member.name, member.body, member.span, member.attributes, member.diagram});
    } else {
      others.push_back(std::move(member));
    }
  }
  pou.members = std::move(others);
}

}  // namespace frontend
