// Finds the line of a place in the sources. Places mostly go forward, so it keeps where the last
// line was.
#pragma once

#include "base/source.h"

namespace frontend {

class LineFinder {
 public:
  explicit LineFinder(const base::SourceMap& sources) : sources_(sources) {}

  // Begins at a place whose line is known.
  void begin(base::SourcePos pos, uint32_t line);
  // Nobody asks for lines: what stands up to there has line 0.
  void leave_out(base::SourcePos end) { end_ = end.offset; }
  uint32_t line_of(base::SourcePos pos) {
    if (pos.offset < begin_ || pos.offset > end_) find(pos);
    return line_;
  }

 private:
  void find(base::SourcePos pos);

  const base::SourceMap& sources_;
  uint32_t begin_ = 0;  // from where on,
  uint32_t end_ = 0;    // and how far it is the same line
  uint32_t file_ = 0;   // which file that is, most likely
  uint32_t line_ = 0;
};

}  // namespace frontend
