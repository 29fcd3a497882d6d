// Logical lines and what stands between them -> rows: indentation, blank lines, comments, lines
// that stay joined, and regions that stay as they are.
#pragma once

#include <vector>

#include "frontend/format/layout.h"
#include "frontend/format/outline.h"
#include "frontend/format/rows.h"

namespace frontend::formatting {

class Writer {
 public:
  Writer(const Text& text, Outline& outline, const FormatOptions& options)
      : text_(text), outline_(outline), options_(options), layout_(text, outline, options, rows_) {}
  Rows run();

 private:
  // Bytes of the source that stay as they are.
  struct Region {
    uint32_t begin;
    uint32_t end;
    bool joined;  // goes on after the comment that opens it
  };
  // writer.cc
  void write_line(uint32_t index);
  uint32_t try_joined(uint32_t index);
  bool joins_statement(uint32_t index) const;
  void open_line(const Line& line, uint32_t newlines);
  void boundary(const Line& line);
  uint32_t trailing(const Gap& gap);
  void own_rows(const Line& line, uint32_t from, uint32_t to);
  bool blank(uint32_t newlines) const;
  bool write_diagram(const Line& line);
  // regions.cc
  void find_regions();
  void write_region();
  bool in_region(uint32_t offset) const;
  bool has_region_before(uint32_t offset) const {
    return next_region_ < regions_.size() && regions_[next_region_].begin <= offset;
  }

  const Text& text_;
  Outline& outline_;
  const FormatOptions& options_;
  Rows rows_;
  Layout layout_;
  std::vector<Region> regions_;
  size_t next_region_ = 0;
  const Line* before_ = nullptr;  // the line written last
  bool fresh_ = true;             // nothing written since its row: no comment, no region
  std::vector<Piece> prefix_;     // pieces that stand in the row of the next line, in front of it
};

}  // namespace frontend::formatting
