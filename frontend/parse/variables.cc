// VAR blocks and the declarations inside them.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

namespace {

VarSection section_of(TokenKind kind) {
  switch (kind) {
    case TokenKind::kVarInput:
      return VarSection::kInput;
    case TokenKind::kVarOutput:
      return VarSection::kOutput;
    case TokenKind::kVarInOut:
      return VarSection::kInOut;
    case TokenKind::kVarTemp:
      return VarSection::kTemp;
    case TokenKind::kVarExternal:
      return VarSection::kExternal;
    case TokenKind::kVarGlobal:
      return VarSection::kGlobal;
    case TokenKind::kVarStat:
      return VarSection::kStatic;
    case TokenKind::kVarInst:
      return VarSection::kInstance;
    case TokenKind::kVarAccess:
      return VarSection::kAccess;
    case TokenKind::kVarConfig:
      return VarSection::kConfig;
    default:
      return VarSection::kLocal;
  }
}

}  // namespace

bool Parser::at_var_block() const { return is_var_start(kind()); }

void Parser::parse_var_block(std::vector<VarBlock>& blocks, Range32 attributes) {
  const Token opening = take();
  VarBlock block;
  block.section = section_of(opening.kind);
  block.attributes = attributes;
  block.scope = scope_;
  block.goes_on = attributes.count == 0 && !blocks.empty() && current_ - first_ > 1 &&
                  current_[-2].kind == TokenKind::kEndVar;
  parse_qualifiers(block);
  block.span = span_from({opening.begin});
  const size_t mark = var_stack_.size();
  parse_variables(block, opening);
  block.vars = take_variables(mark);
  blocks.push_back(std::move(block));
}

// CONSTANT, RETAIN, ... are qualifiers unless they are the first variable's name.
void Parser::parse_qualifiers(VarBlock& block) {
  for (;; take()) {
    TokenKind next = next_kind();
    if (next == TokenKind::kColon || next == TokenKind::kComma || next == TokenKind::kAt) return;
    switch (kind()) {
      case TokenKind::kConstant:
        block.constant = true;
        break;
      case TokenKind::kRetain:
      case TokenKind::kPersistent:
        block.retain = true;
        break;
      case TokenKind::kNonRetain:
        block.non_retain = true;
        break;
      case TokenKind::kPublic:
      case TokenKind::kPrivate:
      case TokenKind::kProtected:
      case TokenKind::kInternal:
        if (block.access != Access::kDefault) {
          note_only(Code::kBadSpecifier, current_->span(),
                    describe(*current_) + " contradicts or repeats a word in front of it",
                    "keep one of PUBLIC, PRIVATE, PROTECTED and INTERNAL");
        }
        block.access = access_of(kind());
        break;
      default:
        return;
    }
    int kinds = (block.constant ? 1 : 0) + (block.retain ? 1 : 0) + (block.non_retain ? 1 : 0);
    if (kinds > 1) {
      note_only(Code::kBadQualifier, current_->span(),
                describe(*current_) + " contradicts a qualifier in front of it",
                "keep one of CONSTANT, RETAIN and NON_RETAIN");
    }
  }
}

void Parser::parse_variables(VarBlock& block, const Token& opening) {
  while (kind() != TokenKind::kEndVar) {
    if (accept(TokenKind::kSemicolon)) continue;
    if (variables_end()) return report_missing_end(opening, TokenKind::kEndVar);
    if (block.section == VarSection::kAccess) {
      parse_access_path();
    } else if (block.section == VarSection::kConfig) {
      parse_config_variable();
    } else {
      parse_variable_declaration();
    }
  }
  take();
  accept(TokenKind::kSemicolon);
}

// Is END_VAR missing here? Keywords tell; what looks like a statement tells when
// no END_VAR follows before the next block or the end of the POU.
bool Parser::variables_end() {
  if (kind() == TokenKind::kEnd || is_closing(kind()) || is_var_start(kind()) ||
      is_file_level_start(kind())) {
    return true;
  }
  if (at_member() || at_soft_declaration() || at_chart_element()) return !end_var_ahead();
  TokenKind next = next_kind();
  bool statement =
      is_statement_keyword(kind()) ||
      (is_name(kind()) && (next == TokenKind::kAssign || next == TokenKind::kLeftParen ||
                           next == TokenKind::kDot || next == TokenKind::kLeftBracket));
  return statement && !end_var_ahead();
}

// Scans once per block: the answer holds up to the place where the scan ended.
bool Parser::end_var_ahead() {
  auto ends_scan = [](TokenKind kind) {
    return kind == TokenKind::kEndVar || is_var_start(kind) || is_file_level_start(kind) ||
           is_pou_end(kind);
  };
  if (var_scan_end_ < current_) var_scan_end_ = current_;
  while (var_scan_end_ != last_ && !ends_scan(var_scan_end_->kind)) ++var_scan_end_;
  return var_scan_end_->kind == TokenKind::kEndVar;
}

base::SlimVector<VarDecl> Parser::take_variables(size_t mark) {
  base::SlimVector<VarDecl> taken;
  taken.reserve(var_stack_.size() - mark);
  for (size_t i = mark; i < var_stack_.size(); ++i) taken.push_back(std::move(var_stack_[i]));
  var_stack_.resize(mark);
  return taken;
}

void Parser::parse_variable_declaration() {
  VarDecl decl;
  decl.attributes = take_attributes();
  base::SourcePos begin = here();
  // `AT %IW3 : INT;` declares the address itself (IEC 61131-3 6.5.5): its text is the name.
  bool unnamed = kind() == TokenKind::kAt && next_kind() == TokenKind::kDirect;
  if (unnamed) decl.names.push_back(name_of(peek(1)));
  while (!unnamed) {
    Name name = parse_name("variable");
    if (panic_) {
      if (!is_closing(kind())) take();
      return skip_to_declaration_end();
    }
    decl.names.push_back(name);
    if (!accept(TokenKind::kComma)) break;
  }
  parse_location(decl);
  if (!panic_ && kind() == TokenKind::kAssign) {
    report_here(Code::kExpected, "a declaration needs a type: expected `:` after the name",
                "write `name : type := value;`");
  }
  if (!panic_) expect(TokenKind::kColon, "after the name of the variable");
  if (panic_) return skip_to_declaration_end();
  decl.spec = parse_spec();
  decl.edge = parse_edge();
  parse_default(decl.init, &decl.binds);
  decl.span = span_from(begin);
  make_room_for_one(var_stack_);
  var_stack_.push_back(std::move(decl));
  finish_declaration("declaration");
}

// AT %QX0.0
void Parser::parse_location(VarDecl& decl) {
  if (!accept(TokenKind::kAt)) return;
  if (kind() != TokenKind::kDirect) {
    return report_here(
        Code::kBadDirectAddress,
        "a direct address such as %QX0.0 belongs after AT, found " + describe(*current_));
  }
  DecodedAddress decoded = parse_direct_address(take());
  decl.has_address = !decoded.problem;
  decl.incomplete = decoded.incomplete;
  decl.address = decoded.address;
  decl.levels = add_levels(decoded.levels);
}

Edge Parser::parse_edge() {
  if (accept(TokenKind::kRisingEdge)) return Edge::kRising;
  return accept(TokenKind::kFallingEdge) ? Edge::kFalling : Edge::kNone;
}

// VAR_ACCESS: name : Resource.Program.x : INT READ_WRITE;
void Parser::parse_access_path() {
  VarDecl decl;
  decl.attributes = take_attributes();
  base::SourcePos begin = here();
  decl.names.push_back(parse_name("access path"));
  if (!panic_) expect(TokenKind::kColon, "after the name of the access path");
  if (!panic_) decl.path = parse_primary();
  if (!panic_) expect(TokenKind::kColon, "after the variable that is opened");
  if (panic_) {
    if (!is_closing(kind())) take();
    return skip_to_declaration_end();
  }
  decl.spec = parse_spec();
  if (!panic_ && !accept(TokenKind::kReadOnly)) decl.writable = accept(TokenKind::kReadWrite);
  decl.span = span_from(begin);
  var_stack_.push_back(std::move(decl));
  finish_declaration("declaration");
}

// VAR_CONFIG: Resource.Program.x AT %IX0.0 : BOOL := value;
void Parser::parse_config_variable() {
  VarDecl decl;
  decl.attributes = take_attributes();
  base::SourcePos begin = here();
  decl.path = parse_primary();
  if (!panic_) parse_location(decl);
  if (!panic_) expect(TokenKind::kColon, "after the path of the variable");
  if (panic_) {
    if (!is_closing(kind())) take();
    return skip_to_declaration_end();
  }
  decl.spec = parse_spec();
  parse_default(decl.init, &decl.binds);
  decl.span = span_from(begin);
  var_stack_.push_back(std::move(decl));
  finish_declaration("declaration");
}

void Parser::parse_default(ExprId& init, bool* binds) {
  if (panic_) return;
  if (kind() == TokenKind::kEqual) {
    note_only(Code::kAssignEquals, current_->span(),
              "`=` compares; an initial value is given by `:=`", "write `:=`");
    take();
    init = parse_initializer();
  } else if (binds != nullptr && assign_op_here() == AssignOp::kReference) {
    *binds = true;
    take_assign_op();
    init = parse_initializer();
  } else if (accept(TokenKind::kAssign)) {
    init = parse_initializer();
  }
}

void Parser::finish_declaration(const char* what) {
  if (panic_) return skip_to_declaration_end();
  if (accept(TokenKind::kSemicolon)) return;
  bool block_end = current_ != first_ && (current_[-1].kind == TokenKind::kEndStruct ||
                                          current_[-1].kind == TokenKind::kEndUnion);
  if (block_end) return;  // real sources leave the semicolon out after END_x
  report_missing_semicolon(what);
  if (!on_new_line() && !is_statement_boundary(kind())) skip_to_declaration_end();
}

}  // namespace frontend
