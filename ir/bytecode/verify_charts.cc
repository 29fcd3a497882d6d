// Nets of charts: one for a body that is a chart, over members of its instance type.
#include <algorithm>
#include <functional>

#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

base::Error bad_chart(const char* why) {
  return refuse(Refusal::kBadReference, std::string("net of a chart: ") + why);
}

bool are_members(const std::vector<uint32_t>& steps, size_t members) {
  return std::adjacent_find(steps.begin(), steps.end(), std::greater_equal<>()) == steps.end() &&
         (steps.empty() || steps.back() < members);
}

base::Status check(const Image& image, const LinkedChart& chart) {
  if (chart.pou >= image.pous.size()) return bad_chart("of no POU");
  const TypeId self = image.pous[chart.pou].self;
  if (!image.types.contains(self) || !image.types.is_instance(self))
    return bad_chart("of no instance");
  if (chart.moves.empty()) return bad_chart("it is empty");
  const size_t members = image.types[self].members.size();
  for (const ChartMove& move : chart.moves) {
    if (move.to.empty()) return bad_chart("a transition leads nowhere");
    if (!are_members(move.from, members) || !are_members(move.to, members)) {
      return bad_chart("a transition has steps that are no members, or are not sorted");
    }
  }
  return base::Ok{};
}

}  // namespace

base::Status verify_charts(const Image& image) {
  const auto unsorted = [](const LinkedChart& a, const LinkedChart& b) { return a.pou >= b.pou; };
  if (std::adjacent_find(image.charts.begin(), image.charts.end(), unsorted) !=
      image.charts.end()) {
    return bad_chart("two of one POU, or not sorted");
  }
  for (const LinkedChart& chart : image.charts) {
    if (base::Status s = check(image, chart); !s) return s;
  }
  return base::Ok{};
}

}  // namespace ir::verification
