// METHOD, PROPERTY, ACTION.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

bool Parser::takes_members(PouKind kind) {
  return kind == PouKind::kFunctionBlock || kind == PouKind::kProgram || kind == PouKind::kClass ||
         kind == PouKind::kInterface;
}

// METHOD, PROPERTY and ACTION are names elsewhere; two names side by side are never part of a
// statement.
bool Parser::at_member() const {
  bool word = kind() == TokenKind::kMethod || kind() == TokenKind::kProperty ||
              kind() == TokenKind::kAction;
  return word && is_name(next_kind());
}

// Does END_TEST come before the next TEST? Looks at each token once.
bool Parser::test_ends_later() {
  if (current_ < test_end_) return true;
  const Token* token = current_;
  for (; token != last_ && token->kind != TokenKind::kEndTest; ++token) {
    if (token->kind == TokenKind::kTest && token[1].kind == TokenKind::kString) return false;
  }
  if (token == last_) return false;
  test_end_ = token;
  return true;
}

// What belongs outside of the TEST in which it stands: reported, and declared all the same.
bool Parser::pass_misplaced(const PouDecl& pou) {
  const bool variables = kind() == TokenKind::kVarGlobal || kind() == TokenKind::kVarConfig;
  if (pou.kind != PouKind::kTest || (!variables && !at_member())) return false;
  if (!test_ends_later()) return false;
  const Range32 attributes = take_attributes();
  const std::string what = describe(*current_) + " cannot stand inside a TEST";
  if (variables) {
    note_only(Code::kWrongSection, current_->span(), what,
              "write it in front of TEST, or declare variables of the test with VAR");
    parse_var_block(tree_.globals, attributes);
  } else {
    note_only(Code::kMisplacedMember, current_->span(), what,
              "write it into the block that is tested, or as a FUNCTION in front of TEST");
    PouDecl dropped;
    parse_member(dropped, attributes);
  }
  return true;
}

void Parser::parse_member(PouDecl& owner, Range32 attributes) {
  if (kind() == TokenKind::kProperty) return parse_property(owner, attributes);
  PouKind member = kind() == TokenKind::kMethod ? PouKind::kMethod : PouKind::kAction;
  // Open statements of the body around belong to nothing inside the member.
  auto open = open_;
  open_.fill(0);
  open_[static_cast<uint8_t>(TokenKind::kEndInterface)] = owner.kind == PouKind::kInterface ? 1 : 0;
  member_of_ = &owner;
  PouDecl pou = parse_pou(member, attributes);
  member_of_ = nullptr;
  open_ = open;
  pou.scope = owner.scope;
  move_memory(pou, owner);
  if (!pou.name.empty()) owner.members.push_back(std::move(pou));
}

// PROPERTY [PUBLIC ...] name : type GET ... END_GET SET ... END_SET END_PROPERTY. Without GET and
// SET, statements are those of GET.
void Parser::parse_property(PouDecl& owner, Range32 attributes) {
  const Token* const first = current_;
  const Token opening = take();
  PouDecl head;
  head.kind = PouKind::kGetter;
  head.attributes = attributes;
  head.scope = owner.scope;
  parse_specifiers(head);
  head.name = parse_name("property");
  if (!panic_ && expect(TokenKind::kColon, "after the name of the property")) {
    head.result = parse_spec();
  }
  if (panic_) {
    while (!on_new_line() && !is_statement_boundary(kind())) take();
    panic_ = false;
  }
  auto open = open_;
  open_.fill(0);
  open_[static_cast<uint8_t>(TokenKind::kEndProperty)] = 1;
  size_t members = owner.members.size();
  const std::span said(first, current_);
  while (parse_accessor(head, said, owner, members)) {
  }
  open_ = open;
  if (owner.members.size() == members && kind() == TokenKind::kEndProperty) {
    note_only(Code::kBadProperty, opening.span(),
              "the property `" + std::string(head.name.text) + "` has neither GET nor SET",
              "write GET ... END_GET, SET ... END_SET, or both");
  }
  close_pou(opening, head, TokenKind::kEndProperty);
}

bool Parser::at_accessor() const {
  if (kind() != TokenKind::kGet && kind() != TokenKind::kSet) return false;
  return !follows_a_name(next_kind());
}

// One GET or SET; false when there is none. `said`: the tokens of the head. Accessors of this
// property begin at `first`.
bool Parser::parse_accessor(const PouDecl& head, std::span<const Token> said, PouDecl& owner,
                            size_t first) {
  if (accept(TokenKind::kSemicolon)) return true;
  Range32 attributes = take_attributes();
  bool explicit_accessor = at_accessor();
  if (!explicit_accessor && (owner.members.size() != first || list_ends(false))) return false;
  PouDecl accessor = head;
  accessor.attributes = join_attributes(head.attributes, attributes);
  base::SourcePos begin = here();
  TokenKind end = kind() == TokenKind::kSet ? TokenKind::kEndSet : TokenKind::kEndGet;
  if (kind() == TokenKind::kSet) accessor.kind = PouKind::kSetter;
  const Token* const begins = current_;
  const Token opening = *current_;
  if (explicit_accessor) {
    take();
    const bool access = is_access(kind()) && !follows_a_name(next_kind());
    if (access) accessor.access = access_of(take().kind);
  }
  in_property_ = true;
  ++open_[static_cast<uint8_t>(end)];
  parse_pou_variables(accessor);
  parse_pou_body(accessor);
  --open_[static_cast<uint8_t>(end)];
  in_property_ = false;
  accept(end);
  accept(TokenKind::kSemicolon);
  accessor.span = span_from(begin);
  accessor.content = content_of(begins, accessor, said);
  for (size_t i = first; i < owner.members.size(); ++i) {
    if (owner.members[i].kind != accessor.kind) continue;
    note_only(Code::kBadProperty, opening.span(),
              describe(opening) + " of `" + std::string(head.name.text) + "` stands here twice");
  }
  owner.members.push_back(std::move(accessor));
  return true;
}

}  // namespace frontend
