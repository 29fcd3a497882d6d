// The formatted text as rows, before columns are aligned: what stands in the row, what comment
// after it, and at which places it may be padded. One buffer holds all texts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frontend/format/format.h"
#include "frontend/format/text.h"

namespace frontend::formatting {

enum class RowKind : uint8_t {
  kCode,
  kComment,   // on a line of its own
  kVerbatim,  // copied with its line breaks
  kJoined,    // the same, directly after what stands before
};

// Where a row may be padded: in front of `AT` (or a label's statement), of `:`, and of `:=` or
// `=>`.
inline constexpr uint32_t kMarks = 3;

struct Row {
  uint32_t indent = 0;  // columns
  uint32_t begin = 0;   // code or comment, in Rows::buffer
  uint32_t end = 0;
  uint32_t comment = 0;                           // the comment after the code: [end, comment)
  uint32_t width = 0;                             // columns of the code
  uint32_t source_column = Text::kUnknownColumn;  // where its comment stood
  uint32_t mark[kMarks] = {};                     // where it may be padded: offsets from begin,
  uint32_t mark_column[kMarks] = {};              // and columns after the indentation
  uint32_t group = 0;                             // rows with the same number are aligned; 0: none
  RowKind kind = RowKind::kCode;
  bool blank_before = false;
};

struct Rows {
  std::string buffer;
  std::vector<Row> rows;
};

// Pads marks and comments of neighbouring rows and joins everything to a text.
std::string align(const Rows& rows, const FormatOptions& options, const Text& text);

}  // namespace frontend::formatting
