#include "vm/runtime/summaries.h"

namespace vm {

TimeSummary summary_of(const Histogram& times) {
  return {times.min(), times.average(), times.quantile(0.99), times.max(), times.total()};
}

std::vector<TimeClass> classes_of(const Histogram& times) {
  std::vector<TimeClass> rows;
  for (uint32_t i = 0; i < Histogram::kClasses; ++i) {
    if (times.in_class(i) != 0) rows.push_back({Histogram::class_end(i), times.in_class(i)});
  }
  return rows;
}

}  // namespace vm
