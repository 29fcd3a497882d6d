// Variables over the scans of a run as an SVG picture: a lane for each, steps as the values are.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "vm/runtime/controller.h"

namespace stvm {

class Plot {
 public:
  // Numbers, times and BOOLs; kBadValue for anything else, kNoSuchVariable, kUsage for more than
  // kMaxLanes or none.
  static base::Result<Plot> of(const vm::Controller& controller, std::vector<std::string> names);
  static constexpr size_t kMaxLanes = 40;

  // At a boundary; memory is bounded however long the run is: neighbours are joined to their
  // extremes when there are more samples than columns.
  void sample(const vm::Controller& controller);
  std::string svg(const std::string& title) const;

 private:
  // What one column of the picture shows.
  struct Column {
    uint64_t scan = 0;
    double first = 0;
    double low = 0;
    double high = 0;
    double last = 0;
  };
  struct Lane {
    std::string name;
    ir::Symbol symbol;
    bool boolean = false;
    std::string unit;
    std::vector<Column> columns;
  };
  static void join_neighbours(std::vector<Column>& columns);
  std::string lane_svg(const Lane& lane, size_t number, double top, uint64_t begin,
                       uint64_t end) const;

  std::vector<Lane> lanes_;
  uint64_t per_column_ = 1;  // samples
  uint64_t in_column_ = 0;
  int64_t scan_ns_ = 0;
};

}  // namespace stvm
