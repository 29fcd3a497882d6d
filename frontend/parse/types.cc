// TYPE blocks and type specifications other than enumerations and structures.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

namespace {

bool is_elementary_name(std::string_view name) {
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
    if (ir::same_name(name, ir::elementary_name(static_cast<ir::Kind>(i)))) return true;
  }
  return false;
}

}  // namespace

void Parser::parse_types() {
  const Token opening = take();
  while (kind() != TokenKind::kEndType) {
    if (accept(TokenKind::kSemicolon)) continue;
    bool stray = is_closing(kind()) && kind() != TokenKind::kEndType && !is_pou_end(kind());
    if (kind() == TokenKind::kEnd || is_file_level_start(kind()) || is_var_start(kind()) ||
        is_pou_end(kind())) {
      return report_missing_end(opening, TokenKind::kEndType);
    }
    if (stray || is_statement_keyword(kind())) {
      report_here(Code::kExpectedDeclaration,
                  "expected `name : type;` or `END_TYPE`, found " + describe(*current_));
      take();
      skip_to_declaration_end();
      continue;
    }
    parse_type();
  }
  take();
  accept(TokenKind::kSemicolon);
}

void Parser::parse_type() {
  TypeDecl decl;
  decl.name = parse_name("type");
  if (panic_ && !is_name(kind())) take();
  if (!panic_ && kind() == TokenKind::kExtends) {
    not_supported(take().span(), "derived structures (EXTENDS) are");
    parse_name("structure");
  }
  if (!panic_ && !expect(TokenKind::kColon, "behind the name of the type")) {
    panic_ = kind() != TokenKind::kStruct && kind() != TokenKind::kArray;
  }
  if (panic_) return skip_to_declaration_end();
  decl.spec = parse_spec();
  parse_default(decl.init);
  tree_.types.push_back(decl);
  finish_declaration("type");
}

SpecId Parser::add_spec(Spec spec) {
  tree_.specs.push_back(std::move(spec));
  return SpecId(static_cast<uint32_t>(tree_.specs.size() - 1));
}

SpecId Parser::error_spec(base::SourcePos begin) {
  Spec spec;
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

SpecId Parser::parse_spec() {
  Nesting nesting(*this);
  if (!nesting.entered()) return error_spec(here());
  switch (kind()) {
    case TokenKind::kArray:
      return parse_array_spec();
    case TokenKind::kStruct:
      return parse_struct();
    case TokenKind::kLeftParen:
      return parse_enum({}, here());
    case TokenKind::kStringType:
    case TokenKind::kWideStringType:
      return parse_string_spec();
    case TokenKind::kRefTo:
      return unsupported_reference();
    case TokenKind::kPointer:
    case TokenKind::kReference:
      if (next_kind() == TokenKind::kTo) return unsupported_reference();
      break;
    case TokenKind::kUnion: {
      base::SourcePos begin = here();
      not_supported(take().span(), "unions are");
      skip_block(TokenKind::kEndUnion);
      return error_spec(begin);
    }
    default:
      break;
  }
  if (is_name(kind())) return parse_named_spec();
  report_here(Code::kExpectedType, "a type belongs here, found " + describe(*current_));
  return error_spec(here());
}

// `INT`, `INT (0..10)`, `INT (Off, On)`
SpecId Parser::parse_named_spec() {
  base::SourcePos begin = here();
  Spec spec;
  spec.kind = SpecKind::kNamed;
  spec.name = name_of(take());
  while (kind() == TokenKind::kDot && is_name(next_kind())) {
    not_supported({begin, current_->span().end}, "types of a namespace or library are",
                  "write the name of the type alone");
    take();
    spec.name = name_of(take());
  }
  spec.span = span_from(begin);
  SpecId id = add_spec(std::move(spec));
  if (kind() != TokenKind::kLeftParen) return id;
  bool named = is_name(next_kind()) && peek(2).kind == TokenKind::kAssign;
  if (named && !is_elementary_name(tree_[id].name.text)) {
    not_supported(current_->span(), "arguments of FB_Init are");
    parse_arguments();
    return id;
  }
  return at_enumerators() ? parse_enum(id, begin) : parse_subrange(id, begin);
}

SpecId Parser::parse_subrange(SpecId base, base::SourcePos begin) {
  const Token open = take();
  Spec spec;
  spec.kind = SpecKind::kSubrange;
  spec.element = base;
  spec.low = parse_expression();
  if (!panic_) expect(TokenKind::kRange, "between the bounds");
  if (!panic_) spec.high = parse_expression();
  close_bracket(TokenKind::kRightParen, open);
  if (!spec.high.valid()) return error_spec(begin);
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

// STRING, STRING[20], STRING(20)
SpecId Parser::parse_string_spec() {
  base::SourcePos begin = here();
  Spec spec;
  spec.kind = SpecKind::kString;
  spec.wide = kind() == TokenKind::kWideStringType;
  spec.name = name_of(take());
  if (kind() == TokenKind::kLeftBracket || kind() == TokenKind::kLeftParen) {
    const Token open = take();
    spec.length = parse_expression();
    bool round = open.kind == TokenKind::kLeftParen;
    close_bracket(round ? TokenKind::kRightParen : TokenKind::kRightBracket, open);
  }
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

SpecId Parser::parse_array_spec() {
  base::SourcePos begin = here();
  take();
  Spec spec;
  spec.kind = SpecKind::kArray;
  const Token open = *current_;
  if (!expect(TokenKind::kLeftBracket, "behind ARRAY")) return error_spec(begin);
  bool open_bounds = kind() == TokenKind::kStar;
  do {
    DimSpec dim;
    if (open_bounds && accept(TokenKind::kStar)) continue;
    dim.low = parse_expression();
    if (!panic_) expect(TokenKind::kRange, "between the bounds");
    if (!panic_) dim.high = parse_expression();
    spec.dims.push_back(dim);
  } while (!panic_ && accept(TokenKind::kComma));
  close_bracket(TokenKind::kRightBracket, open);
  if (!panic_) expect(TokenKind::kOf, "behind the bounds");
  if (panic_) return error_spec(begin);
  if (open_bounds) not_supported(open.span(), "arrays with open bounds `[*]` are");
  spec.element = parse_spec();
  if (open_bounds) return error_spec(begin);
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

SpecId Parser::unsupported_reference() {
  base::SourcePos begin = here();
  not_supported(take().span(), "pointers and references are");
  accept(TokenKind::kTo);
  parse_spec();
  return error_spec(begin);
}

}  // namespace frontend
