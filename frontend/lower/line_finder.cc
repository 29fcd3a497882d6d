#include "frontend/lower/line_finder.h"

#include <algorithm>

namespace frontend {

void LineFinder::begin(base::SourcePos pos, uint32_t line) {
  file_ = sources_.file_of(pos);
  begin_ = end_ = pos.offset;
  line_ = line;
}

void LineFinder::find(base::SourcePos pos) {
  const uint32_t offset = pos.offset;
  uint32_t base = sources_.begin(file_).offset;
  if (offset < base || offset - base >= sources_.text(file_).size()) {
    file_ = sources_.file_of(pos);
    base = sources_.begin(file_).offset;
  }
  // A type's initial values may stand in another file than the variable; a drawing goes up and
  // down in its rows.
  constexpr uint32_t kFar = 4096;
  const bool far = offset < end_ || end_ < base || offset - end_ > kFar;
  if (far || sources_.has_pieces()) {
    const base::SourceLocation location = sources_.locate(pos);
    line_ = location.line;
    begin_ = offset + 1 - location.column;
    end_ = offset;
    return;
  }
  const std::string_view text = sources_.text(file_);
  size_t end = text.find('\n', end_ - base);
  while (end < offset - base) {
    ++line_;
    begin_ = base + static_cast<uint32_t>(++end);
    end = text.find('\n', end);
  }
  end_ = base + static_cast<uint32_t>(std::min(end, text.size()));
}

}  // namespace frontend
