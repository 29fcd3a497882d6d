// What identifies a POU whatever its layout (E-02): its tokens in one form, its attributes, and
// what its drawing means. Comments, blanks, the case of words and the place of elements of a
// drawing have no part in it, nor have members, which are POUs of their own.
#include <algorithm>

#include "base/name_case.h"
#include "frontend/lex/pragma.h"
#include "frontend/parse/parser.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr char kEnd = '\0';  // of a piece: it is in no token

void add(std::string& out, std::string_view piece) {
  out += piece;
  out += kEnd;
}

void add_folded(std::string& out, std::string_view piece) {
  const size_t at = out.size();
  out.resize(at + piece.size() + 1);
  base::fold_name(piece, out.data() + at);
  out.back() = kEnd;
}

void add_number(std::string& out, uint64_t number) { add(out, std::to_string(number)); }

bool is_quote(char c) { return c == '\'' || c == '"'; }

// An operand as written: without blanks that separate no words, and in one case but for strings.
void add_operand(std::string& out, std::string_view text) {
  char quote = 0;
  std::string kept;
  for (const char c : text) {
    if (quote != 0) {
      quote = c == quote ? 0 : quote;
    } else if (is_quote(c)) {
      add_folded(out, kept);
      kept.clear();
      quote = c;
    } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      if (!kept.empty()) add_folded(out, kept);
      kept.clear();
      continue;
    }
    kept += c;
    if (quote == 0 && is_quote(c)) {
      add(out, kept);
      kept.clear();
    }
  }
  add_folded(out, kept);
}

void add_element(std::string& out, const network::Element& element) {
  add_number(out, static_cast<uint64_t>(element.kind));
  add_number(out, static_cast<uint64_t>(element.modifier));
  add_operand(out, element.operand.text);
  add_folded(out, element.type.text);
  add_folded(out, element.wire.text);
  add_number(out, element.inputs.size());
  for (const network::Input& input : element.inputs) {
    add_folded(out, input.name);
    add_number(out, static_cast<uint64_t>(input.modifier));
    add_number(out, input.from.size());
    for (const network::Link& link : input.from) {
      add_number(out, link.element);
      add_number(out, link.output);
    }
  }
  add_number(out, element.outputs.size());
  for (const network::Output& output : element.outputs) {
    add_folded(out, output.name);
    add_number(out, output.negated ? 1 : 0);
  }
}

void add_diagram(std::string& out, const network::Body& body) {
  for (const network::Network& network : body.networks) {
    add_folded(out, network.label.text);
    add_number(out, network.elements.size());
    for (const network::Element& element : network.elements) add_element(out, element);
  }
}

void attribute_text(std::string& out, std::string_view name, std::string_view value) {
  if (ir::same_name(name, kRenamedAttribute)) return;  // says where values come from, once
  add_folded(out, name);
  add(out, value);
}

bool is_word_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

std::vector<uint32_t> words_of(std::string_view content) {
  std::vector<uint32_t> words;
  for (size_t at = 0; at < content.size();) {
    size_t end = at;
    while (end < content.size() && is_word_char(content[end])) ++end;
    const bool digit = content[at] >= '0' && content[at] <= '9';
    if (end > at && !digit) words.push_back(ir::word_hash(content.substr(at, end - at)));
    at = std::max(end, at + 1);
  }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  words.shrink_to_fit();
  return words;
}

}  // namespace

void Parser::add_pragma(std::string& out, base::SourceSpan span) const {
  const size_t begin = span.begin.offset - base_;
  const auto found = read_attribute(text_.substr(begin, span.end.offset - span.begin.offset));
  if (found) attribute_text(out, found->name, found->value);
}

ir::SourceContent Parser::content_of(const Token* first, const PouDecl& pou) const {
  std::string out;
  for (uint32_t i = 0; i < pou.attributes.count; ++i) {
    const Attribute& attribute = tree_.attributes[pou.attributes.first + i];
    attribute_text(out, attribute.name.text, attribute.value);
  }
  const auto before = [](const base::SourceSpan& span, uint32_t at) {
    return span.begin.offset < at;
  };
  auto pragma = std::lower_bound(list_.pragmas.begin(), list_.pragmas.end(), first->begin, before);
  auto member = pou.members.begin();
  for (const Token* token = first; token != current_;) {
    if (member != pou.members.end() && token->begin >= member->span.begin.offset) {
      const uint32_t end = member->span.end.offset;
      while (token != current_ && token->begin < end) ++token;
      pragma = std::lower_bound(pragma, list_.pragmas.end(), end, before);
      ++member;
      continue;
    }
    for (; pragma != list_.pragmas.end() && before(*pragma, token->begin); ++pragma) {
      add_pragma(out, *pragma);
    }
    const std::string_view piece = text(*token);
    token->kind == TokenKind::kString ? add(out, piece) : add_folded(out, piece);
    const bool drawing = token->kind == TokenKind::kLadder || token->kind == TokenKind::kFbd;
    if (drawing && pou.diagram != kNoDiagram) add_diagram(out, tree_.diagrams[pou.diagram]);
    ++token;
  }
  return {base::sha256(base::as_bytes(out)), words_of(out)};
}

}  // namespace frontend
