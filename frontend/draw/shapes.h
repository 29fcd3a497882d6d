// Elements of ladder and FBD as shapes: how much room they take, and their drawing. A shape hangs
// on its wire: `up` and `down` count from there.
#pragma once

#include <string>
#include <vector>

#include "frontend/draw/picture.h"
#include "frontend/draw/svg.h"
#include "frontend/network/element_text.h"

namespace frontend::draw {

inline constexpr double kPinRow = 18;

struct BoxPin {
  uint32_t pin = 0;  // of the element
  std::string name;
  std::string operand;   // what is connected by name, not by a wire
  std::string value;     // live
  std::string note;      // address and comment of the operand
  bool ring = false;     // negated
  bool through = false;  // its wire goes on: what is written stands above
  Truth truth = Truth::kUnknown;
};

struct Box {
  std::string title;  // instance
  std::string type;
  std::vector<BoxPin> inputs;
  std::vector<BoxPin> outputs;
  double before = 0;  // room for operands to the left
  double behind = 0;
  double width = 0;  // of the frame
  double up = 0;     // from the first pin
  double down = 0;
};

struct BoxStyle {
  uint32_t first_input = network::kNoPin;  // pins that stand in the first row
  uint32_t first_output = network::kNoPin;
  const Look* look = nullptr;
  const Power* power = nullptr;
  bool rails = true;  // power and feedback arrive by wires; otherwise they are written
};

// Address and comment of an operand in one line, the comment cut where it is long; empty: it has
// none.
std::string short_note(const Look& look, std::string_view operand);

// What is written for a link: an expression, TRUE for power, `box.output`.
std::string written_operand(const network::Network& network, network::Link link);
std::string sink_text(const network::Element& sink);

// `attached`: outputs of which the sinks are written beside the box. All inputs from sources have
// those written beside them.
Box make_box(const network::Network& network, const network::Sinks& sinks, uint32_t element,
             const std::vector<bool>& attached, const BoxStyle& style);
// The first pin's wire is at `y`; `x` is the left side of what is written before the frame.
void draw_box(Svg& svg, const Box& box, double x, double y);

struct Symbol {  // contact, coil, jump, return
  network::Kind kind = network::Kind::kContact;
  network::Modifier modifier = network::Modifier::kNone;
  std::string operand;
  std::string value;               // live
  std::vector<std::string> notes;  // lines above the operand
  Truth own = Truth::kUnknown;
  double width = 0;
  double up = 0;
  double down = 0;
};

Symbol make_symbol(const network::Element& element, const Look& look);
// In the middle of `width`, on the wire at `y`, with the wires that lead there.
void draw_symbol(Svg& svg, const Symbol& symbol, double x, double width, double y, Ink in, Ink out);

Ink ink(Truth truth);

}  // namespace frontend::draw
