#include "frontend/parse/diagram.h"

#include "frontend/lex/characters.h"
#include "frontend/network/suspicious.h"
#include "ir/types/types.h"

namespace frontend {

using network::Kind;
using network::Modifier;

namespace {

// Beyond it a value is kept: a join may have more branches than an expression is high.
constexpr size_t kHighest = 100;

// An operand, however its tokens were set apart.
std::string without_blanks(const std::string& operand) {
  base::Diagnostics unheard;
  std::string out;
  bool word = false;
  for (const Token& token : lex(operand, base::SourcePos{0}, unheard).tokens) {
    std::string text = operand.substr(token.begin, token.length);
    bool begins = !text.empty() && (is_name_part(text[0]) || text[0] == '%');
    if (word && begins) out += ' ';
    word = !text.empty() && is_name_part(text.back());
    out += text;
  }
  return out;
}

}  // namespace

void Parser::Diagram::run(const network::Body& body) {
  ladder_ = body.language == network::Language::kLadder;
  check_wires(body);
  network::report_suspicious(body, p_.diagnostics_);
  for (const network::Network& each : body.networks) network(each);
  if (kept_.vars.empty()) return;
  // The variables of a call are gone after it; these live in the instance.
  const bool call = pou_.kind == PouKind::kMethod || pou_.kind == PouKind::kGetter ||
                    pou_.kind == PouKind::kSetter;
  kept_.section = call ? VarSection::kInstance : VarSection::kLocal;
  kept_.scope = p_.scope_;
  kept_.span = body.span;
  pou_.blocks.push_back(std::move(kept_));
}

// A wire of a variable's name would be read where the variable is meant.
void Parser::Diagram::check_wires(const network::Body& body) {
  std::unordered_set<std::string> variables;
  for (const VarBlock& block : pou_.blocks) {
    for (const VarDecl& decl : block.vars) {
      for (const Name& each : decl.names) variables.insert(ir::fold_name(each.text));
    }
  }
  for (const network::Network& each : body.networks) {
    for (const Element& element : each.elements) {
      if (element.wire.empty() || !variables.contains(ir::fold_name(element.wire.text))) continue;
      p_.note_only(
          Code::kBoxTwice, element.wire.span, "`" + element.wire.text + "` is a variable, too",
          "give the wire a name of its own, or assign: `" + element.wire.text + " := wire;`");
    }
  }
}

void Parser::Diagram::network(const network::Network& network) {
  network_ = &network;
  if (!network.label.empty()) {
    Stmt label;
    label.kind = StmtKind::kLabel;
    label.name = tree_.add_name({made(network.label.text), network.label.span});
    emit(label, network.label.span);
  }
  if (network.disabled) return;
  count_uses();
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    if (!done_[i]) element(i);
  }
}

void Parser::Diagram::count_uses() {
  const size_t count = network_->elements.size();
  outputs_.assign(count, {});
  conditions_.assign(count, {});
  done_.assign(count, false);
  joins_.clear();
  for (size_t i = 0; i < count; ++i) outputs_[i].resize(network_->elements[i].outputs.size());
  for (uint32_t i = 0; i < count; ++i) {
    const Element& element = network_->elements[i];
    for (const network::Input& input : element.inputs) {
      for (network::Link link : input.from) {
        Output& output = outputs_[link.element][link.output];
        ++output.uses;
        output.user = i;
        output.power = output.power || takes_power(element, input);
      }
    }
  }
  std::unordered_map<std::string, uint32_t> below;  // boxes, by folded instance
  next_box_.assign(count, static_cast<uint32_t>(count));
  targets_.assign(count, 0);
  for (uint32_t i = static_cast<uint32_t>(count); i-- > 0;) {
    const Element& element = network_->elements[i];
    bool instance = element.kind == Kind::kBlock && !element.operand.empty();
    if (instance) {
      const auto [box, last] = below.try_emplace(ir::fold_name(element.operand.text), i);
      if (!last) next_box_[i] = std::exchange(box->second, i);
    }
    targets_[i] = i;
    bool passes = element.kind == Kind::kContact || element.kind == Kind::kSource ||
                  (element.kind == Kind::kBlock && !instance);
    for (size_t o = 0; passes && o < outputs_[i].size(); ++o) {
      if (outputs_[i][o].uses == 0 || outputs_[i][o].user <= i) continue;
      targets_[i] = targets_[outputs_[i][o].user];
      break;
    }
  }
}

void Parser::Diagram::element(uint32_t number) {
  const Element& element = network_->elements[number];
  here_ = element.span;
  number_ = number;
  switch (element.kind) {
    case Kind::kContact:
      return contact(number, element);
    case Kind::kCoil:
      return coil(number, element);
    case Kind::kSink:
      return sink(element);
    case Kind::kBlock:
      return block(number, element);
    case Kind::kJump:
    case Kind::kReturn:
      return jump(element);
    case Kind::kLeftRail:
    case Kind::kRightRail:
    case Kind::kSource:
      return;
  }
}

void Parser::Diagram::contact(uint32_t number, const Element& element) {
  Value left = linked(element.inputs[0]);
  ExprId value = parse(element.operand);
  if (element.modifier == Modifier::kNegated) value = p_.negated(value, element.span);
  value = edge(value, element.modifier, element.operand.text, element.span);
  if (!left.expr.valid()) left.expr = boolean(false, element.span);
  if (!left.power) value = binary(BinaryOp::kAnd, left.expr, value, element.span);
  if (outputs_[number][0].uses > 0) outputs_[number][0].kept = keep(value, element.span);
}

void Parser::Diagram::coil(uint32_t number, const Element& element) {
  ExprId value = linked(element.inputs[0]).expr;
  if (!value.valid()) value = boolean(false, element.span);
  if (!element.outputs.empty() && outputs_[number][0].uses > 0) {
    value = keep(value, element.span);
    outputs_[number][0].kept = value;
  }
  assign(element, value, element.modifier);
}

void Parser::Diagram::sink(const Element& element) {
  ExprId value = input(element.inputs[0]).expr;
  if (value.valid()) assign(element, value, element.modifier);
}

// What a block with EN gives is stored only when it ran.
void Parser::Diagram::assign(const Element& element, ExprId value, Modifier modifier) {
  AssignOp op = modifier == Modifier::kSet     ? AssignOp::kSet
                : modifier == Modifier::kReset ? AssignOp::kReset
                                               : AssignOp::kAssign;
  if (modifier == Modifier::kNegated) value = p_.negated(value, element.span);
  value = edge(value, modifier, element.operand.text + "#coil", element.span);
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.target = parse(element.operand);
  stmt.value = value;
  stmt.assign = op;
  stmt.span = element.span;
  ExprId enabled = enabled_by(element);
  if (enabled.valid()) {
    emit_if(p_.copy_of(enabled, element.span), stmt, element.span);
  } else {
    emit(stmt, element.span);
  }
}

ExprId Parser::Diagram::enabled_by(const Element& element) const {
  if (element.kind != Kind::kSink) return {};
  for (network::Link link : element.inputs[0].from) {
    const network::Output& from = network_->elements[link.element].outputs[link.output];
    bool eno = ir::same_name(from.name, "ENO");
    if (conditions_[link.element].valid() && !eno) return conditions_[link.element];
  }
  return {};
}

void Parser::Diagram::jump(const Element& element) {
  Stmt stmt;
  stmt.kind = element.kind == Kind::kJump ? StmtKind::kJump : StmtKind::kReturn;
  stmt.span = element.span;
  stmt.name = tree_.add_name({made(element.operand.text), element.operand.span});
  Value condition = input(element.inputs[0]);
  if (!condition.expr.valid()) condition.expr = boolean(false, element.span);
  if (condition.power) return emit(stmt, element.span);
  emit_if(condition.expr, stmt, element.span);
}

// Everything that is linked, as one value.
Parser::Diagram::Value Parser::Diagram::linked(const network::Input& input) {
  Value out;
  base::SourceSpan span = input.span.begin.valid() ? input.span : here_;
  std::vector<std::pair<uint32_t, uint32_t>> links;
  for (network::Link link : input.from) {
    if (network_->elements[link.element].kind == Kind::kLeftRail) {
      return {boolean(true, span), true};
    }
    links.emplace_back(link.element, link.output);
  }
  if (links.size() == 1) {
    out.expr = output(input.from[0], span);
  } else if (!links.empty()) {
    ExprId& join = joins_[links];
    if (!join.valid()) {
      ExprId value = output(input.from[0], span);
      for (size_t i = 1; i < input.from.size(); ++i) {
        value = binary(BinaryOp::kOr, value, output(input.from[i], span), span);
        if (i % kHighest == 0) value = p_.copy_of(keep(value, span), span);
      }
      join = keep(value, span);
    }
    out.expr = p_.copy_of(join, span);
  }
  return out;
}

Parser::Diagram::Value Parser::Diagram::input(const network::Input& input) {
  Value out = linked(input);
  base::SourceSpan span = input.span.begin.valid() ? input.span : here_;
  if (!out.expr.valid() || input.modifier == Modifier::kNone) return out;
  if (input.modifier == Modifier::kNegated) out.expr = p_.negated(out.expr, span);
  const Element* from =
      input.from.size() == 1 ? &network_->elements[input.from[0].element] : nullptr;
  bool source = from != nullptr && from->kind == Kind::kSource;
  const std::string& of = source ? from->operand.text : input.name;
  out.expr = edge(out.expr, input.modifier, of, span);
  out.power = false;
  return out;
}

// `span`: of the pin that takes it, which messages about its type point to.
ExprId Parser::Diagram::output(network::Link link, base::SourceSpan span) {
  const Element& from = network_->elements[link.element];
  const network::Output& output = from.outputs[link.output];
  ExprId value;
  if (from.kind == Kind::kSource) {
    value = expression(from);
  } else if (ExprId kept = outputs_[link.element][link.output].kept; kept.valid()) {
    value = p_.copy_of(kept, span);
  } else if (from.kind == Kind::kBlock && !from.operand.empty()) {
    value = member(parse(from.operand), output.name, span);
  } else {
    value = boolean(false, span);  // reported by the reader
  }
  return output.negated ? p_.negated(value, span) : value;
}

// An operand; the wires in it are values that were kept.
ExprId Parser::Diagram::expression(const Element& source) {
  wires_.clear();
  for (const network::Input& input : source.inputs) {
    wires_.emplace(ir::fold_name(input.name), output(input.from[0], source.span));
  }
  if (!wires_.empty()) p_.wires_ = this;
  const ExprId value = parse(source.operand);
  p_.wires_ = nullptr;
  return value;
}

ExprId Parser::Diagram::wire_value() {
  const std::string name = ir::fold_name(p_.text(*p_.current_));
  size_t tokens = 1;
  auto wire = wires_.end();
  if (p_.next_kind() == TokenKind::kDot && is_name(p_.peek(2).kind)) {
    wire = wires_.find(name + '.' + ir::fold_name(p_.text(p_.peek(2))));
    tokens = 3;
  }
  if (wire == wires_.end()) {
    wire = wires_.find(name);
    tokens = 1;
  }
  if (wire == wires_.end()) return {};
  const base::SourcePos begin = p_.here();
  while (tokens-- > 0) p_.take();
  return p_.copy_of(wire->second, p_.span_from(begin));
}

// TRUE in the scan in which `value` rises or falls.
ExprId Parser::Diagram::edge(ExprId value, Modifier modifier, const std::string& of,
                             base::SourceSpan span) {
  if (modifier != Modifier::kRising && modifier != Modifier::kFalling) return value;
  if (pou_.kind == PouKind::kFunction || pou_.kind == PouKind::kMockFunction) {
    p_.note_only(Code::kNoEdgeMemory, span,
                 "a function keeps nothing from call to call, so it sees no edge",
                 "make it a FUNCTION_BLOCK, or give the edge as an input");
    return value;
  }
  Name last = memory(of, modifier, span);
  ExprId now = keep(value, span);
  ExprId before = name(last);
  bool rising = modifier == Modifier::kRising;
  ExprId changed =
      rising ? binary(BinaryOp::kAnd, p_.copy_of(now, span), p_.negated(before, span), span)
             : binary(BinaryOp::kAnd, p_.negated(p_.copy_of(now, span), span), before, span);
  ExprId seen = keep(changed, span);
  emit_assign(name(last), p_.copy_of(now, span), AssignOp::kAssign, span);
  return seen;
}

// What is compared, and what the edge acts on: both stay when rungs come and go around it. A block
// has those of its base besides its own, which begin with its name.
Name Parser::Diagram::memory(const std::string& of, Modifier modifier, base::SourceSpan span) {
  std::string text;
  const bool action = pou_.kind == PouKind::kAction;
  const PouDecl& holder = action && p_.member_of_ != nullptr ? *p_.member_of_ : pou_;
  if (!holder.extends.empty()) text = std::string(holder.name.text) + '.';
  if (action) text += std::string(pou_.name.text) + '.';
  text += without_blanks(of) + (modifier == Modifier::kRising ? "#rising" : "#falling");
  const Element& target = network_->elements[targets_[number_]];
  bool acts = target.kind == Kind::kCoil || target.kind == Kind::kSink ||
              target.kind == Kind::kJump || target.kind == Kind::kBlock;
  const std::string& name = target.operand.empty() ? target.type.text : target.operand.text;
  if (acts && !name.empty()) text += '#' + without_blanks(name);
  uint32_t times = ++memories_[ir::fold_name(text)];
  if (times > 1) text += '#' + std::to_string(times);
  Spec spec;
  spec.kind = SpecKind::kNamed;
  spec.name = {"BOOL", span};
  spec.span = span;
  VarDecl decl;
  decl.names.push_back({made(std::move(text)), span});
  decl.spec = p_.add_spec(std::move(spec));
  decl.span = span;
  kept_.vars.push_back(decl);
  return decl.names[0];
}

}  // namespace frontend
