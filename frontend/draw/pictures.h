// The parts of picture.h; each draws below `y` and returns what it has used.
#pragma once

#include "frontend/draw/picture.h"
#include "frontend/network/layout.h"

namespace frontend::draw {

inline constexpr double kLeft = 24;  // of everything

// One network as a rung, measured before all of them are drawn: they share the right rail.
class Rung {
 public:
  Rung(const network::Network& network, network::Placement placement, const Live* live);
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
  };
  void measure();

  const network::Network& network_;
  network::Placement placement_;
  const Live* live_;
  std::vector<struct Box> boxes_;
  std::vector<struct Symbol> symbols_;
  std::vector<Shape> shapes_;  // by cell
  std::vector<double> boundaries_;
  std::vector<double> columns_;
  std::vector<double> right_columns_;
  std::vector<double> wires_;  // y of each row
  Power power_;
  double width_ = 0;
  double height_ = 0;
};

// Returns its height.
double draw_boxes(Svg& svg, const network::Network& network, double y, const Live* live);

}  // namespace frontend::draw
