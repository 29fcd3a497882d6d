#include "adapters/plcopen/expression_boxes.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/limits.h"
#include "frontend/lex/lexer.h"
#include "frontend/network/expressions.h"

namespace plcopen {
namespace {

namespace network = frontend::network;
using frontend::Token;
using frontend::TokenKind;
using network::Element;
using network::Input;
using network::Kind;
using network::Link;

struct Operator {
  TokenKind kind;
  int precedence;  // as frontend/parse/expression.cc has it
  const char* function;
};
constexpr std::array kOperators = {
    Operator{TokenKind::kOr, 1, "OR"},      Operator{TokenKind::kXor, 2, "XOR"},
    Operator{TokenKind::kAnd, 3, "AND"},    Operator{TokenKind::kAmpersand, 3, "AND"},
    Operator{TokenKind::kEqual, 4, "EQ"},   Operator{TokenKind::kNotEqual, 4, "NE"},
    Operator{TokenKind::kLess, 5, "LT"},    Operator{TokenKind::kLessEqual, 5, "LE"},
    Operator{TokenKind::kGreater, 5, "GT"}, Operator{TokenKind::kGreaterEqual, 5, "GE"},
    Operator{TokenKind::kPlus, 6, "ADD"},   Operator{TokenKind::kMinus, 6, "SUB"},
    Operator{TokenKind::kStar, 7, "MUL"},   Operator{TokenKind::kSlash, 7, "DIV"},
    Operator{TokenKind::kMod, 7, "MOD"},    Operator{TokenKind::kPower, 8, "EXPT"},
};

// A part of the expression: a wire, a text without wires, or a box.
struct Part {
  size_t begin = 0;  // tokens
  size_t end = 0;
  bool of_wires = false;
  std::vector<Link> wire;  // one, or none
  std::string function;
  struct Pin;
  std::vector<Pin> pins;
};
struct Part::Pin {
  std::string name;
  Part part;
};

class Expression {
 public:
  Expression(const Element& source, std::vector<Element>& to) : source_(source), to_(to) {
    base::Diagnostics unheard;
    tokens_ = frontend::lex(source.operand.text, base::SourcePos{0}, unheard).tokens;
    for (const network::OperandPiece& piece : network::operand_pieces(source)) {
      if (piece.input == nullptr) continue;
      const size_t begin = static_cast<size_t>(piece.text.data() - source.operand.text.data());
      wires_.push_back({begin, begin + piece.text.size(), piece.input->from[0]});
    }
  }

  // Adds boxes; what the expression gives, or nothing.
  std::optional<Link> run() {
    const Part whole = binary(0);
    if (!good_ || kind() != TokenKind::kEnd) return std::nullopt;
    return add(whole);
  }

 private:
  struct Wire {
    size_t begin = 0;
    size_t end = 0;
    Link from;
  };

  TokenKind kind(size_t ahead = 0) const {
    return tokens_[std::min(at_ + ahead, tokens_.size() - 1)].kind;
  }
  bool accept(TokenKind wanted) {
    const bool found = kind() == wanted;
    at_ += found ? 1 : 0;
    return found;
  }
  Part bad() {
    good_ = false;
    at_ = tokens_.size() - 1;
    return {};
  }
  bool has_wire(size_t first, size_t end) const {
    return std::ranges::any_of(wires_, [&](const Wire& wire) {
      return wire.begin >= tokens_[first].begin && wire.begin < tokens_[end].begin;
    });
  }
  std::string text(size_t first, size_t end) const {
    const size_t begin = tokens_[first].begin;
    return source_.operand.text.substr(begin,
                                       tokens_[end - 1].begin + tokens_[end - 1].length - begin);
  }
  static Part box(std::string function, size_t begin, size_t end) {
    Part out;
    out.begin = begin;
    out.end = end;
    out.of_wires = true;
    out.function = std::move(function);
    return out;
  }

  Part binary(int above);
  Part unary();
  Part primary();
  Part call();
  Part without_wires();
  void skip_brackets();
  Link add(const Part& part);

  const Element& source_;
  std::vector<Element>& to_;
  std::vector<Token> tokens_;
  std::vector<Wire> wires_;
  size_t at_ = 0;
  uint32_t depth_ = 0;
  bool good_ = true;
};

Part Expression::binary(int above) {
  if (++depth_ > base::kMaxNesting) return bad();
  Part left = unary();
  for (;;) {
    const auto found =
        std::ranges::find(kOperators, kind(), [](const Operator& each) { return each.kind; });
    if (found == kOperators.end() || found->precedence <= above) break;
    ++at_;
    Part right = binary(found->precedence);
    if (!left.of_wires && !right.of_wires) {
      left.end = right.end;
      continue;
    }
    Part both = box(found->function, left.begin, right.end);
    both.pins.push_back({"", std::move(left)});
    both.pins.push_back({"", std::move(right)});
    left = std::move(both);
  }
  --depth_;
  return left;
}

// There is no function for the sign of a wire.
Part Expression::unary() {
  const size_t begin = at_;
  const TokenKind op = kind();
  if (op != TokenKind::kNot && op != TokenKind::kMinus && op != TokenKind::kPlus) return primary();
  if (++depth_ > base::kMaxNesting) return bad();
  ++at_;
  Part of = unary();
  --depth_;
  if (!of.of_wires) {
    of.begin = begin;
    return of;
  }
  if (op != TokenKind::kNot) return bad();
  Part out = box("NOT", begin, of.end);
  out.pins.push_back({"", std::move(of)});
  return out;
}

Part Expression::primary() {
  const size_t begin = at_;
  if (accept(TokenKind::kLeftParen)) {
    Part inner = binary(0);
    if (!accept(TokenKind::kRightParen)) return bad();
    inner.begin = begin;
    inner.end = at_;
    const bool led = kind() == TokenKind::kCaret || kind() == TokenKind::kLeftBracket;
    return led ? bad() : inner;
  }
  for (const Wire& wire : wires_) {
    if (wire.begin != tokens_[at_].begin) continue;
    Part out;
    out.begin = begin;
    out.of_wires = true;
    out.wire = {wire.from};
    while (kind() != TokenKind::kEnd && tokens_[at_].begin < wire.end) ++at_;
    out.end = at_;
    const bool led = kind() == TokenKind::kDot || kind() == TokenKind::kLeftBracket ||
                     kind() == TokenKind::kCaret || kind() == TokenKind::kLeftParen;
    return led ? bad() : out;
  }
  Part plain = without_wires();
  if (!good_ || !has_wire(plain.begin, plain.end)) return plain;
  at_ = begin;
  return call();
}

// F(a, pin := b)
Part Expression::call() {
  const size_t begin = at_;
  const bool named = frontend::is_name(kind()) || kind() == TokenKind::kAnd ||
                     kind() == TokenKind::kOr || kind() == TokenKind::kXor ||
                     kind() == TokenKind::kMod;
  if (!named || kind(1) != TokenKind::kLeftParen) return bad();
  Part out = box(text(at_, at_ + 1), begin, 0);
  at_ += 2;
  do {
    std::string pin;
    if (kind(1) == TokenKind::kAssign) {
      pin = text(at_, at_ + 1);
      at_ += 2;
    }
    out.pins.push_back({std::move(pin), binary(0)});
  } while (accept(TokenKind::kComma));
  if (!accept(TokenKind::kRightParen)) return bad();
  out.end = at_;
  const bool led = kind() == TokenKind::kDot || kind() == TokenKind::kLeftBracket ||
                   kind() == TokenKind::kCaret || kind() == TokenKind::kLeftParen;
  return led ? bad() : out;
}

// A literal, or a variable with all that follows it.
Part Expression::without_wires() {
  Part out;
  out.begin = at_;
  if (kind() == TokenKind::kLeftBracket) skip_brackets();
  if (at_ == out.begin && kind() != TokenKind::kEnd) ++at_;
  for (bool more = true; more;) {
    const bool prefix = tokens_[at_ - 1].kind == TokenKind::kTypePrefix;
    const bool member = kind() == TokenKind::kDot || tokens_[at_ - 1].kind == TokenKind::kDot;
    if (kind() == TokenKind::kLeftParen || kind() == TokenKind::kLeftBracket) {
      skip_brackets();
    } else if (kind() != TokenKind::kEnd && (prefix || member || kind() == TokenKind::kCaret)) {
      ++at_;
    } else {
      more = false;
    }
  }
  out.end = at_;
  return out;
}

void Expression::skip_brackets() {
  uint32_t depth = 0;
  do {
    if (kind() == TokenKind::kEnd) {
      bad();
      return;
    }
    const TokenKind k = kind();
    if (k == TokenKind::kLeftParen || k == TokenKind::kLeftBracket) ++depth;
    if (k == TokenKind::kRightParen || k == TokenKind::kRightBracket) --depth;
    ++at_;
  } while (depth > 0);
}

Link Expression::add(const Part& part) {
  if (!part.wire.empty()) return part.wire[0];
  Element element;
  element.span = source_.span;
  element.outputs.resize(1);
  if (!part.of_wires) {
    element.kind = Kind::kSource;
    element.operand = {text(part.begin, part.end), source_.span};
  } else {
    element.kind = Kind::kBlock;
    element.type = {part.function, source_.span};
    for (const auto& [name, of] : part.pins) {
      Input input;
      input.name = name;
      input.from = {add(of)};
      element.inputs.push_back(std::move(input));
    }
  }
  to_.push_back(std::move(element));
  return {static_cast<uint32_t>(to_.size() - 1), 0};
}

}  // namespace

std::optional<base::SourceSpan> expressions_to_boxes(network::Body& body) {
  for (network::Network& each : body.networks) {
    if (std::ranges::none_of(each.elements, network::is_expression_of_wires)) continue;
    // Links lead to numbers of before; of a source, to what took its place.
    std::vector<Link> places(each.elements.size());
    const auto renumber = [&](Element& element) {
      for (Input& input : element.inputs) {
        for (Link& link : input.from) {
          const Link place = places[link.element];
          link = {place.element, place.output + link.output};
        }
      }
    };
    std::vector<Element> out;
    std::vector<uint32_t> kept;
    for (uint32_t i = 0; i < each.elements.size(); ++i) {
      Element& element = each.elements[i];
      if (!network::is_expression_of_wires(element)) {
        places[i] = {static_cast<uint32_t>(out.size()), 0};
        kept.push_back(places[i].element);
        out.push_back(std::move(element));
        continue;
      }
      renumber(element);  // wires are above
      const std::optional<Link> made = Expression(element, out).run();
      if (!made) return element.span;
      places[i] = *made;
    }
    for (const uint32_t number : kept) renumber(out[number]);
    each.elements = std::move(out);
  }
  return std::nullopt;
}

}  // namespace plcopen
