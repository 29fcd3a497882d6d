#include "tools/stvm/times_text.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <vector>

#include "tools/common/fate_report.h"
#include "tools/common/json.h"

namespace stvm {
namespace {

constexpr double kBarColumns = 44;

// Scans by the power of two below their time: 2^k up to 2^(k+1) ns.
std::vector<uint64_t> by_power(const std::vector<vm::TimeClass>& classes) {
  std::vector<uint64_t> counts(64);
  for (const vm::TimeClass& row : classes) {
    const auto largest = static_cast<uint64_t>(std::max<int64_t>(row.end_ns - 1, 1));
    counts[static_cast<size_t>(std::bit_width(largest)) - 1] += row.count;
  }
  return counts;
}

std::string histogram_text(const char* title, const std::vector<vm::TimeClass>& classes) {
  const std::vector<uint64_t> counts = by_power(classes);
  const auto used = [](uint64_t count) { return count != 0; };
  const auto first = std::find_if(counts.begin(), counts.end(), used);
  const auto last = std::find_if(counts.rbegin(), counts.rend(), used).base();
  std::string text = std::string(title) + "\n";
  if (first == counts.end()) return text + "  none yet\n";
  const auto most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  for (auto at = first; at != last; ++at) {
    const auto power = static_cast<uint32_t>(at - counts.begin());
    const int64_t end = power >= 62 ? INT64_MAX : int64_t{2} << power;
    const auto bar = static_cast<size_t>(static_cast<double>(*at) / most * kBarColumns);
    char line[128];
    std::snprintf(line, sizeof line, "  below %8s %12llu  ", tools::duration(end).c_str(),
                  static_cast<unsigned long long>(*at));
    text += line + std::string(std::max<size_t>(bar, *at != 0 ? 1 : 0), '#') + "\n";
  }
  return text;
}

void classes_json(tools::JsonWriter& json, const char* name,
                  const std::vector<vm::TimeClass>& classes) {
  json.key(name).begin_array();
  for (const vm::TimeClass& row : classes) {
    json.begin_object().field("below_ns", row.end_ns).field("count", row.count).end_object();
  }
  json.end_array();
}

}  // namespace

std::string times_text(const vm::TaskTimes& times) {
  return "task " + times.name + "\n" + histogram_text("run time", times.run) +
         histogram_text("delay of the start", times.delay);
}

std::string times_json(const vm::TaskTimes& times) {
  tools::JsonWriter json;
  json.begin_object().field("task", times.name);
  classes_json(json, "run_ns", times.run);
  classes_json(json, "start_delay_ns", times.delay);
  json.end_object();
  return json.finish();
}

}  // namespace stvm
