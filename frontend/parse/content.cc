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

bool is_word_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

// What is collected of a POU: its pieces one after the other, and the names in them.
struct Content {
  std::string text;
  std::vector<uint32_t> words;

  // A piece as it is.
  void add(std::string_view piece) {
    const size_t at = text.size();
    text += piece;
    add_words(std::string_view(text).substr(at));
    text += kEnd;
  }
  void add_folded(std::string_view piece) { add_words(fold(piece)); }
  // A piece that is one name.
  void add_word(std::string_view piece) { words.push_back(ir::word_hash(fold(piece))); }

  ir::SourceContent finish() {
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
    words.shrink_to_fit();
    return {base::sha256(base::as_bytes(text)), std::move(words)};
  }

 private:
  std::string_view fold(std::string_view piece) {
    const size_t at = text.size();
    text.resize(at + piece.size() + 1);
    base::fold_name(piece, text.data() + at);
    text.back() = kEnd;
    return std::string_view(text).substr(at, piece.size());
  }
  // Those in a piece: whatever begins with a digit is a number.
  void add_words(std::string_view piece) {
    for (size_t at = 0; at < piece.size();) {
      size_t end = at;
      while (end < piece.size() && is_word_char(piece[end])) ++end;
      const bool digit = piece[at] >= '0' && piece[at] <= '9';
      if (end > at && !digit) words.push_back(ir::word_hash(piece.substr(at, end - at)));
      at = std::max(end, at + 1);
    }
  }
};

void add_number(Content& out, uint64_t number) { out.add(std::to_string(number)); }

bool is_quote(char c) { return c == '\'' || c == '"'; }

// An operand as written: without blanks that separate no words, and in one case but for strings.
void add_operand(Content& out, std::string_view text) {
  char quote = 0;
  std::string kept;
  for (const char c : text) {
    if (quote != 0) {
      quote = c == quote ? 0 : quote;
    } else if (is_quote(c)) {
      out.add_folded(kept);
      kept.clear();
      quote = c;
    } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      if (!kept.empty()) out.add_folded(kept);
      kept.clear();
      continue;
    }
    kept += c;
    if (quote == 0 && is_quote(c)) {
      out.add(kept);
      kept.clear();
    }
  }
  out.add_folded(kept);
}

void add_element(Content& out, const network::Element& element) {
  add_number(out, static_cast<uint64_t>(element.kind));
  add_number(out, static_cast<uint64_t>(element.modifier));
  add_operand(out, element.operand.text);
  out.add_folded(element.type.text);
  out.add_folded(element.wire.text);
  add_number(out, element.inputs.size());
  for (const network::Input& input : element.inputs) {
    out.add_folded(input.name);
    add_number(out, static_cast<uint64_t>(input.modifier));
    add_number(out, input.from.size());
    for (const network::Link& link : input.from) {
      add_number(out, link.element);
      add_number(out, link.output);
    }
  }
  add_number(out, element.outputs.size());
  for (const network::Output& output : element.outputs) {
    out.add_folded(output.name);
    add_number(out, output.negated ? 1 : 0);
  }
}

void add_diagram(Content& out, const network::Body& body) {
  for (const network::Network& network : body.networks) {
    out.add_folded(network.label.text);
    if (network.disabled) continue;  // as a comment
    add_number(out, network.elements.size());
    for (const network::Element& element : network.elements) add_element(out, element);
  }
}

void attribute_text(Content& out, std::string_view name, std::string_view value) {
  if (ir::same_name(name, kRenamedAttribute)) return;  // says where values come from, once
  out.add_folded(name);
  out.add(value);
}

// A pragma's text: an attribute takes part, anything else does not.
void add_pragma(Content& out, std::string_view text) {
  const auto found = read_attribute(text);
  if (found) attribute_text(out, found->name, found->value);
}

}  // namespace

ir::SourceContent Parser::content_of(const Token* first, const PouDecl& pou) const {
  Content out;
  out.text.reserve(current_->begin - first->begin);
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
      add_pragma(out, text_.substr(pragma->begin.offset - base_,
                                   pragma->end.offset - pragma->begin.offset));
    }
    const std::string_view piece = text(*token);
    const TokenKind kind = token->kind;
    if (is_keyword(kind) || is_name(kind)) {
      out.add_word(piece);
    } else {
      kind == TokenKind::kString ? out.add(piece) : out.add_folded(piece);
    }
    const bool drawing = kind == TokenKind::kLadder || kind == TokenKind::kFbd;
    if (drawing && pou.diagram != kNoDiagram) add_diagram(out, tree_.diagrams[pou.diagram]);
    ++token;
  }
  return out.finish();
}

}  // namespace frontend
