// FUNCTION, FUNCTION_BLOCK, PROGRAM, CLASS, INTERFACE, TEST: head, variables, members, body.
#include "frontend/parse/instruction_list.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

namespace {

struct PouForm {
  PouKind kind;
  TokenKind begin;
  TokenKind end;
  const char* what;
};
constexpr PouForm kForms[] = {
    {PouKind::kFunction, TokenKind::kFunction, TokenKind::kEndFunction, "function"},
    {PouKind::kFunctionBlock, TokenKind::kFunctionBlock, TokenKind::kEndFunctionBlock,
     "function block"},
    {PouKind::kProgram, TokenKind::kProgram, TokenKind::kEndProgram, "program"},
    {PouKind::kClass, TokenKind::kClass, TokenKind::kEndClass, "class"},
    {PouKind::kInterface, TokenKind::kInterface, TokenKind::kEndInterface, "interface"},
    {PouKind::kMethod, TokenKind::kMethod, TokenKind::kEndMethod, "method"},
    {PouKind::kAction, TokenKind::kAction, TokenKind::kEndAction, "action"},
    {PouKind::kGetter, TokenKind::kGet, TokenKind::kEndGet, "property"},
    {PouKind::kSetter, TokenKind::kSet, TokenKind::kEndSet, "property"},
    {PouKind::kTest, TokenKind::kTest, TokenKind::kEndTest, "test"},
    {PouKind::kSetup, TokenKind::kSetup, TokenKind::kEndSetup, "setup"},
    {PouKind::kTeardown, TokenKind::kTeardown, TokenKind::kEndTeardown, "teardown"},
    {PouKind::kMockFunction, TokenKind::kMockFunction, TokenKind::kEndMockFunction,
     "mock function"},
};

const PouForm& form_of(PouKind kind) { return kForms[static_cast<uint8_t>(kind)]; }

bool has_result(PouKind kind) {
  return kind == PouKind::kFunction || kind == PouKind::kMethod || kind == PouKind::kMockFunction;
}

}  // namespace

// What begins here, unless it is a member of a POU or a name.
std::optional<PouKind> Parser::pou_kind_here() const {
  switch (kind()) {
    case TokenKind::kFunction:
      return PouKind::kFunction;
    case TokenKind::kFunctionBlock:
      return PouKind::kFunctionBlock;
    case TokenKind::kProgram:
      return PouKind::kProgram;
    case TokenKind::kSetup:
      return PouKind::kSetup;
    case TokenKind::kTeardown:
      return PouKind::kTeardown;
    case TokenKind::kTest:
      if (next_kind() == TokenKind::kString) return PouKind::kTest;
      return std::nullopt;
    default:
      break;
  }
  if (!is_name(next_kind())) return std::nullopt;
  if (kind() == TokenKind::kClass) return PouKind::kClass;
  if (kind() == TokenKind::kInterface) return PouKind::kInterface;
  if (kind() == TokenKind::kMockFunction) return PouKind::kMockFunction;
  return std::nullopt;
}

// CLASS, INTERFACE, NAMESPACE, TEST are names elsewhere; two names side by side are
// never part of a statement.
bool Parser::at_soft_declaration() const {
  if (kind() == TokenKind::kTest) return next_kind() == TokenKind::kString;
  bool named = kind() == TokenKind::kClass || kind() == TokenKind::kInterface ||
               kind() == TokenKind::kNamespace;
  return named && is_name(next_kind());
}

PouDecl Parser::parse_pou(PouKind pou_kind, Range32 attributes) {
  const Token* const first = current_;
  const Token opening = take();
  const PouForm& form = form_of(pou_kind);
  PouDecl pou;
  pou.kind = pou_kind;
  pou.attributes = attributes;
  pou.scope = scope_;
  const ExprStore::As declared(tree_.exprs, ExprStore::Use::kDeclarations);
  const uint32_t of_bodies = tree_.exprs.of_bodies();
  parse_pou_header(pou);
  if (panic_) {  // the rest of the head line is lost, the body is not
    while (!on_new_line() && !is_statement_boundary(kind())) take();
    panic_ = false;
  }
  ++open_[static_cast<uint8_t>(form.end)];
  if (pou_kind != PouKind::kAction) parse_pou_variables(pou);
  parse_pou_body(pou);
  --open_[static_cast<uint8_t>(form.end)];
  close_pou(opening, pou, form.end);
  pou.span = span_from({opening.begin});
  pou.exprs = {of_bodies, tree_.exprs.of_bodies() - of_bodies};
  pou.content = content_of(first, pou);
  return pou;
}

void Parser::parse_pou_header(PouDecl& pou) {
  parse_specifiers(pou);
  const char* what = form_of(pou.kind).what;
  if (pou.kind == PouKind::kTest) {
    pou.name = name_of(take());
    pou.name.text = pou.name.text.substr(1, pou.name.text.size() - (swallowed_by_string() ? 1 : 2));
    return;
  }
  if (pou.kind == PouKind::kSetup || pou.kind == PouKind::kTeardown) return;
  pou.name = parse_name(what);
  if (pou.kind == PouKind::kMockFunction) parse_qualified(pou.qualifiers, pou.name);
  if (panic_) return;
  while (kind() == TokenKind::kUsing && is_name(next_kind())) parse_using(pou.usings);
  parse_inheritance(pou);
  if (pou.kind == PouKind::kAction) {
    accept(TokenKind::kColon);
    return;
  }
  if (kind() != TokenKind::kColon) {
    // Nothing else is a name in front of variables.
    if (!has_result(pou.kind) || !is_name(kind()) || !is_var_start(next_kind())) return;
    note_only(Code::kExpected, current_->span(), "expected `:` in front of the type of the result",
              "write `NAME : TYPE`");
    pou.result = parse_spec();
    return;
  }
  const Token colon = take();
  SpecId result = parse_spec();
  if (has_result(pou.kind)) {
    pou.result = result;
  } else {
    note_only(Code::kExpected, colon.span(), with_article(what) + " has no result type",
              "declare VAR_OUTPUT variables instead");
  }
}

// PUBLIC PRIVATE PROTECTED INTERNAL, ABSTRACT FINAL OVERRIDE, in any order.
void Parser::parse_specifiers(PouDecl& pou) {
  for (; is_specifier(kind()) && is_name(next_kind()); take()) {
    if (next_kind() == TokenKind::kExtends || next_kind() == TokenKind::kImplements) return;
    bool* flag = kind() == TokenKind::kAbstract   ? &pou.is_abstract
                 : kind() == TokenKind::kFinal    ? &pou.is_final
                 : kind() == TokenKind::kOverride ? &pou.is_override
                                                  : nullptr;
    bool repeated = flag == nullptr ? pou.access != Access::kDefault : *flag;
    if (flag == nullptr) {
      pou.access = access_of(kind());
    } else {
      *flag = true;
    }
    if (repeated || (pou.is_abstract && pou.is_final)) {
      note_only(Code::kBadSpecifier, current_->span(),
                describe(*current_) + " contradicts or repeats a word in front of it",
                "keep one of PUBLIC, PRIVATE, PROTECTED, INTERNAL, and one of ABSTRACT, FINAL");
    }
  }
}

// The words are names in the first statement of a body.
bool Parser::at_inheritance() const {
  if (kind() != TokenKind::kExtends && kind() != TokenKind::kImplements) return false;
  return is_name(next_kind()) || is_keyword(next_kind());
}

// EXTENDS A, B IMPLEMENTS C, D
void Parser::parse_inheritance(PouDecl& pou) {
  while (at_inheritance()) {
    const Token word = take();
    bool extends = word.kind == TokenKind::kExtends;
    std::vector<SpecId>& list = extends ? pou.extends : pou.implements;
    do {
      list.push_back(parse_type_name());
    } while (!panic_ && accept(TokenKind::kComma));
    bool block = pou.kind == PouKind::kFunctionBlock || pou.kind == PouKind::kClass;
    bool allowed = block || (pou.kind == PouKind::kInterface && extends);
    if (!allowed) {
      note_only(Code::kBadInheritance, word.span(),
                with_article(form_of(pou.kind).what) + " has no " + describe(word),
                "only function blocks, classes and interfaces have a base");
    } else if (block && pou.extends.size() > 1) {
      note_only(Code::kBadInheritance, tree_[pou.extends[1]].span,
                "a function block or class has one base only",
                "give the others as INTERFACE after IMPLEMENTS");
    }
  }
}

// Variables, USING and the first members: everything in front of the first statement.
void Parser::parse_pou_variables(PouDecl& pou) {
  for (;;) {
    if (accept(TokenKind::kSemicolon)) continue;
    if (kind() == TokenKind::kUsing && is_name(next_kind())) {
      parse_using(pou.usings);
    } else if (at_var_block()) {
      // After a POU whose end is missing, VAR_GLOBAL begins something new.
      bool foreign = kind() == TokenKind::kVarConfig ||
                     (kind() == TokenKind::kVarGlobal && pou.kind != PouKind::kProgram);
      if (!foreign) {
        parse_var_block(pou.blocks, take_attributes());
      } else if (!pass_misplaced(pou)) {
        return;
      }
    } else if (!parse_inner(pou)) {
      return;
    }
  }
}

// A member here, or a mocked function of a test.
bool Parser::parse_inner(PouDecl& pou) {
  if (pou.kind == PouKind::kTest && at_mock_function_block()) {
    Range32 attributes = take_attributes();
    pou.members.push_back(parse_pou(PouKind::kMockFunction, attributes));
    return true;
  }
  if (pou.kind >= PouKind::kMethod || !at_member()) return false;
  if (!takes_members(pou.kind)) {
    note_only(
        Code::kMisplacedMember, current_->span(),
        with_article(form_of(pou.kind).what) + " has no members such as " + describe(*current_),
        "make it a FUNCTION_BLOCK, or a function of its own");
  }
  parse_member(pou, take_attributes());
  return true;
}

void Parser::parse_pou_body(PouDecl& pou) {
  size_t mark = statement_stack_.size();
  base::SourcePos begin = here();
  const base::SourcePos code_begin = last_end();
  const size_t members = pou.members.size();
  const ExprStore::As in_body(tree_.exprs, ExprStore::Use::kBodies);
  for (;;) {
    if (parse_inner(pou) || parse_chart_element(pou)) continue;
    bool drawn = pou.diagram != kNoDiagram;
    if (at_diagram()) {
      if (statement_stack_.size() != mark || drawn || pou.chart != kNoChart) report_mixed_body();
      parse_diagram(pou);
      continue;
    }
    if (!list_ends(false)) {
      if (drawn && kind() != TokenKind::kSemicolon) report_mixed_body();
      bool first = statement_stack_.size() == mark;
      first&& at_instruction_list() ? InstructionList(*this).body() : parse_statement();
    } else if (!parse_inner(pou) && !parse_chart_element(pou) &&  // after a stray END_x
               !pass_misplaced(pou)) {
      break;
    }
  }
  pou.body = move_tail(statement_stack_, mark, tree_.stmt_lists);
  const bool only_statements =
      pou.members.size() == members && pou.chart == kNoChart && pou.diagram == kNoDiagram;
  if (only_statements) pou.code = {code_begin, here()};
  finish_chart(pou);
  bool bodiless = pou.kind == PouKind::kClass || pou.kind == PouKind::kInterface;
  if (!bodiless || pou.body.count == 0) return;
  base::SourceSpan first = tree_[tree_.stmt_lists[pou.body.first]].span;
  note_only(Code::kNoBody, first.begin.valid() ? first : base::SourceSpan{begin, begin},
            with_article(form_of(pou.kind).what) + " has no statements of its own",
            "put them into a METHOD");
}

void Parser::close_pou(const Token& opening, const PouDecl& pou, TokenKind end) {
  if (accept(end)) {
    accept(TokenKind::kSemicolon);
    return;
  }
  bool member = pou.kind >= PouKind::kMethod;
  bool wrong_end = member ? is_member_end(kind()) : is_pou_end(kind());
  // Methods of an interface have nothing that their end would close.
  if (member && open_[static_cast<uint8_t>(TokenKind::kEndInterface)] != 0 && pou.body.count == 0 &&
      (at_member() || kind() == TokenKind::kEndInterface)) {
    return;
  }
  if (!wrong_end) return report_missing_end(opening, end);
  const Token wrong = take();
  base::Diagnostic diagnostic{
      Code::kUnexpectedEnd,
      wrong.span(),
      describe(wrong) + " closes a " + std::string(token_text(opening.kind)),
      "write `" + std::string(token_text(end)) + '`',
      {}};
  diagnostic.notes.push_back({opening.span(), "it was opened here"});
  diagnostics_.add(std::move(diagnostic));
  accept(TokenKind::kSemicolon);
}

}  // namespace frontend
