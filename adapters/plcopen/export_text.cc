// Pieces of sources for the export.
#include <algorithm>

#include "adapters/plcopen/writer.h"
#include "base/name_case.h"
#include "frontend/lex/active_text.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/pragma.h"

namespace plcopen {

using frontend::Token;
using frontend::TokenKind;

void Writer::fail(base::SourceSpan at, std::string text) {
  if (parts_) {
    parts_->mark_partial(at.begin);
    return diagnostics_.add(base::DiagnosticCode::kXmlTextOnly, at, std::move(text),
                            "other tools leave it out; stc reads it back");
  }
  diagnostics_.add(base::DiagnosticCode::kCannotExport, at, std::move(text),
                   "write it in another way, or export without --without-sources");
}

// What is left out is nobody's text. Positions are those of the sources.
std::string_view Writer::text_of(uint32_t file) const {
  return texts_[file] ? *texts_[file] : in_.sources.text(file);
}

void Writer::read_texts() {
  const frontend::DeclarationIndex declarations(in_.sources);
  frontend::LexOptions options;
  options.defines = in_.defines;
  options.declarations = &declarations;
  for (uint32_t file = 0; file < in_.sources.file_count(); ++file) {
    texts_.push_back(std::nullopt);
    if (!in_.sources.is_source(file)) continue;
    texts_.back() = frontend::active_text(in_.sources, file, options);
    if (!texts_.back() || in_.with_sources) continue;
    const base::SourcePos begin = in_.sources.begin(file);
    diagnostics_.add(base::DiagnosticCode::kXmlLeftOut, {begin, {begin.offset + 1}},
                     "what {IF ...} leaves out is not in the document",
                     "leave --without-sources out, and `stc import` gets it back");
  }
}

std::string_view Writer::slice(base::SourceSpan span) const {
  const uint32_t file = in_.sources.file_of(span.begin);
  if (file == in_.sources.file_count() || span.end < span.begin) return {};
  std::string_view text = text_of(file);
  const uint32_t begin = span.begin.offset - in_.sources.begin(file).offset;
  return text.substr(begin, span.end.offset - span.begin.offset);
}

std::string Writer::flat(base::SourceSpan span) const {
  std::string_view text = slice(span);
  base::Diagnostics unheard;
  frontend::TokenList list = frontend::lex(text, {0}, unheard);
  std::string out;
  uint32_t end = 0;
  for (const Token& token : list.tokens) {
    if (token.kind == TokenKind::kEnd) break;
    if (!out.empty() && token.begin > end) out += ' ';
    out += text.substr(token.begin, token.length);
    end = token.begin + token.length;
  }
  return out;
}

// (* text *) directly in front, on lines of its own or not.
std::string Writer::comment_before(base::SourcePos begin) const {
  const uint32_t file = in_.sources.file_of(begin);
  if (file == in_.sources.file_count()) return {};
  std::string_view text = text_of(file);
  text = text.substr(0, begin.offset - in_.sources.begin(file).offset);
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  if (text.ends_with("TYPE")) {
    text = text.substr(0, text.size() - 4);
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  }
  if (!text.ends_with("*)")) return {};
  const size_t open = text.rfind("(*");
  if (open == std::string_view::npos) return {};
  return std::string(xml::trimmed(text.substr(open + 2, text.size() - open - 4)));
}

// A comment after `end` in its line.
std::string Writer::comment_behind(base::SourcePos end) const {
  const uint32_t file = in_.sources.file_of(end);
  if (file == in_.sources.file_count()) return {};
  std::string_view text = text_of(file);
  text = text.substr(std::min<size_t>(end.offset - in_.sources.begin(file).offset, text.size()));
  std::string_view line = text.substr(0, text.find('\n'));
  line = xml::trimmed(line);
  if (line.starts_with(";")) line = xml::trimmed(line.substr(1));
  if (line.starts_with("//")) return std::string(xml::trimmed(line.substr(2)));
  if (!line.starts_with("(*")) return {};
  const size_t close = line.find("*)");
  if (close == std::string_view::npos) return {};
  return std::string(xml::trimmed(line.substr(2, close - 2)));
}

std::string Writer::address_of(const frontend::VarDecl& decl) const {
  if (!decl.has_address) return {};
  std::string_view text = slice(decl.span);
  base::Diagnostics unheard;
  for (const Token& token : frontend::lex(text, {0}, unheard).tokens) {
    if (token.kind == TokenKind::kDirect) {
      return std::string(text.substr(token.begin, token.length));
    }
  }
  return {};
}

namespace {

bool is_var(TokenKind kind) { return kind >= TokenKind::kVar && kind <= TokenKind::kVarTemp; }

TokenKind end_of_member(TokenKind kind) {
  switch (kind) {
    case TokenKind::kMethod:
      return TokenKind::kEndMethod;
    case TokenKind::kProperty:
      return TokenKind::kEndProperty;
    case TokenKind::kAction:
      return TokenKind::kEndAction;
    default:
      return TokenKind::kEnd;
  }
}

// `text` without its attributes: those in front of a member are the member's.
std::string without_attributes(std::string_view text) {
  base::Diagnostics unheard;
  std::string out;
  size_t from = 0;
  for (const base::SourceSpan& pragma : frontend::lex(text, {0}, unheard).pragmas) {
    const size_t begin = pragma.begin.offset;
    const size_t end = pragma.end.offset;
    if (!frontend::read_attribute(text.substr(begin, end - begin))) continue;
    out += text.substr(from, begin - from);
    from = end;
  }
  return out += text.substr(from);
}

}  // namespace

// Tokens tell: members end with their END.
Writer::Pieces Writer::pieces(base::SourceSpan span, base::SourcePos head_end) const {
  std::string_view text = slice(span);
  base::Diagnostics unheard;
  const std::vector<Token> tokens = frontend::lex(text, {0}, unheard).tokens;
  Pieces out;
  if (tokens.size() < 2) return out;
  size_t last = tokens.size() - 2;  // END_PROGRAM, perhaps with a semicolon
  if (tokens[last].kind == TokenKind::kSemicolon && last > 0) --last;
  size_t body_from = 0;  // bytes
  size_t at = 0;
  const bool accessor = tokens[0].kind == TokenKind::kGet || tokens[0].kind == TokenKind::kSet;
  auto in_head = [&](const Token& token) {
    const bool sign = token.kind == TokenKind::kSemicolon || token.kind == TokenKind::kColon;
    const bool access = accessor && at == 1 && frontend::is_access(token.kind) &&
                        !frontend::follows_a_name(tokens[at + 1].kind);
    return span.begin.offset + token.begin < head_end.offset || (sign && at > 0) ||
           (accessor && at == 0) || access;
  };
  for (; at < last && in_head(tokens[at]); ++at) {
    body_from = tokens[at].begin + tokens[at].length;
  }
  for (; at < last && is_var(tokens[at].kind); ++at) {
    while (at < last && tokens[at].kind != TokenKind::kEndVar) ++at;
    if (at + 1 < last && tokens[at + 1].kind == TokenKind::kSemicolon) ++at;
    body_from = tokens[at].begin + tokens[at].length;
  }
  out.head = text.substr(0, body_from);
  const size_t end = tokens[last].begin;
  for (; at < last; ++at) {
    const TokenKind member_end = end_of_member(tokens[at].kind);
    const bool member = member_end != TokenKind::kEnd && frontend::is_name(tokens[at + 1].kind);
    if (!member) continue;
    const size_t before = std::max<size_t>(body_from, tokens[at - 1].begin + tokens[at - 1].length);
    out.body += text.substr(body_from, before - body_from);
    out.body += without_attributes(text.substr(before, tokens[at].begin - before));
    while (at < last && tokens[at].kind != member_end) ++at;
    if (at + 1 < last && tokens[at + 1].kind == TokenKind::kSemicolon) ++at;
    body_from = tokens[at].begin + tokens[at].length;
  }
  if (end > body_from) out.body += text.substr(body_from, end - body_from);
  return out;
}

// After the head, up to END_TRANSITION. `list`: instructions.
std::string Writer::condition_of(const frontend::ChartTransition& transition, bool& list) const {
  const uint32_t file = in_.sources.file_of(transition.span.end);
  std::string_view text = text_of(file);
  text = text.substr(transition.span.end.offset - in_.sources.begin(file).offset);
  base::Diagnostics unheard;
  // A condition is short; the rest of the file is not looked at.
  const std::vector<Token> tokens = frontend::lex(text.substr(0, 100'000), {0}, unheard).tokens;
  list = tokens[0].kind == TokenKind::kColon;
  for (const Token& token : tokens) {
    if (token.kind != TokenKind::kEndTransition) continue;
    const size_t from = tokens[0].begin + tokens[0].length;
    if (list) return std::string(text.substr(from, token.begin - from));
    const base::SourcePos begin = transition.span.end;
    std::string inside =
        flat({{begin.offset + static_cast<uint32_t>(from)}, {begin.offset + token.begin}});
    while (inside.ends_with(";") || inside.ends_with(" ")) inside.pop_back();
    return inside;
  }
  return {};
}

// Without what all lines have in front: they keep their distances from each other.
std::string Writer::undented(std::string_view all) {
  while (!all.empty() && xml::trimmed(all.substr(0, all.find('\n'))).empty() &&
         all.find('\n') != std::string_view::npos) {
    all.remove_prefix(all.find('\n') + 1);
  }
  while (!all.empty() && xml::trimmed(all.substr(all.size() - 1)).empty()) all.remove_suffix(1);
  size_t least = all.size();
  for (std::string_view rest = all; !rest.empty();) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    const size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos) least = std::min(least, first);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  std::string out;
  for (std::string_view rest = all; !rest.empty();) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    out += std::string(line.substr(std::min(least, line.size()))) + (rest.empty() ? "" : "\n");
  }
  return out;
}

void Writer::put_text(Node parent, const char* language, const std::string& text) const {
  const std::string out = undented(text);
  put_formatted(parent.append_child(language), out.empty() ? " " : out);  // no text is none to them
}

std::string Writer::blanks_before(base::SourceSpan span) const {
  const uint32_t file = in_.sources.file_of(span.begin);
  if (file == in_.sources.file_count()) return {};
  const std::string_view text = text_of(file);
  size_t blanks = 0;
  for (size_t at = span.begin.offset - in_.sources.begin(file).offset; at > 0; --at, ++blanks) {
    if (text[at - 1] != ' ' && text[at - 1] != '\t') break;
  }
  return std::string(blanks, ' ');
}

// Beremiz and OpenPLC Editor look for a <p> in <xhtml:p>, of which no blank is lost as it is CDATA;
// CODESYS and TwinCAT write what they declare themselves, and get that.
void Writer::put_formatted(Node owner, const std::string& text) const {
  if (in_.form == Edition::kIec10 || (in_.kept != nullptr && in_.kept->declares_xhtml)) {
    Node xhtml = owner.append_child("xhtml");
    xhtml.append_attribute("xmlns") = kXhtml;
    if (!text.empty()) xhtml.append_child(pugi::node_pcdata).set_value(text.c_str());
    return;
  }
  put_characters(owner.append_child("xhtml:p"), text);
}

void Writer::put_characters(Node paragraph, const std::string& text) {
  paragraph.append_child(pugi::node_pcdata);  // so that no line begins in front of the text
  paragraph.append_child(pugi::node_cdata).set_value(text.c_str());
  paragraph.append_child(pugi::node_pcdata);
}

void Writer::put_documentation(Node owner, const std::string& text) const {
  if (!text.empty()) put_formatted(owner.append_child("documentation"), text);
}

Node Writer::data(Node owner, const char* name) {
  Node add = owner.child("addData");
  if (!add) add = owner.append_child("addData");
  Node out = add.append_child("data");
  out.append_attribute("name") =
      ("http://www.3s-software.com/plcopenxml/" + std::string(name)).c_str();
  out.append_attribute("handleUnknown") = "implementation";
  return out;
}

void Writer::put_declaration(Node owner, const std::string& text) {
  Node xhtml = data(owner, "interfaceasplaintext")
                   .append_child("InterfaceAsPlainText")
                   .append_child("xhtml");
  xhtml.append_attribute("xmlns") = kXhtml;
  xhtml.append_child(pugi::node_pcdata).set_value(text.c_str());
}

// As sources say it.
static std::string pragma_of(const frontend::Attribute& attribute) {
  std::string name(attribute.name.text);
  const auto quoted = [](std::string_view text) { return "'" + std::string(text) + "'"; };
  std::string value = attribute.has_value ? " := " + quoted(attribute.value) : "";
  if (base::same_name(name, frontend::kRenamedAttribute)) {
    name += (attribute.part.empty() ? "" : " " + quoted(attribute.part)) + " from";
  } else if (base::same_name(name, frontend::kMigrationAttribute)) {
    name += " of";
    if (!attribute.from.empty()) value += ", from := " + quoted(attribute.from);
    if (attribute.marked) value += ", inverse";
  } else {
    name = "attribute " + quoted(name);
  }
  return "{" + name + value + "}\n";
}

std::string Writer::attribute_text(frontend::Range32 attributes) const {
  std::string out;
  for (uint32_t i = 0; i < attributes.count; ++i) {
    out += pragma_of(tree_.attributes[attributes.first + i]);
  }
  return out;
}

// Rules have words of their own (X2), and are attributes that mean nothing to others:
// `renamed .x from` := "b, a", `migration of` := "B, from A, inverse". vendor.cc reads them.
static std::pair<std::string, std::string> name_and_value(const frontend::Attribute& attribute) {
  std::string name(attribute.name.text);
  std::string value(attribute.value);
  if (base::same_name(name, frontend::kRenamedAttribute)) {
    name += (attribute.part.empty() ? "" : " " + std::string(attribute.part)) + " from";
    value.clear();
    for (std::string_view old_name : frontend::quoted_texts(attribute.value)) {
      value += (value.empty() ? "" : ", ") + std::string(old_name);
    }
  } else if (base::same_name(name, frontend::kMigrationAttribute)) {
    name += " of";
    if (!attribute.from.empty()) value += ", from " + std::string(attribute.from);
    if (attribute.marked) value += ", inverse";
  }
  return {std::move(name), std::move(value)};
}

void Writer::put_attributes(Node owner, frontend::Range32 attributes) {
  if (attributes.count == 0) return;
  Node list = data(owner, "attributes").append_child("Attributes");
  for (uint32_t i = 0; i < attributes.count; ++i) {
    const frontend::Attribute& attribute = tree_.attributes[attributes.first + i];
    const auto [name, value] = name_and_value(attribute);
    Node each = list.append_child("Attribute");
    each.append_attribute("Name") = name.c_str();
    each.append_attribute("Value") = value.c_str();
  }
}

}  // namespace plcopen
