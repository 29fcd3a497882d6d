// The parts of picture.h; each draws below `y` and returns what it has used.
#pragma once

#include "frontend/draw/picture.h"
#include "frontend/network/element_text.h"
#include "frontend/network/layout.h"

namespace frontend::draw {

inline constexpr double kLeft = 24;  // of everything

// One network as a rung, measured before all of them are drawn: they share the right rail. A rung
// that is longer than Look::width is drawn in several strips below each other; wires that go on
// end and begin at arrows with the same number.
class Rung {
 public:
  Rung(const network::Network& network, network::Placement placement, const Look& look);
  double width() const { return width_; }
  double height() const { return height_; }
  // Room for what stands beside the right rail; 0: nothing does.
  double coil() const { return right_columns_.empty() ? 0 : right_columns_[0]; }
  void widen_coil(double room);
  // The right rail is `width` after kLeft.
  void draw(Svg& svg, double y, double width) const;

 private:
  class Pen;
  struct Shape {
    bool box = false;
    uint32_t number = 0;  // in boxes_ or symbols_
    double width = 0;
    double up = 0;
    double down = 0;
  };
  struct Strip {
    uint32_t first = 0;  // columns [first, last)
    uint32_t last = 0;
    double left = 0;                 // what its boundaries are counted from
    std::vector<double> wires;       // y of each row, if it is used
    std::vector<uint32_t> going_on;  // rows whose wires go on in the next strip
    double top = 0;
    double bottom = 0;
  };
  void measure();
  Shape measure(const network::Cell& cell, const network::Sinks& sinks);
  void cut();
  void stack();
  bool shows(const Strip& strip, const network::Cell& cell) const;

  const network::Network& network_;
  network::Placement placement_;
  Look look_;
  std::vector<struct Box> boxes_;
  std::vector<struct Symbol> symbols_;
  std::vector<Shape> shapes_;  // by cell
  std::vector<double> boundaries_;
  std::vector<double> columns_;
  std::vector<double> right_columns_;
  std::vector<Strip> strips_;
  Power power_;
  double width_ = 0;
  double height_ = 0;
};

// `rails`: how far the right rail of a ladder is from kLeft; 0: a function block diagram. Returns
// its height.
double draw_boxes(Svg& svg, const network::Network& network, double y, const Look& look,
                  double rails);

}  // namespace frontend::draw
