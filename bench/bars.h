// A chart of horizontal bars on a logarithmic axis that begins at 1, as SVG: for ratios.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct Bars {
  struct Series {
    std::string name;
    double goal = 0;  // drawn as a dashed line
  };
  struct Row {
    std::string name;            // "": a gap
    std::vector<double> values;  // one for each series; 0: none
  };
  std::string title;
  std::vector<Series> series;
  std::vector<Row> rows;
};

std::string bars_svg(const Bars& bars);

}  // namespace bench
