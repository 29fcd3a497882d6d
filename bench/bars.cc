#include "bench/bars.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench {
namespace {

constexpr double kLeft = 170, kPlotWidth = 600, kRight = 60, kTop = 80, kBottom = 34;
constexpr double kBar = 11, kBetween = 7, kGap = 12;
const char* const kColours[] = {"#4477aa", "#ee8866", "#228833", "#aa3377"};

std::string number(double value, const char* format = "%.1f") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* more = "") {
  return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor + "'" + more +
         ">" + text + "</text>\n";
}

std::string vertical(double x, double from, double to, const std::string& style) {
  return "<line x1='" + number(x) + "' y1='" + number(from) + "' x2='" + number(x) + "' y2='" +
         number(to) + "' " + style + "/>\n";
}

std::string bar(double x1, double x2, double y, const char* colour) {
  return "<rect x='" + number(std::min(x1, x2)) + "' y='" + number(y) + "' width='" +
         number(std::max(std::fabs(x2 - x1), 1.0)) + "' height='" + number(kBar) + "' fill='" +
         colour + "'/>\n";
}

// Powers of two around all values and 1.
struct Axis {
  double low = 0, high = 1;  // exponents
  double at(double value) const {
    return kLeft + (std::log2(value) - low) / (high - low) * kPlotWidth;
  }
};

Axis axis_of(const Bars& bars) {
  Axis axis;
  const auto include = [&](double value) {
    if (value <= 0) return;
    axis.low = std::min(axis.low, std::floor(std::log2(value)));
    axis.high = std::max(axis.high, std::ceil(std::log2(value)));
  };
  for (const Bars::Series& series : bars.series) include(series.goal);
  for (const Bars::Row& row : bars.rows) {
    for (double value : row.values) include(value);
  }
  return axis;
}

double height_of(const Bars& bars, const Bars::Row& row) {
  return row.name.empty() ? kGap : kBar * static_cast<double>(bars.series.size()) + kBetween;
}

std::string grid(const Axis& axis, double bottom) {
  std::string out;
  for (double power = axis.low; power <= axis.high; ++power) {
    const double x = axis.at(std::exp2(power));
    out += vertical(x, kTop - 4, bottom, power == 0 ? "stroke='#555'" : "stroke='#ddd'");
    out += text_at(x, bottom + 18, "middle", power == 0 ? "1 = C" : number(std::exp2(power), "%g"));
  }
  return out;
}

std::string legend(const Bars& bars) {
  std::string out;
  double x = kLeft;
  for (size_t s = 0; s < bars.series.size(); ++s) {
    out += bar(x, x + 22, 48, kColours[s % 4]);
    const std::string text = bars.series[s].name + " (dashed: goal for the mean, " +
                             number(bars.series[s].goal, "%g") + ")";
    out += text_at(x + 28, 58, "start", text);
    x += 300;
  }
  return out;
}

std::string row_svg(const Bars& bars, const Bars::Row& row, const Axis& axis, double y) {
  if (row.name.empty()) return "";
  const double middle = y + kBar * static_cast<double>(bars.series.size()) / 2;
  std::string out = text_at(kLeft - 10, middle + 4, "end", row.name);
  for (size_t s = 0; s < row.values.size(); ++s) {
    const double value = row.values[s];
    if (value <= 0) continue;
    const double top = y + kBar * static_cast<double>(s);
    out += bar(axis.at(1), axis.at(value), top, kColours[s % 4]);
    out +=
        text_at(std::max(axis.at(value), axis.at(1)) + 5, top + kBar - 1.5, "start",
                number(value, value < 10 ? "%.2f" : "%.1f"),
                " font-size='10' fill='#333' stroke='white' stroke-width='3' paint-order='stroke'");
  }
  return out;
}

}  // namespace

std::string bars_svg(const Bars& bars) {
  const Axis axis = axis_of(bars);
  double bottom = kTop;
  for (const Bars::Row& row : bars.rows) bottom += height_of(bars, row);
  std::string out = "<svg xmlns='http://www.w3.org/2000/svg' width='" +
                    number(kLeft + kPlotWidth + kRight, "%g") + "' height='" +
                    number(bottom + kBottom, "%g") +
                    "' font-family='sans-serif' font-size='12'>\n"
                    "<rect width='100%' height='100%' fill='white'/>\n";
  out +=
      text_at(20, 26, "start", bars.title, " font-size='14'") + legend(bars) + grid(axis, bottom);
  for (size_t s = 0; s < bars.series.size(); ++s) {
    out += vertical(axis.at(bars.series[s].goal), kTop - 4, bottom,
                    std::string("stroke-dasharray='5 4' stroke='") + kColours[s % 4] + "'");
  }
  double y = kTop;
  for (const Bars::Row& row : bars.rows) {
    out += row_svg(bars, row, axis, y);
    y += height_of(bars, row);
  }
  return out + "</svg>\n";
}

}  // namespace bench
