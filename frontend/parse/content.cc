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
class Content {
 public:
  // `room`: bytes that the pieces will need, about.
  explicit Content(size_t room) : text_(room, '\0') {}

  // A piece as it is.
  void add(std::string_view piece) { add_words(copy(piece)); }
  void add_folded(std::string_view piece) { add_words(fold(piece)); }
  // A piece that is one name.
  void add_name(std::string_view piece) { words_.push_back(ir::word_hash(fold(piece))); }
  // Pieces without a name in them.
  void add_keyword(std::string_view piece) { fold(piece); }
  void add_sign(std::string_view piece) { copy(piece); }

  ir::SourceContent finish() {
    std::sort(words_.begin(), words_.end());
    words_.erase(std::unique(words_.begin(), words_.end()), words_.end());
    words_.shrink_to_fit();
    const std::string_view said = std::string_view(text_).substr(0, size_);
    return {base::sha256(base::as_bytes(said)), std::move(words_)};
  }

 private:
  std::string text_;  // the first size_ bytes
  size_t size_ = 0;
  std::vector<uint32_t> words_;

  // Where a piece of that size goes.
  char* room(size_t size) {
    const size_t end = size_ + size + 1;
    if (end > text_.size()) text_.resize(2 * end);
    char* at = text_.data() + size_;
    at[size] = kEnd;
    size_ = end;
    return at;
  }
  std::string_view copy(std::string_view piece) {
    char* at = room(piece.size());
    std::copy(piece.begin(), piece.end(), at);
    return {at, piece.size()};
  }
  std::string_view fold(std::string_view piece) {
    char* at = room(piece.size());
    base::fold_name(piece, at);
    return {at, piece.size()};
  }
  // Those in a piece: whatever begins with a digit is a number.
  void add_words(std::string_view piece) {
    for (size_t at = 0; at < piece.size();) {
      size_t end = at;
      while (end < piece.size() && is_word_char(piece[end])) ++end;
      const bool digit = piece[at] >= '0' && piece[at] <= '9';
      if (end > at && !digit) words_.push_back(ir::word_hash(piece.substr(at, end - at)));
      at = std::max(end, at + 1);
    }
  }
};

bool is_sign(TokenKind kind) { return kind >= TokenKind::kLeftParen && kind < kFirstKeyword; }

void add_token(Content& out, TokenKind kind, std::string_view text) {
  if (is_sign(kind)) {
    out.add_sign(text);
  } else if (is_keyword(kind)) {
    out.add_keyword(text);
  } else if (is_name(kind)) {
    out.add_name(text);
  } else {
    const size_t quote = std::min(text.find_first_of("'\""), text.size());  // also WSTRING#"x"
    if (quote != 0) out.add_folded(text.substr(0, quote));
    if (quote != text.size()) out.add(text.substr(quote));
  }
}

void add_number(Content& out, uint64_t number) { out.add(std::to_string(number)); }

bool is_quote(char c) { return c == '\'' || c == '"'; }

// An operand as written: without blanks that separate no words, and in one case but for strings.
void add_operand(Content& out, std::string_view text) {
  char quote = 0;
  bool escaped = false;  // behind a `$`
  bool blank = false;
  std::string kept;
  for (const char c : text) {
    const bool begins = quote == 0 && is_quote(c);
    if (quote == 0 && (c == ' ' || c == '\t' || c == '\n' || c == '\r')) {
      blank = true;
      continue;
    }
    const bool apart = blank && !kept.empty() && is_word_char(kept.back()) && is_word_char(c);
    if (begins || apart) {
      out.add_folded(kept);
      kept.clear();
    }
    blank = false;
    kept += c;
    const bool ends = quote != 0 && c == quote && !escaped;
    escaped = quote != 0 && c == '$' && !escaped;
    if (begins) quote = c;
    if (!ends) continue;
    out.add(kept);
    kept.clear();
    quote = 0;
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

ir::SourceContent Parser::content_of(const Token* first, const PouDecl& pou,
                                     std::span<const Token> head) const {
  const auto tokens = static_cast<size_t>(current_ - first);
  Content out(current_->begin - first->begin + tokens);
  for (const Token& token : head) add_token(out, token.kind, text(token));
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
    const TokenKind kind = token->kind;
    add_token(out, kind, text(*token));
    const bool drawing = kind == TokenKind::kLadder || kind == TokenKind::kFbd;
    if (drawing && pou.diagram != kNoDiagram) add_diagram(out, tree_.diagrams[pou.diagram]);
    ++token;
  }
  return out.finish();
}

}  // namespace frontend
