#include "tools/stvm/switch_text.h"

#include "tools/common/fate_report.h"

namespace stvm {

std::string switch_text(const char* verb, const online_change::SwitchReport& report) {
  return std::string(verb) + " between cycle " + std::to_string(report.cycle_before) + " and " +
         std::to_string(report.cycle_after) + ": pause " + tools::duration(report.pause_ns) + ", " +
         std::to_string(report.missed) + " releases missed\n";
}

void switch_json(const online_change::SwitchReport& report, tools::JsonWriter& json) {
  json.field("cycle_before", report.cycle_before).field("cycle_after", report.cycle_after);
  json.field("pause_ns", report.pause_ns).field("missed", report.missed);
}

}  // namespace stvm
