#include "frontend/format/diagrams.h"

#include <algorithm>

#include "frontend/fbd/read.h"
#include "frontend/format/same_program.h"
#include "frontend/format/writer.h"
#include "frontend/ladder/read.h"
#include "frontend/network/element_text.h"
#include "frontend/network/same.h"
#include "frontend/network/write.h"
#include "ir/types/types.h"

namespace frontend::formatting {

namespace {

using network::Body;

Body read(TokenKind head, std::string_view text, bool& good) {
  base::Diagnostics diagnostics;
  Body body = head == TokenKind::kLadder ? ladder::read(text, base::SourcePos{0}, diagnostics)
                                         : fbd::read(text, base::SourcePos{0}, diagnostics);
  good = diagnostics.all().empty();
  return body;
}

// A row ends with `;`, a label with `:`; a box has a type and a parenthesis after its `:`.
Outline outline_fbd(const Text& text) {
  Outline out;
  out.soft_keywords.resize(text.token_count());
  uint32_t at = 0;
  while (text.kind(at) != TokenKind::kEnd) {
    Line line;
    line.first = at;
    bool label = is_name(text.kind(at)) && text.kind(at + 1) == TokenKind::kColon;
    uint32_t type = at + 2;
    while (label && is_name(text.kind(type)) && text.kind(type + 1) == TokenKind::kDot) type += 2;
    if (label && is_name(text.kind(type)) && text.kind(type + 1) == TokenKind::kLeftParen) {
      label = false;
    }
    if (label) {
      line.kind = LineKind::kLabel;
      at += 2;
    } else {
      bool word = is_name(text.kind(at + 1));
      if (word && (text.is_word(at, "WIRE") || text.is_word(at, "JMP"))) {
        out.soft_keywords[at] = true;
      }
      while (text.kind(at) != TokenKind::kEnd && text.kind(at) != TokenKind::kSemicolon) ++at;
      if (text.kind(at) == TokenKind::kSemicolon) ++at;
    }
    line.end = at;
    out.lines.push_back(line);
  }
  Line& last = out.lines.emplace_back();
  last.first = at;
  last.end = at + 1;
  last.kind = LineKind::kEnd;
  return out;
}

std::string laid_out_fbd(std::string_view rows, const FormatOptions& options) {
  base::SourceMap source;
  source.add("", std::string(rows));
  base::Diagnostics diagnostics;
  TokenList tokens = lex(source, 0, diagnostics, LexOptions::all_text());
  Text text(source, 0, tokens);
  Outline outline = outline_fbd(text);
  Rows laid_out = Writer(text, outline, options).run();
  return align(laid_out, options, text);
}

// What the first row has in front of it goes from every line: those inside of a comment too, which
// get the new margin like all others.
std::string without_margin(std::string_view lines) {
  const size_t row = lines.find_first_not_of(" \t\r\n");
  const size_t newline = row == std::string_view::npos ? row : lines.rfind('\n', row);
  if (newline == std::string_view::npos) return std::string(lines);
  const std::string_view margin = lines.substr(newline + 1, row - newline - 1);
  std::string out;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    const auto [end, same] = std::mismatch(line.begin(), line.end(), margin.begin(), margin.end());
    out.append(end, line.end());
    if (line.size() == lines.size()) break;
    out += '\n';
    lines.remove_prefix(line.size() + 1);
  }
  return out;
}

std::string with_margin(std::string_view lines, const std::string& margin) {
  std::string out;
  while (!lines.empty()) {
    size_t newline = lines.find('\n');
    std::string_view line = lines.substr(0, newline);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.empty()) out += margin;
    out += line;
    if (newline == std::string_view::npos) break;
    out += '\n';
    lines.remove_prefix(newline + 1);
  }
  return out;
}

}  // namespace

std::optional<std::string> drawn(TokenKind head, std::string_view text, uint32_t indent,
                                 const FormatOptions& options) {
  if (text.find("stc:off") != std::string_view::npos) return std::nullopt;
  bool good = false;
  Body body = read(head, text, good);
  if (!good) return std::nullopt;
  std::string out;
  if (head == TokenKind::kLadder) {
    // A tab in a drawing would be as wide as the editor likes.
    std::optional<std::string> ladder = network::write_ladder(body, indent);
    if (!ladder) return std::nullopt;
    out = std::move(*ladder);
    if (!same_diagram(head, text, out)) return std::nullopt;
  } else {
    FormatOptions inner = options;
    inner.width = options.width > indent ? options.width - indent : 1;
    uint32_t tabs = options.tabs && options.indent != 0 ? indent / options.indent : 0;
    std::string margin = std::string(tabs, '\t') + std::string(indent - tabs * options.indent, ' ');
    out = with_margin(laid_out_fbd(without_margin(text), inner), margin);
    bool whole = network::is_one_diagram(network::Language::kFbd, out);
    if (!whole || !same_diagram(head, text, out)) return std::nullopt;
  }
  while (out.ends_with('\n')) out.pop_back();
  return out;
}

bool same_diagram(TokenKind head, std::string_view a, std::string_view b) {
  if (a == b) return true;
  bool good_a = false;
  bool good_b = false;
  Body body_a = read(head, a, good_a);
  Body body_b = read(head, b, good_b);
  if (!good_a || !good_b || canonical(body_a) != canonical(body_b)) return false;
  if (head == TokenKind::kLadder) return true;
  base::SourceMap before;
  base::SourceMap after;
  before.add("", std::string(a));
  after.add("", std::string(b));
  return same_program(before, 0, after, 0).ok();
}

}  // namespace frontend::formatting
