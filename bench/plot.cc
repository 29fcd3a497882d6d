#include "bench/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench {
namespace {

constexpr double kWidth = 860, kHeight = 520;
constexpr double kLeft = 80, kRight = 230, kTop = 50, kBottom = 60;

// Whole powers of ten around all values.
struct Axis {
  double low = 0, high = 0, from = 0, to = 0;
  double at(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor + "'>" + text +
         "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1='" + number(x1) + "' y1='" + number(y1) + "' x2='" + number(x2) + "' y2='" +
         number(y2) + "' " + style + "/>\n";
}

std::string grid(const Axis& x, const Axis& y) {
  const std::string thin = "stroke='#ddd'";
  std::string out;
  for (double power = x.low; power <= x.high; ++power) {
    const double at = x.at(std::pow(10, power));
    out += line(at, y.from, at, y.to, thin);
    out += text_at(at, y.from + 18, "middle", label(std::pow(10, power)));
  }
  for (double power = y.low; power <= y.high; ++power) {
    const double at = y.at(std::pow(10, power));
    out += line(x.from, at, x.to, at, thin);
    out += text_at(x.from - 8, at + 4, "end", label(std::pow(10, power)));
  }
  return out;
}

std::string curve_svg(const Curve& curve, const Axis& x, const Axis& y, double legend_y) {
  const std::string style = "fill='none' stroke-width='2' stroke='" + curve.colour + "'" +
                            (curve.dashed ? " stroke-dasharray='6 4'" : "");
  std::string points;
  std::string out;
  for (const auto& [px, py] : curve.points) {
    points += number(x.at(px)) + "," + number(y.at(py)) + " ";
    out += "<circle r='3' fill='" + curve.colour + "' cx='" + number(x.at(px)) + "' cy='" +
           number(y.at(py)) + "'/>\n";
  }
  out += "<polyline points='" + points + "' " + style + "/>\n";
  out += line(x.to + 14, legend_y - 4, x.to + 44, legend_y - 4, style);
  return out + text_at(x.to + 50, legend_y, "start", curve.name);
}

}  // namespace

std::string plot_svg(const std::string& title, const std::string& x_axis, const std::string& y_axis,
                     const std::vector<Curve>& curves) {
  double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
  for (const Curve& curve : curves) {
    for (const auto& [px, py] : curve.points) {
      x_low = std::min(x_low, px), x_high = std::max(x_high, px);
      y_low = std::min(y_low, py), y_high = std::max(y_high, py);
    }
  }
  auto below = [](double value) { return std::floor(std::log10(value)); };
  auto above = [](double value) { return std::ceil(std::log10(value)); };
  const Axis x{below(x_low), above(x_high), kLeft, kWidth - kRight};
  const Axis y{below(y_low), above(y_high), kHeight - kBottom, kTop};
  std::string out = "<svg xmlns='http://www.w3.org/2000/svg' width='" + label(kWidth) +
                    "' height='" + label(kHeight) +
                    "' font-family='sans-serif' font-size='12'>\n"
                    "<rect width='100%' height='100%' fill='white'/>\n";
  out += text_at(kLeft, 28, "start", title) + grid(x, y);
  out += text_at((x.from + x.to) / 2, kHeight - 16, "middle", x_axis);
  out += "<g transform='translate(20," + number((y.from + y.to) / 2) + ") rotate(-90)'>" +
         text_at(0, 0, "middle", y_axis) + "</g>\n";
  double legend_y = kTop + 10;
  for (const Curve& curve : curves) out += curve_svg(curve, x, y, legend_y), legend_y += 20;
  return out + "</svg>\n";
}

}  // namespace bench
