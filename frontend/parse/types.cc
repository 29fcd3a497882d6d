// TYPE blocks and type specifications other than enumerations and structures.
#include <utility>

#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

bool is_elementary_name(std::string_view name) {
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
    if (ir::same_name(name, ir::elementary_name(static_cast<ir::Kind>(i)))) return true;
  }
  return false;
}

void Parser::parse_types(Range32 attributes) {
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
    parse_type(join_attributes(attributes, take_attributes()));
  }
  take();
  accept(TokenKind::kSemicolon);
}

// name [EXTENDS base] : specification [:= value];
void Parser::parse_type(Range32 attributes) {
  TypeDecl decl;
  decl.attributes = attributes;
  decl.scope = scope_;
  if (is_access(kind()) && is_name(next_kind())) decl.access = access_of(take().kind);
  decl.name = parse_name("type");
  if (panic_ && !is_name(kind())) take();
  SpecId base;
  Token extends = *current_;
  if (!panic_ && accept(TokenKind::kExtends)) base = parse_type_name();
  if (!panic_ && !expect(TokenKind::kColon, "after the name of the type")) {
    panic_ = kind() != TokenKind::kStruct && kind() != TokenKind::kArray;
  }
  if (panic_) return skip_to_declaration_end();
  type_level_ = true;
  decl.spec = parse_spec();
  type_level_ = false;
  const SpecKind shape = tree_[decl.spec].kind;
  const bool structure = shape == SpecKind::kStruct || shape == SpecKind::kUnion;
  if (structure) tree_.specs[decl.spec.index].attributes = attributes;
  if (base.valid()) {
    if (structure) {
      tree_.specs[decl.spec.index].element = base;
    } else {
      note_only(Code::kBadInheritance, extends.span(),
                "only a STRUCT or UNION extends another type", "write `name : type;`");
    }
  }
  parse_default(decl.init);
  tree_.types.push_back(decl);
  finish_declaration("type");
}

SpecId Parser::add_spec(Spec spec) {
  make_room_for_one(tree_.specs);
  tree_.specs.push_back(std::move(spec));
  return SpecId(static_cast<uint32_t>(tree_.specs.size() - 1));
}

SpecId Parser::error_spec(base::SourcePos begin) {
  Spec spec;
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

SpecId Parser::parse_spec() {
  bool type_level = std::exchange(type_level_, false);
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
    case TokenKind::kUnicodeStringType:
      return parse_string_spec();
    case TokenKind::kUnion:
      return parse_struct();
    case TokenKind::kRefTo:
      return parse_reference(SpecKind::kRefTo);
    case TokenKind::kPointer:
      if (at_reference()) return parse_reference(SpecKind::kPointer);
      break;
    case TokenKind::kReference:
      if (at_reference()) return parse_reference(SpecKind::kReferenceTo);
      break;
    default:
      break;
  }
  if (is_name(kind())) return parse_named_spec(type_level);
  report_here(Code::kExpectedType, "a type belongs here, found " + describe(*current_));
  return error_spec(here());
}

// A.B.Name
SpecId Parser::parse_type_name() {
  base::SourcePos begin = here();
  Spec spec;
  spec.kind = SpecKind::kNamed;
  spec.name = parse_name("type");
  parse_qualified(spec.qualifiers, spec.name);
  if (panic_) spec.kind = SpecKind::kError;
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

// What follows the first name of A.B.Name, which becomes a qualifier itself.
void Parser::parse_qualified(Range32& qualifiers, Name& name) {
  qualifiers.first = static_cast<uint32_t>(tree_.names.size());
  while (!panic_ && kind() == TokenKind::kDot && is_name(next_kind())) {
    tree_.names.push_back(name);
    ++qualifiers.count;
    take();
    name = name_of(take());
  }
}

// `INT`, `INT (0..10)`, `INT (Off, On)`, `Pump (5)`. A type other than the elementary ones
// has literals after it only where a TYPE is declared.
SpecId Parser::parse_named_spec(bool type_level) {
  base::SourcePos begin = here();
  SpecId id = parse_type_name();
  if (kind() != TokenKind::kLeftParen || panic_) return id;
  const Spec& named = tree_[id];
  bool elementary = named.qualifiers.count == 0 && is_elementary_name(named.name.text);
  if ((elementary || type_level) && at_enumerators()) return parse_enum(id, begin);
  if (elementary || at_subrange()) return parse_subrange(id, begin);
  parse_init_arguments(id);
  return id;
}

// Is there a `..` in the parentheses that open here?
bool Parser::at_subrange() const {
  static constexpr size_t kLongestBound = 64;
  uint32_t depth = 0;
  for (size_t at = 0; at < kLongestBound; ++at) {
    TokenKind ahead = peek(at).kind;
    if (ahead == TokenKind::kLeftParen) ++depth;
    if (ahead == TokenKind::kRightParen && --depth == 0) return false;
    if (ahead == TokenKind::kRange && depth == 1) return true;
    if (ahead == TokenKind::kSemicolon || ahead == TokenKind::kEnd) return false;
  }
  return false;
}

// Pump(5), Pump(speed := 5): arguments of FB_Init
void Parser::parse_init_arguments(SpecId named) {
  Range32 args = parse_arguments();
  Spec& spec = tree_.specs[named.index];
  spec.has_args = true;
  spec.args = args;
  spec.span.end = last_end();
}

// ARRAY[0..1] OF Pump[(1), (2)]
Range32 Parser::parse_element_arguments() {
  const Token open = take();
  size_t mark = expr_stack_.size();
  while (kind() == TokenKind::kLeftParen) {
    expr_stack_.push_back(parse_struct_initializer());
    if (panic_ || !accept(TokenKind::kComma)) break;
  }
  close_bracket(TokenKind::kRightBracket, open);
  return move_tail(expr_stack_, mark, tree_.expr_lists);
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
  if (!expect(TokenKind::kLeftBracket, "after ARRAY")) return error_spec(begin);
  spec.open_bounds = kind() == TokenKind::kStar;
  do {
    DimSpec dim;
    if (!spec.open_bounds || !accept(TokenKind::kStar)) {
      dim.low = parse_expression();
      if (!panic_) expect(TokenKind::kRange, "between the bounds");
      if (!panic_) dim.high = parse_expression();
    }
    spec.dims.push_back(dim);
  } while (!panic_ && accept(TokenKind::kComma));
  close_bracket(TokenKind::kRightBracket, open);
  if (!panic_) expect(TokenKind::kOf, "after the bounds");
  if (panic_) return error_spec(begin);
  spec.element = parse_spec();
  if (kind() == TokenKind::kLeftBracket && next_kind() == TokenKind::kLeftParen) {
    spec.element_args = parse_element_arguments();
  }
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

// After POINTER or REFERENCE: TO, or the type itself when TO is forgotten.
bool Parser::at_reference() const {
  TokenKind next = next_kind();
  return next == TokenKind::kTo || next == TokenKind::kArray || is_name(next);
}

// POINTER TO T, REF_TO T, REFERENCE TO T
SpecId Parser::parse_reference(SpecKind reference) {
  Spec spec;
  spec.kind = reference;
  base::SourcePos begin = {take().begin};
  if (reference != SpecKind::kRefTo && !accept(TokenKind::kTo)) {
    note_only(Code::kExpected, current_->span(),
              "expected `TO` after " + describe(current_[-1]) + ", found " + describe(*current_));
  }
  spec.element = parse_spec();
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

}  // namespace frontend
