// Rows of a drawing -> rungs: which elements touch which wire. A node is everything that wires
// join; power stands on all of it or on nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/ladder/drawing.h"

namespace frontend::ladder {

inline constexpr uint32_t kNoNode = 0xffffffffu;

struct Piece {  // an element as it is drawn
  SegmentKind kind = SegmentKind::kContact;
  uint32_t row = 0;
  uint32_t byte = 0;
  uint32_t bytes = 0;
  uint32_t left = kNoNode;  // in Rung::nodes
  uint32_t right = kNoNode;
};

struct Node {
  bool powered = false;           // touches the left rail
  bool ends = false;              // touches the right rail
  std::vector<uint32_t> drivers;  // pieces whose right side touches it
  std::vector<uint32_t> users;    // pieces whose left side does
  uint32_t byte = 0;              // of a wire of it, for messages
  uint32_t bytes = 0;
};

struct Rung {
  uint32_t first_row = 0;
  uint32_t last_row = 0;
  bool damaged = false;       // something of its rows was reported: more would be guessed
  std::vector<Piece> pieces;  // by row, then from left to right
  std::vector<Node> nodes;
};

// The rungs of all drawn rows. Wires that lead nowhere are reported (E1040, E1042).
std::vector<Rung> find_rungs(const std::vector<Row>& rows, base::SourcePos begin,
                             base::Diagnostics& diagnostics);

}  // namespace frontend::ladder
