#include "frontend/source_edits.h"

#include <algorithm>

#include "frontend/lex/lexer.h"
#include "ir/types/utf.h"

namespace frontend {
namespace {

void collect(std::vector<PouDecl>& pous, const base::SourceMap& sources, uint32_t file,
             std::vector<CodePlace>& out) {
  const uint32_t base = sources.begin(file).offset;
  for (PouDecl& pou : pous) {
    collect(pou.members, sources, file, out);
    if (!pou.code.begin.valid() || sources.file_of(pou.code.begin) != file) continue;
    out.push_back({&pou, pou.code.begin.offset - base, pou.code.end.offset - base});
  }
}

// Whether a file is UTF-8 or Latin-1 is for all of its bytes to say.
bool is_utf8(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const uint32_t bytes =
        static_cast<unsigned char>(text[at]) < 0x80 ? 1 : ir::read_utf8(text.substr(at)).bytes;
    if (bytes == 0) return false;
    at += bytes;
  }
  return true;
}

// May these statements be exchanged for others without looking at anything around them?
bool is_plain(std::string_view text, const CodePlace& place) {
  const std::string_view code = text.substr(place.begin, place.end - place.begin);
  if (code.find('{') != std::string_view::npos || !is_utf8(code)) return false;
  // The word after them is the first of its line.
  const size_t line = code.rfind('\n');
  return line != std::string_view::npos &&
         code.substr(line).find_first_not_of(" \t\r\n") == std::string_view::npos;
}

bool same_head(const PouDecl& a, const PouDecl& b) {
  return a.kind == b.kind && a.name.text == b.name.text;
}

// Lines of positions that only go forward.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {}
  int64_t line_of(uint32_t offset) {
    const auto at = text_.begin() + counted_;
    line_ += std::count(at, text_.begin() + offset, '\n');
    counted_ = offset;
    return line_;
  }

 private:
  std::string_view text_;
  uint32_t counted_ = 0;
  int64_t line_ = 1;
};

auto count_lines(std::string_view text, uint32_t begin, uint32_t end) {
  return std::count(text.begin() + begin, text.begin() + end, '\n');
}

// Tokens and pragmas of a part of a text, by position; nothing when it cannot be read alone.
std::optional<std::vector<base::SourceSpan>> words_of(std::string_view text, uint32_t begin,
                                                      uint32_t end) {
  base::Diagnostics messages;
  const TokenList list = lex(text.substr(begin, end - begin), {begin}, messages);
  if (!messages.all().empty() || !is_utf8(text.substr(begin, end - begin))) return std::nullopt;
  std::vector<base::SourceSpan> words = list.pragmas;
  for (const Token& token : list.tokens) {
    const bool drawn = token.kind == TokenKind::kLadder || token.kind == TokenKind::kFbd;
    if (drawn) return std::nullopt;  // spaces are wires
    if (token.kind != TokenKind::kEnd) words.push_back(token.span());
  }
  std::sort(words.begin(), words.end(),
            [](const auto& a, const auto& b) { return a.begin < b.begin; });
  return words;
}

// Compares two texts from their beginnings to their ends.
class Comparison {
 public:
  Comparison(std::string_view before, std::string_view after)
      : before_(before), after_(after), lines_(before), lines_to_(after) {}

  // What stands up to here is the same, but for comments and spaces.
  bool keep(uint32_t end, uint32_t end_to) {
    if (end < from_ || end_to < to_) return false;
    const std::string_view text = before_.substr(from_, end - from_);
    if (text == after_.substr(to_, end_to - to_)) {
      edits.kept.push_back({from_, end - from_, to_});
      return true;
    }
    return keep_words(end, end_to);
  }

  // Up to here are statements that are others now.
  void skip(uint32_t end, uint32_t end_to) {
    from_ = end;
    to_ = end_to;
    note_line();
  }

  BodyEdits edits;

 private:
  bool keep_words(uint32_t end, uint32_t end_to) {
    const auto old = words_of(before_, from_, end);
    const auto now = words_of(after_, to_, end_to);
    if (!old || !now || old->size() != now->size()) return false;
    uint32_t behind = from_;  // the last word
    uint32_t behind_to = to_;
    for (size_t i = 0; i < old->size(); ++i) {
      const uint32_t at = (*old)[i].begin.offset;
      const uint32_t size = (*old)[i].end.offset - at;
      const uint32_t to = (*now)[i].begin.offset;
      if (before_.substr(at, size) != after_.substr(to, (*now)[i].end.offset - to)) return false;
      const bool moves = edits.kept.empty() || i == 0 ||
                         to - edits.kept.back().to != at - edits.kept.back().begin ||
                         count_lines(before_, behind, at) != count_lines(after_, behind_to, to);
      if (moves && i > 0 && at == behind) return false;  // nothing tells which one is meant
      if (moves) {
        edits.kept.push_back({at, size, to});
        from_ = at;
        to_ = to;
        const bool same_line = before_.substr(behind, at - behind).find('\n') == std::string::npos;
        if (!note_line() && same_line && i > 0) return false;
      }
      edits.kept.back().size = at + size - edits.kept.back().begin;
      behind = at + size;
      behind_to = to + size;
    }
    return true;
  }

  // False: lines move by another number from here on.
  bool note_line() {
    const int64_t line = lines_.line_of(from_);
    const int64_t by = lines_to_.line_of(to_) - line;
    if (by == (edits.lines.empty() ? 0 : edits.lines.back().by)) return true;
    edits.lines.push_back({static_cast<uint32_t>(line), by});
    return false;
  }

  std::string_view before_;
  std::string_view after_;
  uint32_t from_ = 0;  // of what is compared next
  uint32_t to_ = 0;
  LineCounter lines_;
  LineCounter lines_to_;
};

}  // namespace

std::vector<CodePlace> code_places(std::vector<PouDecl>& pous, const base::SourceMap& sources,
                                   uint32_t file) {
  std::vector<CodePlace> places;
  collect(pous, sources, file, places);
  std::sort(places.begin(), places.end(),
            [](const CodePlace& a, const CodePlace& b) { return a.begin < b.begin; });
  return places;
}

std::optional<BodyEdits> compare_bodies(std::string_view before, const std::vector<CodePlace>& old,
                                        std::string_view after, const std::vector<CodePlace>& now) {
  if (old.size() != now.size()) return std::nullopt;
  Comparison comparison(before, after);
  for (size_t i = 0; i < old.size(); ++i) {
    if (!same_head(*old[i].pou, *now[i].pou)) return std::nullopt;
    const std::string_view code = before.substr(old[i].begin, old[i].end - old[i].begin);
    if (code == after.substr(now[i].begin, now[i].end - now[i].begin)) continue;
    if (!is_plain(before, old[i]) || !is_plain(after, now[i])) return std::nullopt;
    if (!comparison.keep(old[i].begin, now[i].begin)) return std::nullopt;
    comparison.skip(old[i].end, now[i].end);
    comparison.edits.changed.push_back(i);
  }
  const auto end = static_cast<uint32_t>(before.size());
  const auto end_to = static_cast<uint32_t>(after.size());
  if (!comparison.keep(end, end_to)) return std::nullopt;
  return std::move(comparison.edits);
}

}  // namespace frontend
