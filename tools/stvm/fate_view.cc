#include "tools/stvm/fate_view.h"

#include "tools/common/fate_report.h"
#include "tools/common/live_key.h"

namespace stvm {
namespace {

online_change::Plan plan_of(const FatePage& page) {
  online_change::Plan plan;
  plan.counts = page.counts;
  plan.predicted_pause_ns = page.predicted_pause_ns;
  plan.boundary_bytes = page.boundary_bytes;
  for (const FateLine& line : page.lines) plan.fates.push_back(line.row);
  return plan;
}

tools::LiveValues live_of(const FatePage& page) {
  tools::LiveValues live;
  for (const FateLine& line : page.lines) {
    bool any = !line.live.now.empty() || !line.live.after.empty();
    if (any) live[tools::live_key(line.row)] = line.live;
  }
  return live;
}

}  // namespace

std::string fates_text(const FatePage& page) {
  return tools::fate_report(plan_of(page), live_of(page), page.edits, page.system);
}

void fates_json(const FatePage& page, tools::JsonWriter& json) {
  tools::fate_report(plan_of(page), live_of(page), page.edits, page.system, json);
}

}  // namespace stvm
