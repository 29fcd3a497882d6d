#include "base/source.h"

#include <algorithm>

namespace base {

SourcePos SourceMap::add(std::string name, std::string text, TextUse use) {
  SourcePos begin{next_base_};
  // One byte between files, so that an end position is never the next file's begin.
  next_base_ += static_cast<uint32_t>(text.size()) + 1;
  auto kept = std::make_shared<const std::string>(std::move(text));
  files_.push_back({std::move(name), std::move(kept), begin.offset, use, {}});
  return begin;
}

uint32_t SourceMap::file_of(SourcePos pos) const {
  if (!pos.valid() || pos.offset >= next_base_) return file_count();
  auto after = std::upper_bound(files_.begin(), files_.end(), pos.offset,
                                [](uint32_t offset, const File& f) { return offset < f.base; });
  return static_cast<uint32_t>(after - files_.begin()) - 1;
}

void SourceMap::replace(uint32_t file, std::string text) {
  files_[file].text = std::make_shared<const std::string>(std::move(text));
  files_[file].line_starts.clear();
  next_base_ = files_[file].base;
  for (uint32_t i = file; i < file_count(); ++i) {
    files_[i].base = next_base_;
    next_base_ += static_cast<uint32_t>(files_[i].text->size()) + 1;
  }
}

SourcePos SourceMap::current(SourcePos pos) const {
  if (!pos.valid()) return pos;
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), pos.offset,
                       [](uint32_t offset, const Piece& piece) { return offset < piece.begin; });
  if (after == pieces_.begin()) return pos;
  const Piece& piece = after[-1];
  const uint32_t inside = pos.offset - piece.begin;
  return inside <= piece.size ? SourcePos{piece.to + inside} : pos;
}

SourceLocation SourceMap::locate(SourcePos pos) const {
  pos = current(pos);
  uint32_t index = file_of(pos);
  if (index == file_count()) return {};
  const File& file = files_[index];
  const std::string_view text = *file.text;
  if (file.line_starts.empty()) {
    file.line_starts.push_back(0);
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) {
      file.line_starts.push_back(static_cast<uint32_t>(++at));
    }
  }
  uint32_t offset = pos.offset - file.base;
  auto after = std::upper_bound(file.line_starts.begin(), file.line_starts.end(), offset);
  uint32_t start = *(after - 1);
  // No search for the end: it would cost the length of the line for each finding in it.
  const size_t end = after == file.line_starts.end() ? text.size() : *after - 1;
  std::string_view line = text.substr(start, end - start);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return {file.name, static_cast<uint32_t>(after - file.line_starts.begin()), offset - start + 1,
          line};
}

}  // namespace base
