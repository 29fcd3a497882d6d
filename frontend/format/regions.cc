// `(* stc:off *)` ... `(* stc:on *)`: what stands between them stays as it is. A region that begins
// or ends inside of a line takes the whole line.
#include <algorithm>

#include "frontend/format/writer.h"

namespace frontend::formatting {

namespace {

bool is_switch(const Text& text, const Piece& piece, std::string_view word) {
  std::string_view part = text.piece_text(piece);
  if (piece.kind == PieceKind::kLineComment) {
    part.remove_prefix(2);
  } else if (piece.kind == PieceKind::kBlockComment && part.size() >= 4) {
    part = part.substr(2, part.size() - 4);
  } else {
    return false;
  }
  size_t from = part.find_first_not_of(" \t");
  size_t to = part.find_last_not_of(" \t\r");
  return from != std::string_view::npos && part.substr(from, to - from + 1) == word;
}

}  // namespace

void Writer::find_regions() {
  const std::vector<Piece>& pieces = text_.pieces();
  const std::vector<Line>& lines = outline_.lines;
  size_t line = 0;
  // The last line that begins before `offset`.
  auto line_at = [&](uint32_t offset) -> const Line& {
    while (line + 1 < lines.size() && text_.begin(lines[line + 1].first) < offset) ++line;
    return lines[line];
  };
  auto inside = [&](const Line& l, uint32_t offset) {
    return text_.begin(l.first) < offset && offset < text_.end(l.end - 1);
  };
  for (size_t p = 0; p < pieces.size(); ++p) {
    if (!is_switch(text_, pieces[p], "stc:off")) continue;
    const Line& opening = line_at(pieces[p].begin);
    bool cut = inside(opening, pieces[p].begin);
    uint32_t begin = cut ? text_.with_indentation(text_.begin(opening.first)) : pieces[p].end;
    while (p < pieces.size() && !is_switch(text_, pieces[p], "stc:on")) ++p;
    uint32_t end = static_cast<uint32_t>(text_.text().size());
    if (p < pieces.size()) {
      end = pieces[p].end;
      const Line& closing = line_at(end);
      if (inside(closing, end)) end = text_.end(closing.end - 1);
    }
    if (!regions_.empty() && begin <= regions_.back().end) {
      regions_.back().end = std::max(regions_.back().end, end);
    } else {
      regions_.push_back({begin, end, !cut});
    }
  }
}

void Writer::write_region() {
  const Region& region = regions_[next_region_++];
  layout_.open_row(0, region.joined ? RowKind::kJoined : RowKind::kVerbatim, false);
  layout_.put(text_.text().substr(region.begin, region.end - region.begin));
  fresh_ = false;
}

bool Writer::in_region(uint32_t offset) const {
  // Only the region written last can hold what comes now.
  return next_region_ != 0 && offset < regions_[next_region_ - 1].end;
}

}  // namespace frontend::formatting
