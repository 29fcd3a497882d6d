// Wires inside of expressions. In FBD as text an operand may compute with the wires of boxes:
// `o2 := e * 2.0`. The operand is a source (Kind::kSource) with one input for each wire that
// stands in it; the input has the name of the wire as its first use writes it (`e`, `e.ENO`) and
// one link to the output of the box. Sources of other readers have no inputs.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::network {

// A name in an expression that could be the name of a wire: no member, no call, no name of a
// parameter, no value of an enumeration. Places are of the text.
struct FreeName {
  size_t begin = 0;
  size_t end = 0;
  size_t member_begin = 0;  // the name behind a `.` that follows; none: both are 0
  size_t member_end = 0;
};
std::vector<FreeName> free_names(std::string_view expression);

bool is_expression_of_wires(const Element& element);

// Pieces of the operand of a source: with `input`, what stands for that input; else plain text.
struct OperandPiece {
  std::string_view text;
  const Input* input = nullptr;
};
std::vector<OperandPiece> operand_pieces(const Element& source);

// The operand with other names for its wires.
std::string operand_with(const Element& source,
                         const std::function<std::string(const Input&)>& name);

// Expressions of wires as boxes of their own: their type is the text of the expression, which is
// for readers of a picture.
Network with_expression_boxes(const Network& network);

}  // namespace frontend::network
