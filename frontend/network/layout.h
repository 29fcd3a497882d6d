// Network -> where its elements stand as a ladder: a grid of columns of elements and rows of
// branches, for text (write_ladder.cc) and pictures (frontend/draw). Owns nothing of the network;
// costs time in proportion to it, but for the sorting of branches.
//
// Boundary `b` is the line to the left of column `b`; boundary 0 is beside the left rail. Cells
// `at_right` stand in front of the right rail, and their columns count from there.
#pragma once

#include <optional>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::network {

inline constexpr uint32_t kNoPin = 0xffffffffu;

struct Cell {
  uint32_t element = 0;
  uint32_t row = 0;
  uint32_t column = 0;
  bool at_right = false;
  uint32_t input = 0;        // where power arrives
  uint32_t output = kNoPin;  // where it goes on; kNoPin: nothing uses it
};

// A wire in a row, with the cells that stand on it.
struct Wire {
  uint32_t row = 0;
  uint32_t from = 0;       // boundary
  uint32_t to = 0;         // boundary
  bool from_rail = false;  // the left one; then `from` is 0
  bool to_rail = false;    // the right one; then `to` is Placement::columns
};

// Branches that meet or part: a line down a boundary. `rows` are those whose wires it joins, in
// ascending order; it crosses no others.
struct Joint {
  uint32_t boundary = 0;
  std::vector<uint32_t> rows;
};

struct Placement {
  uint32_t rows = 0;
  uint32_t columns = 0;
  uint32_t right_columns = 0;
  std::vector<Cell> cells;    // by row, then from left to right
  std::vector<Wire> wires;    // by row; the ends of two wires in a row do not touch
  std::vector<Joint> joints;  // no two touch, above each other at one boundary either
};

// nullopt when `network` is not made of nested series and parallel branches between the rails:
// a tap inside of a branch, a box with power at two pins, a value that goes from box to box
// elsewhere than along the rung, an element without power. A network without power (no elements,
// or rails alone) is a Placement without cells.
std::optional<Placement> place(const Network& network);

// Sources and sinks belong to the box that they stand at, rails are everywhere: these are not
// placed, all others are.
bool is_placed(Kind kind);

}  // namespace frontend::network
