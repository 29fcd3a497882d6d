#include "frontend/parse/parser.h"

namespace frontend {

ExprId Parser::add_literal(const Literal& literal, base::SourceSpan span) {
  Expr expr;
  expr.kind = ExprKind::kLiteral;
  expr.span = span;
  expr.number = static_cast<uint32_t>(tree_.literals.size());
  tree_.literals.push_back(literal);
  return add_expression(expr);
}

ExprId Parser::parse_literal(const Name& prefix, base::SourcePos begin, bool negative) {
  const Token token = take();
  Literal literal;
  literal.negative = negative;
  if (!prefix.empty()) literal.prefix = tree_.add_name(prefix);
  decode_literal(token, literal);
  return add_literal(literal, span_from(begin));
}

void Parser::decode_literal(const Token& token, Literal& literal) {
  switch (token.kind) {
    case TokenKind::kInteger: {
      DecodedInteger integer = decode_integer(text(token));
      if (integer.problem) report_problem(*integer.problem, token);
      literal.integer = integer.value;
      literal.based = integer.based;
      literal.too_large = integer.too_large;
      break;
    }
    case TokenKind::kReal: {
      DecodedReal real = decode_real(text(token));
      if (real.problem) report_problem(*real.problem, token);
      literal.kind = LiteralKind::kReal;
      literal.real = real.value;
      break;
    }
    case TokenKind::kString:
    case TokenKind::kWideString: {
      bool wide = token.kind == TokenKind::kWideString;
      DecodedString string = wide ? decode_wide_string(text(token), list_.latin1)
                                  : decode_string(text(token), charset_of(literal));
      if (string.problem) report_problem(*string.problem, token);
      literal.kind = wide ? LiteralKind::kWstring : LiteralKind::kString;
      literal.text = static_cast<uint32_t>(tree_.texts.size());
      tree_.texts.push_back(std::move(string.bytes));
      break;
    }
    case TokenKind::kDuration:
      literal.kind = LiteralKind::kDuration;
      store_time(decode_duration(text(token)), token, literal);
      break;
    case TokenKind::kDate:
      decode_date_literal(token, literal);
      break;
    default:
      literal.kind = LiteralKind::kBool;
      literal.integer = token.kind == TokenKind::kTrue ? 1 : 0;
  }
}

// USTRING#'...' and UTF8#'...' (CODESYS) are STRING literals that keep the bytes of UTF-8.
StringCharset Parser::charset_of(const Literal& literal) {
  bool latin1 = list_.latin1;
  const std::string_view prefix = tree_.name(literal.prefix).text;
  if (ir::same_name(prefix, "USTRING") || ir::same_name(prefix, "UTF8")) {
    tree_.names[literal.prefix].text = "STRING";
    return latin1 ? StringCharset::kLatin1ToUtf8 : StringCharset::kUtf8SourceBytes;
  }
  return latin1 ? StringCharset::kLatin1Source : StringCharset::kUtf8Source;
}

void Parser::decode_date_literal(const Token& token, Literal& literal) {
  DecodedDate date = decode_date(text(token));
  literal.kind = date.form == DateForm::kDate        ? LiteralKind::kDate
                 : date.form == DateForm::kTimeOfDay ? LiteralKind::kTimeOfDay
                                                     : LiteralKind::kDateAndTime;
  store_time(date.time, token, literal);
}

void Parser::store_time(const DecodedTime& time, const Token& token, Literal& literal) {
  if (time.problem) report_problem(*time.problem, token);
  literal.integer = time.ns;
  literal.negative = time.negative;
  literal.is_long = time.is_long;
}

// `INT#` without its `#`
Name Parser::prefix_of(const Token& token) const {
  std::string_view prefix = text(token);
  prefix.remove_suffix(1);
  return {prefix, {{token.begin}, {token.begin + token.length - 1}}};
}

// `INT#-5`, `WORD#16#AF`, `BOOL#TRUE`, `STRING#'x'`, `Color#Red`
ExprId Parser::parse_typed_literal() {
  const Token token = take();
  Name prefix = prefix_of(token);
  base::SourcePos begin{token.begin};
  bool sign = kind() == TokenKind::kMinus || kind() == TokenKind::kPlus;
  TokenKind value = sign ? next_kind() : kind();
  if (value == TokenKind::kInteger || value == TokenKind::kReal) {
    bool negative = sign && take().kind == TokenKind::kMinus;
    return parse_literal(prefix, begin, negative);
  }
  bool other_literal = value == TokenKind::kString || value == TokenKind::kWideString ||
                       value == TokenKind::kTrue || value == TokenKind::kFalse;
  if (!sign && other_literal) return parse_literal(prefix, begin, false);
  if (!is_name(kind())) {
    report(Code::kBadTypedLiteral, span_from(begin),
           "a literal or the name of an enumeration literal belongs after " + describe(token) +
               ", found " + describe(*current_));
    return error_expression();
  }
  Expr expr;
  expr.kind = ExprKind::kQualified;
  expr.number = tree_.add_name(prefix);
  expr.name = name_of(take());
  expr.span = span_from(begin);
  return add_expression(expr);
}

DecodedAddress Parser::parse_direct_address(const Token& token) {
  DecodedAddress decoded = decode_address(text(token));
  if (decoded.problem) report_problem(*decoded.problem, token);
  return decoded;
}

Range32 Parser::add_levels(const std::vector<uint32_t>& levels) {
  Range32 out{static_cast<uint32_t>(tree_.levels.size()), static_cast<uint32_t>(levels.size())};
  tree_.levels.insert(tree_.levels.end(), levels.begin(), levels.end());
  return out;
}

}  // namespace frontend
