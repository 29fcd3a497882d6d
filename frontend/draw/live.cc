#include "frontend/draw/live.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "frontend/lex/lexer.h"
#include "ir/types/types.h"

namespace frontend::draw {

using network::Kind;
using network::Modifier;

Truth operator!(Truth a) {
  if (a == Truth::kUnknown) return a;
  return a == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

Truth all(Truth a, Truth b) {
  if (a == Truth::kFalse || b == Truth::kFalse) return Truth::kFalse;
  return a == Truth::kTrue && b == Truth::kTrue ? Truth::kTrue : Truth::kUnknown;
}

Truth any(Truth a, Truth b) { return !all(!a, !b); }

void Live::set(std::string_view path, std::string value) {
  values_[ir::fold_name(path)] = std::move(value);
}

const std::string* Live::find(std::string_view variable) const {
  std::string path = ir::fold_name(variable);
  if (!instance_.empty()) {
    auto own = values_.find(ir::fold_name(instance_) + '.' + path);
    if (own != values_.end()) return &own->second;
  }
  auto global = values_.find(path);
  return global == values_.end() ? nullptr : &global->second;
}

namespace {

constexpr uint32_t kMaxLiveDepth = 64;

std::optional<double> as_number(std::string_view text) {
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool whole = error == std::errc{} && end == text.data() + text.size();
  if (!whole || !std::isfinite(value)) return std::nullopt;
  return value;
}

Truth truth_of(std::string_view value) {
  if (ir::same_name(value, "TRUE")) return Truth::kTrue;
  if (ir::same_name(value, "FALSE")) return Truth::kFalse;
  return Truth::kUnknown;
}

// A value with the text that it was read or written as; nullopt: not known.
using Known = std::optional<std::string>;

class Evaluator {
 public:
  Evaluator(std::string_view text, const Live& live) : text_(text), live_(live) {
    base::Diagnostics unheard;
    tokens_ = lex(text, base::SourcePos{0}, unheard).tokens;
    good_ = unheard.all().empty();
  }

  Truth run() {
    Known value = either(0);
    if (!good_ || kind() != TokenKind::kEnd || !value) return Truth::kUnknown;
    return truth_of(*value);
  }

  // Variables in the expression, each once.
  std::vector<std::string> variables() {
    std::vector<std::string> out;
    while (kind() != TokenKind::kEnd) {
      if (!is_name(kind())) {
        ++at_;
        continue;
      }
      std::string_view path = variable();
      bool call = kind() == TokenKind::kLeftParen;
      bool seen = false;
      for (const std::string& one : out) seen = seen || ir::same_name(one, path);
      if (!seen && !call) out.emplace_back(path);
    }
    return out;
  }

 private:
  TokenKind kind() const { return tokens_[at_].kind; }
  bool accept(TokenKind wanted) {
    if (kind() != wanted) return false;
    ++at_;
    return true;
  }
  static Known known(Truth truth) {
    if (truth == Truth::kUnknown) return std::nullopt;
    return truth == Truth::kTrue ? "TRUE" : "FALSE";
  }
  static Truth truth(const Known& value) { return value ? truth_of(*value) : Truth::kUnknown; }

  Known either(uint32_t depth) {
    Known left = exclusive(depth);
    while (accept(TokenKind::kOr) || accept(TokenKind::kOrElse)) {
      Known right = exclusive(depth);
      left = known(any(truth(left), truth(right)));
    }
    return left;
  }
  Known exclusive(uint32_t depth) {
    Known left = both(depth);
    while (accept(TokenKind::kXor)) {
      Truth a = truth(left);
      Truth b = truth(both(depth));
      bool told = a != Truth::kUnknown && b != Truth::kUnknown;
      left = told ? known(a != b ? Truth::kTrue : Truth::kFalse) : std::nullopt;
    }
    return left;
  }
  Known both(uint32_t depth) {
    Known left = comparison(depth);
    while (accept(TokenKind::kAnd) || accept(TokenKind::kAndThen) ||
           accept(TokenKind::kAmpersand)) {
      Known right = comparison(depth);
      left = known(all(truth(left), truth(right)));
    }
    return left;
  }
  Known comparison(uint32_t depth) {
    Known left = operand(depth);
    TokenKind op = kind();
    switch (op) {
      case TokenKind::kEqual:
      case TokenKind::kNotEqual:
      case TokenKind::kLess:
      case TokenKind::kLessEqual:
      case TokenKind::kGreater:
      case TokenKind::kGreaterEqual:
        break;
      default:
        return left;
    }
    ++at_;
    Known right = operand(depth);
    if (!left || !right) return std::nullopt;
    return compare(*left, op, *right);
  }

  static Known compare(const std::string& left, TokenKind op, const std::string& right) {
    std::optional<double> a = as_number(left);
    std::optional<double> b = as_number(right);
    if (a && b) {
      bool less = *a < *b;
      bool equal = *a == *b;
      bool result = op == TokenKind::kEqual       ? equal
                    : op == TokenKind::kNotEqual  ? !equal
                    : op == TokenKind::kLess      ? less
                    : op == TokenKind::kLessEqual ? less || equal
                    : op == TokenKind::kGreater   ? !less && !equal
                                                  : !less;
      return known(result ? Truth::kTrue : Truth::kFalse);
    }
    bool bools = truth_of(left) != Truth::kUnknown && truth_of(right) != Truth::kUnknown;
    if (!bools || (op != TokenKind::kEqual && op != TokenKind::kNotEqual)) return std::nullopt;
    bool equal = ir::same_name(left, right);
    return known(equal == (op == TokenKind::kEqual) ? Truth::kTrue : Truth::kFalse);
  }

  Known operand(uint32_t depth) {
    if (depth > kMaxLiveDepth) good_ = false;
    if (!good_) return std::nullopt;
    if (accept(TokenKind::kNot)) return known(!truth(operand(depth + 1)));
    if (accept(TokenKind::kLeftParen)) {
      Known inside = either(depth + 1);
      if (!accept(TokenKind::kRightParen)) good_ = false;
      return inside;
    }
    bool negative = accept(TokenKind::kMinus);
    switch (kind()) {
      case TokenKind::kTrue:
      case TokenKind::kFalse:
      case TokenKind::kInteger:
      case TokenKind::kReal: {
        std::string literal(token_text_at(at_++));
        std::erase(literal, '_');
        return negative ? '-' + literal : literal;
      }
      default:
        break;
    }
    if (!is_name(kind()) || negative) return fail();
    std::string_view path = variable();
    // Calls, elements of arrays, references: not read.
    if (kind() == TokenKind::kLeftParen || kind() == TokenKind::kLeftBracket ||
        kind() == TokenKind::kCaret || kind() == TokenKind::kTypePrefix) {
      return fail();
    }
    const std::string* value = live_.find(path);
    return value != nullptr ? Known(*value) : std::nullopt;
  }
  Known fail() {
    good_ = false;
    return std::nullopt;
  }

  std::string_view token_text_at(size_t i) const {
    return text_.substr(tokens_[i].begin, tokens_[i].length);
  }
  // a.b.c, a[1].b, a.3
  std::string_view variable() {
    size_t begin = tokens_[at_].begin;
    size_t end = begin + tokens_[at_].length;
    ++at_;
    for (;;) {
      bool part = kind() == TokenKind::kDot &&
                  (is_name(tokens_[at_ + 1].kind) || tokens_[at_ + 1].kind == TokenKind::kInteger);
      bool index = kind() == TokenKind::kLeftBracket && is_constant_index();
      if (!part && !index) break;
      at_ += part ? 2 : 3;
      end = tokens_[at_ - 1].begin + tokens_[at_ - 1].length;
    }
    return text_.substr(begin, end - begin);
  }
  bool is_constant_index() const {
    return at_ + 2 < tokens_.size() && tokens_[at_ + 1].kind == TokenKind::kInteger &&
           tokens_[at_ + 2].kind == TokenKind::kRightBracket;
  }

  std::string_view text_;
  const Live& live_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  bool good_ = true;
};

}  // namespace

std::vector<std::string> variables_in(std::string_view expression) {
  return Evaluator(expression, Live({})).variables();
}

Truth Live::truth(std::string_view expression) const { return Evaluator(expression, *this).run(); }

std::string Live::shown(std::string_view operand) const {
  std::string out;
  if (const std::string* own = find(operand)) {
    return truth_of(*own) == Truth::kUnknown ? *own : "";
  }
  for (const std::string& variable : variables_in(operand)) {
    const std::string* value = find(variable);
    if (value == nullptr || truth_of(*value) != Truth::kUnknown) continue;
    if (!out.empty()) out += ' ';
    out += variable + '=' + *value;
  }
  return out;
}

Power::Power(const network::Network& network, const Live* live) : network_(network), live_(live) {
  outputs_.resize(network.elements.size());
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    outputs_[i].assign(network.elements[i].outputs.size(), Truth::kUnknown);
  }
  if (live_ == nullptr) return;
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    element(network.elements[i], outputs_[i]);
  }
}

Truth Power::input(const network::Input& input) const {
  if (live_ == nullptr || input.from.empty()) return Truth::kUnknown;
  Truth out = Truth::kFalse;
  for (network::Link link : input.from) out = any(out, output(link));
  if (input.modifier == Modifier::kNegated) return !out;
  return input.modifier == Modifier::kNone ? out : Truth::kUnknown;
}

// The result of AND, OR, XOR, NOT, and of comparisons of operands.
Truth Power::function(const network::Element& block) const {
  static constexpr std::pair<const char*, const char*> kComparisons[] = {
      {"LT", "<"}, {"LE", "<="}, {"GT", ">"}, {"GE", ">="}, {"EQ", "="}, {"NE", "<>"}};
  std::vector<Truth> values;
  std::string compared;
  const char* sign = nullptr;
  for (const auto& [name, text] : kComparisons) {
    if (ir::same_name(block.type.text, name)) sign = text;
  }
  for (const network::Input& pin : block.inputs) {
    if (ir::same_name(pin.name, "EN")) return Truth::kUnknown;
    values.push_back(input(pin));
    bool source = pin.from.size() == 1 && pin.modifier == Modifier::kNone &&
                  network_.elements[pin.from[0].element].kind == Kind::kSource;
    if (sign == nullptr || !source) continue;
    compared += compared.empty() ? "" : sign;
    compared += '(' + network_.elements[pin.from[0].element].operand.text + ')';
  }
  if (values.empty()) return Truth::kUnknown;
  if (sign != nullptr && values.size() == 2) return live_->truth(compared);
  if (ir::same_name(block.type.text, "NOT")) return !values[0];
  Truth out = values[0];
  for (size_t i = 1; i < values.size(); ++i) {
    if (ir::same_name(block.type.text, "AND")) {
      out = all(out, values[i]);
    } else if (ir::same_name(block.type.text, "OR")) {
      out = any(out, values[i]);
    } else {
      return Truth::kUnknown;
    }
  }
  return values.size() > 1 ? out : Truth::kUnknown;
}

void Power::element(const network::Element& element, std::vector<Truth>& outputs) const {
  if (outputs.empty()) return;
  Truth in = element.inputs.empty() ? Truth::kUnknown : input(element.inputs[0]);
  switch (element.kind) {
    case Kind::kLeftRail:
      outputs[0] = Truth::kTrue;
      return;
    case Kind::kSource:
      outputs[0] = live_->truth(element.operand.text);
      return;
    case Kind::kCoil:
      outputs[0] = in;
      return;
    case Kind::kContact: {
      Truth own = live_->truth(element.operand.text);
      if (element.modifier == Modifier::kNegated || element.modifier == Modifier::kFalling) {
        own = !own;
      }
      // Behind an edge power stays for one scan; without the level there is none.
      bool edge = element.modifier > Modifier::kNegated;
      if (edge && own == Truth::kTrue) own = Truth::kUnknown;
      outputs[0] = all(in, own);
      return;
    }
    case Kind::kBlock:
      break;
    default:
      return;
  }
  for (uint32_t pin = 0; pin < outputs.size(); ++pin) {
    const network::Output& output = element.outputs[pin];
    if (ir::same_name(output.name, "ENO")) {
      // FALSE where EN is; where that is TRUE the call may have failed.
      for (const network::Input& enable : element.inputs) {
        bool off = ir::same_name(enable.name, "EN") && input(enable) == Truth::kFalse;
        if (off) outputs[pin] = Truth::kFalse;
      }
    } else if (element.operand.empty()) {
      outputs[pin] = function(element);
    } else {
      outputs[pin] = live_->truth(element.operand.text + '.' + output.name);
    }
    if (output.negated) outputs[pin] = !outputs[pin];
  }
}

}  // namespace frontend::draw
