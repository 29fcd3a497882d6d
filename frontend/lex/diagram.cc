// The text forms of ladder and FBD have readers of their own (ladder/read.h, fbd/read.h). After
// LADDER or FBD in a line of its own, everything up to its end gives no tokens.
#include "frontend/lex/characters.h"
#include "frontend/lex/keywords.h"
#include "frontend/lex/scanner.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr std::string_view kDiagramEnd = "END_";

size_t behind_blanks(std::string_view text, size_t at) {
  while (at < text.size() && is_space(text[at]) && text[at] != '\n') ++at;
  return at;
}

bool begins_line(std::string_view text, size_t at) {
  while (at > 0 && is_space(text[at - 1]) && text[at - 1] != '\n') --at;
  return at == 0 || text[at - 1] == '\n';
}

bool ends_line(std::string_view text, size_t at) {
  at = behind_blanks(text, at);
  std::string_view rest = text.substr(at, 2);
  return rest.empty() || rest[0] == '\n' || rest == "//" || rest == "(*" || rest == "/*";
}

// The next line that begins with an END_... word; no row of a diagram does. Names may:
// End_Position.
size_t next_end(std::string_view text, size_t at) {
  while ((at = text.find('\n', at)) != std::string_view::npos) {
    at = behind_blanks(text, at + 1);
    size_t end = at;
    while (end < text.size() && is_name_part(text[end])) ++end;
    bool closing = ir::same_name(text.substr(at, kDiagramEnd.size()), kDiagramEnd);
    if (closing && keyword(text.substr(at, end - at)) != TokenKind::kName) return at;
  }
  return text.size();
}

}  // namespace

// LADDER and FBD are names elsewhere. Where the end is missing, a rung tells that a drawing began;
// so it does in the line of the word.
void Scanner::skip_diagram(size_t word, TokenKind kind) {
  bool rung_behind =
      kind == TokenKind::kLadder && text_.substr(behind_blanks(text_, at_), 3) == "|--";
  bool alone = begins_line(text_, word) && ends_line(text_, at_);
  if (!alone && !rung_behind) return;
  size_t end = next_end(text_, at_);
  std::string_view begun = text_.substr(word, at_ - word);
  if (size_t line = text_.find('\n', at_); rung_behind && !alone) {
    size_t same = text_.substr(0, line).find(kDiagramEnd, at_);
    if (same != std::string_view::npos) end = same;
  }
  size_t name = end + kDiagramEnd.size();
  bool closed = name < text_.size() && ir::same_name(text_.substr(name, begun.size()), begun);
  bool drawn = rung_behind || (kind == TokenKind::kLadder &&
                               text_.substr(at_, end - at_).find("|--") != std::string_view::npos);
  if (closed || drawn) at_ = end;
}

}  // namespace frontend
