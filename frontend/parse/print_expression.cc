#include <charconv>

#include "frontend/parse/printer.h"

namespace frontend {

namespace {

const char* printed_operator(BinaryOp op) {
  switch (op) {
    case BinaryOp::kOr:
      return " OR ";
    case BinaryOp::kOrElse:
      return " OR_ELSE ";
    case BinaryOp::kXor:
      return " XOR ";
    case BinaryOp::kAnd:
      return " AND ";
    case BinaryOp::kAndThen:
      return " AND_THEN ";
    case BinaryOp::kEq:
      return " = ";
    case BinaryOp::kNe:
      return " <> ";
    case BinaryOp::kLt:
      return " < ";
    case BinaryOp::kLe:
      return " <= ";
    case BinaryOp::kGt:
      return " > ";
    case BinaryOp::kGe:
      return " >= ";
    case BinaryOp::kAdd:
      return " + ";
    case BinaryOp::kSub:
      return " - ";
    case BinaryOp::kMul:
      return " * ";
    case BinaryOp::kDiv:
      return " / ";
    case BinaryOp::kMod:
      return " MOD ";
    case BinaryOp::kPower:
      return " ** ";
  }
  return "";
}

const char* printed_operator(UnaryOp op) {
  switch (op) {
    case UnaryOp::kNegate:
      return "-";
    case UnaryOp::kPlus:
      return "+";
    case UnaryOp::kNot:
      return "NOT ";
  }
  return "";
}

std::string real_text(double value) {
  char buffer[32];
  auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

// Bytes that are no printable ASCII as the language writes them: $0a
std::string string_text(std::string_view bytes) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (char c : bytes) {
    auto byte = static_cast<uint8_t>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      out += c;
    } else {
      out += '$';
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    }
  }
  return out;
}

std::string part_text(const Expr& expr) {
  const char* size = expr.bit_size == 8 ? "%B" : expr.bit_size == 16 ? "%W" : "%D";
  return '.' + (expr.bit_size == 1 ? "" : std::string(size)) + std::to_string(expr.number);
}

}  // namespace

std::string Printer::expression(ExprId id) const {
  if (!id.valid()) return "";
  const Expr& expr = tree_[id];
  switch (expr.kind) {
    case ExprKind::kError:
      return "<error>";
    case ExprKind::kLiteral:
      return literal(tree_.literals[expr.number]);
    case ExprKind::kName:
      return (expr.global ? "." : "") + std::string(expr.name.text);
    case ExprKind::kQualified:
      return (expr.operand.valid() ? expression(expr.operand) + '.' : "") +
             std::string(tree_.name(expr.number).text) + '#' + std::string(expr.name.text);
    case ExprKind::kMember:
      return expression(expr.operand) + '.' + std::string(expr.name.text);
    case ExprKind::kBit:
      return expression(expr.operand) + part_text(expr);
    case ExprKind::kIndex:
      return expression(expr.operand) + '[' + list(expr.list) + ']';
    case ExprKind::kDeref:
      return expression(expr.operand) + '^';
    case ExprKind::kCall:
      return expression(expr.operand) + arguments(expr.list);
    case ExprKind::kUnary:
      return '(' + (printed_operator(expr.unary) + expression(expr.operand)) + ')';
    case ExprKind::kBinary:
      return binary(expr);
    case ExprKind::kDirect:
      return (expr.operand.valid() ? expression(expr.operand) + '.' : "") +
             address(tree_.directs[expr.number].address, tree_.directs[expr.number].levels);
    case ExprKind::kArrayInit:
      return '[' + list(expr.list) + ']';
    case ExprKind::kRepeat:
      return expression(expr.operand) + '(' + list(expr.list) + ')';
    case ExprKind::kStructInit:
      return arguments(expr.list);
    case ExprKind::kResult:
      return "result#" + std::to_string(expr.number);
    case ExprKind::kThis:
      return "THIS";
    case ExprKind::kSuper:
      return "SUPER";
    case ExprKind::kType:
      return "TYPE(" + spec(expr.spec()) + ')';
    case ExprKind::kAssign:
      return '(' + expression(expr.operand) + assign_text(expr.assign) + expression(expr.right) +
             ')';
  }
  return "";
}

const char* Printer::assign_text(AssignOp op) {
  switch (op) {
    case AssignOp::kAssign:
      return " := ";
    case AssignOp::kSet:
      return " S= ";
    case AssignOp::kReset:
      return " R= ";
    case AssignOp::kReference:
      return " REF= ";
    case AssignOp::kAttempt:
      return " ?= ";
  }
  return "";
}

// A chain `a + b + c` is deep on its left side only: a loop, so that its text is
// built once from the left and not copied at every level.
std::string Printer::binary(const Expr& expr) const {
  std::vector<const Expr*> chain;
  const Expr* at = &expr;
  for (; at->kind == ExprKind::kBinary; at = &tree_[at->operand]) {
    chain.push_back(at);
  }
  std::string out(chain.size(), '(');
  out += expression(chain.back()->operand);
  for (auto node = chain.rbegin(); node != chain.rend(); ++node) {
    out += printed_operator((*node)->binary) + expression((*node)->right) + ')';
  }
  return out;
}

std::string Printer::literal(const Literal& literal) const {
  std::string out;
  if (literal.prefix != kNoNumber) out = std::string(tree_.name(literal.prefix).text) + '#';
  if (literal.negative) out += '-';
  const char* is_long = literal.is_long ? "L" : "";
  switch (literal.kind) {
    case LiteralKind::kInteger:
      return out + std::to_string(literal.integer) + (literal.based ? "u" : "");
    case LiteralKind::kReal: {
      std::string text = real_text(literal.real);
      bool plain = text.find_first_of(".en") == std::string::npos;
      return out + text + (plain ? ".0" : "");
    }
    case LiteralKind::kBool:
      return out + (literal.integer != 0 ? "TRUE" : "FALSE");
    case LiteralKind::kString:
      return out + '\'' + string_text(tree_.texts[literal.text]) + '\'';
    case LiteralKind::kWstring: {
      const std::string& text = tree_.texts[literal.text];
      std::string units;
      for (size_t i = 0; i + 1 < text.size(); i += 2) {
        uint32_t unit = static_cast<uint8_t>(text[i]) |
                        static_cast<uint32_t>(static_cast<uint8_t>(text[i + 1])) << 8;
        units += unit >= 0x20 && unit < 0x7F ? std::string(1, static_cast<char>(unit))
                                             : '$' + std::to_string(unit) + ';';
      }
      return out + '"' + units + '"';
    }
    case LiteralKind::kDuration:
      return is_long + ("T#" + out) + std::to_string(literal.integer) + "ns";
    case LiteralKind::kDate:
      return is_long + ("D#" + out) + std::to_string(literal.integer) + "ns";
    case LiteralKind::kTimeOfDay:
      return is_long + ("TOD#" + out) + std::to_string(literal.integer) + "ns";
    case LiteralKind::kDateAndTime:
      return is_long + ("DT#" + out) + std::to_string(literal.integer) + "ns";
  }
  return out;
}

std::string Printer::list(Range32 list) const {
  std::string out;
  for (uint32_t i = 0; i < list.count; ++i) {
    out += (i == 0 ? "" : ", ") + expression(tree_.expr_lists[list.first + i]);
  }
  return out;
}

std::string Printer::arguments(Range32 args) const {
  std::string out = "(";
  for (uint32_t i = 0; i < args.count; ++i) {
    const Arg& arg = tree_.args[args.first + i];
    if (i != 0) out += ", ";
    if (arg.negated) out += "NOT ";
    if (!arg.name.empty()) out += std::string(arg.name.text) + (arg.output ? " => " : " := ");
    out += expression(arg.value);
  }
  return out + ')';
}

}  // namespace frontend
