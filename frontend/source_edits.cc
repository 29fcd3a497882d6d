#include "frontend/source_edits.h"

#include <algorithm>

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
  // The word behind them is the first of its line.
  const size_t line = code.rfind('\n');
  return line != std::string_view::npos &&
         code.substr(line).find_first_not_of(" \t\r\n") == std::string_view::npos;
}

uint32_t lines_in(std::string_view text) {
  return static_cast<uint32_t>(std::count(text.begin(), text.end(), '\n'));
}

bool same_head(const PouDecl& a, const PouDecl& b) {
  return a.kind == b.kind && a.name.text == b.name.text;
}

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
  BodyEdits edits;
  uint32_t from = 0;  // of what is kept, in both texts
  uint32_t to = 0;
  uint32_t line = 1;  // of the last end of statements, in both texts
  uint32_t line_to = 1;
  uint32_t counted = 0;
  uint32_t counted_to = 0;
  const auto keep = [&](uint32_t end, uint32_t end_to) {
    const std::string_view text = before.substr(from, end - from);
    if (end < from || end_to < to || text != after.substr(to, end_to - to)) return false;
    edits.kept.push_back({from, end - from, to});
    return true;
  };
  for (size_t i = 0; i < old.size(); ++i) {
    if (!same_head(*old[i].pou, *now[i].pou)) return std::nullopt;
    const std::string_view code = before.substr(old[i].begin, old[i].end - old[i].begin);
    if (code == after.substr(now[i].begin, now[i].end - now[i].begin)) continue;
    if (!is_plain(before, old[i]) || !is_plain(after, now[i])) return std::nullopt;
    if (!keep(old[i].begin, now[i].begin)) return std::nullopt;
    from = old[i].end;
    to = now[i].end;
    line += lines_in(before.substr(counted, from - counted));
    line_to += lines_in(after.substr(counted_to, to - counted_to));
    counted = from;
    counted_to = to;
    edits.changed.push_back(i);
    edits.lines.push_back({line, int64_t{line_to} - int64_t{line}});
  }
  if (!keep(static_cast<uint32_t>(before.size()), static_cast<uint32_t>(after.size()))) {
    return std::nullopt;
  }
  return edits;
}

}  // namespace frontend
