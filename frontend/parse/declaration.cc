// The file level, and namespaces, in which the same declarations stand.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {
namespace {

// Where a word of unit tests begins no declaration: how it is written.
const char* test_fix(TokenKind kind) {
  switch (kind) {
    case TokenKind::kTest:
      return "a test has its name in quotes: TEST 'pump starts' ... END_TEST";
    case TokenKind::kMock:
    case TokenKind::kMockFunction:
      return "put this statement into a TEST or its SETUP";
    default:
      return "";
  }
}

}  // namespace

void Parser::parse_file() {
  const base::SourcePos begin = here();
  open_scope({}, false);
  while (kind() != TokenKind::kEnd) {
    parse_declaration();
    panic_ = false;
  }
  report_lost_rules();
  tree_.scopes[scope_.index].span = {begin, current_->span().end};
}

void Parser::open_scope(const Name& name, bool internal) {
  Scope scope;
  scope.name = name;
  scope.parent = scope_;
  scope.internal = internal;
  scope_ = ScopeId(static_cast<uint32_t>(tree_.scopes.size()));
  tree_.scopes.push_back(std::move(scope));
}

void Parser::parse_declaration() {
  if (accept(TokenKind::kSemicolon)) return;
  Range32 attributes = take_attributes();
  switch (kind()) {
    case TokenKind::kType:
      return parse_types(attributes);
    case TokenKind::kVarGlobal:
    case TokenKind::kVarConfig:
      return parse_var_block(tree_.globals, attributes);
    case TokenKind::kConfiguration:
      return parse_configuration(attributes);
    default:
      break;
  }
  if (auto pou_kind = pou_kind_here()) return parse_file_pou(*pou_kind, attributes);
  if (at_member()) return parse_outside_member(attributes);
  if (kind() == TokenKind::kNamespace && is_name(next_kind())) return parse_namespace();
  if (kind() == TokenKind::kUsing && is_name(next_kind())) {
    return parse_using(tree_.scopes[scope_.index].usings);
  }
  if (is_var_start(kind())) {
    report_here(Code::kWrongSection,
                describe(*current_) + " belongs into a POU; outside of POUs there is VAR_GLOBAL");
    skip_block(TokenKind::kEndVar);
    return;
  }
  if (skip_stray_diagram() || skip_stray_chart_element()) return;
  report_here(is_closing(kind()) ? Code::kUnexpectedEnd : Code::kExpectedDeclaration,
              is_closing(kind())
                  ? describe(*current_) + " stands here, but nothing that it belongs to is open"
                  : "expected a declaration such as PROGRAM or TYPE, found " + describe(*current_),
              test_fix(kind()));
  skip_to_next_declaration();
}

void Parser::parse_file_pou(PouKind pou_kind, Range32 attributes) {
  PouDecl pou = parse_pou(pou_kind, attributes);
  if (pou_kind >= PouKind::kTest) {
    tree_.tests.push_back(std::move(pou));
  } else if (!pou.name.empty()) {
    owner_ = static_cast<uint32_t>(tree_.pous.size());
    tree_.pous.push_back(std::move(pou));
  }
}

// Exported sources write methods and actions after the POU that they belong to.
void Parser::parse_outside_member(Range32 attributes) {
  bool owned = owner_ != kNoOwner && takes_members(tree_.pous[owner_].kind);
  if (owned) {
    PouDecl& owner = tree_.pous[owner_];
    parse_member(owner, attributes);
    owner.exprs.count = tree_.exprs.of_bodies() - owner.exprs.first;
    return take_actions(owner);
  }
  note_only(
      Code::kMisplacedMember, current_->span(),
      describe(*current_) + " stands outside of a POU, and after none that it could belong to",
      "move it into its FUNCTION_BLOCK, CLASS or PROGRAM, or after it");
  PouDecl dropped;
  parse_member(dropped, attributes);
}

// NAMESPACE [INTERNAL] A.B ... END_NAMESPACE
void Parser::parse_namespace() {
  const Token opening = take();
  const ScopeId outer = scope_;
  const uint32_t outer_depth = depth_;
  const size_t first = tree_.scopes.size();
  if (open_namespaces()) {
    const size_t behind = tree_.scopes.size();
    owner_ = kNoOwner;
    while (kind() != TokenKind::kEndNamespace && kind() != TokenKind::kEnd) {
      parse_declaration();
      panic_ = false;
    }
    if (!accept(TokenKind::kEndNamespace)) report_missing_end(opening, TokenKind::kEndNamespace);
    for (size_t i = first; i < behind; ++i) tree_.scopes[i].span = span_from({opening.begin});
    accept(TokenKind::kSemicolon);
  } else {
    skip_past(TokenKind::kEndNamespace);
  }
  depth_ = outer_depth;
  scope_ = outer;
  owner_ = kNoOwner;
}

// [INTERNAL] A.B: a scope for each name. False, after a report, when nested too deeply.
bool Parser::open_namespaces() {
  const bool internal = kind() == TokenKind::kInternal && is_name(next_kind());
  if (internal) take();
  do {
    if (!enter()) return false;
    const Name name = parse_name("namespace");
    if (panic_) break;
    open_scope(name, internal);
  } while (accept(TokenKind::kDot));
  panic_ = false;
  return true;
}

// USING A.B, C;
void Parser::parse_using(std::vector<Range32>& out) {
  take();
  do {
    Range32 path = parse_path("namespace");
    if (path.count != 0) out.push_back(path);
  } while (!panic_ && accept(TokenKind::kComma));
  finish_declaration("USING");
}

// A.B.C
Range32 Parser::parse_path(const char* what) {
  Range32 out{static_cast<uint32_t>(tree_.names.size()), 0};
  do {
    Name name = parse_name(what);
    if (panic_) break;
    tree_.names.push_back(name);
    ++out.count;
  } while (accept(TokenKind::kDot));
  return out;
}

void Parser::skip_to_next_declaration() {
  do {
    take();
  } while (kind() != TokenKind::kEnd && !is_file_level_start(kind()) && !at_soft_declaration() &&
           !(kind() == TokenKind::kEndNamespace && tree_.in_namespace(scope_)));
}

}  // namespace frontend
