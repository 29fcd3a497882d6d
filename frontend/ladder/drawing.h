// The drawing as rows of segments: what stands where, by column, and nothing of what it means.
// Columns count characters, not bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/network/head.h"

namespace frontend::ladder {

enum class SegmentKind : uint8_t {
  kWire,     // --
  kJoint,    // +
  kBar,      // |
  kContact,  // [ ... ]
  kCoil,     // ( ... )
};

struct Segment {
  SegmentKind kind = SegmentKind::kWire;
  uint32_t column = 0;  // first
  uint32_t end = 0;     // after the last
  uint32_t byte = 0;    // in the text, of the first character
  uint32_t bytes = 0;
  bool is_element() const { return kind >= SegmentKind::kContact; }
};

enum class RowKind : uint8_t { kBlank, kComment, kLabel, kHead, kDrawing };

struct Row {
  RowKind kind = RowKind::kBlank;
  std::vector<Segment> segments;      // kDrawing: not empty, by column
  std::vector<std::string> comments;  // without marks; also after a drawing or a label
  bool damaged = false;               // something of it was reported
  uint32_t label = 0;                 // kLabel: its byte
  uint32_t label_bytes = 0;
  network::Head head;  // kHead
};

// One row for each line of `text`, whose first byte is at `begin`. What cannot be read is reported
// (E1040, E1047) and left out.
std::vector<Row> read_rows(std::string_view text, base::SourcePos begin,
                           base::Diagnostics& diagnostics);

}  // namespace frontend::ladder
