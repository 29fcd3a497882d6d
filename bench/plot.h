// A plot of curves over two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bench {

struct Curve {
  std::string name;
  std::string colour;
  bool dashed = false;
  std::vector<std::pair<double, double>> points;  // all above zero, x going up
};

std::string plot_svg(const std::string& title, const std::string& x_axis, const std::string& y_axis,
                     const std::vector<Curve>& curves);

}  // namespace bench
