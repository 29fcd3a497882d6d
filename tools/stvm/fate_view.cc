#include "tools/stvm/fate_view.h"

#include <algorithm>

#include "tools/common/fate_report.h"
#include "tools/common/live_key.h"
#include "tools/common/table.h"

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

std::string losses_text(const FatePage& page, const char* more_by) {
  if (page.loss_count == 0) return {};
  std::string out = "\n" + std::to_string(page.loss_count) + " live value(s) would be lost:\n";
  tools::Table table({"variable", "now", "after", "what"});
  for (const LossLine& line : page.losses) {
    table.row({line.loss.path, line.loss.old_value, line.loss.new_value, line.loss.what});
  }
  out += table.text();
  const uint64_t more = page.loss_count - std::min<uint64_t>(page.loss_count, page.losses.size());
  return more == 0 ? out : out + "and " + std::to_string(more) + " more" + more_by + "\n";
}

void losses_json(const FatePage& page, tools::JsonWriter& json) {
  json.field("loss_count", page.loss_count).key("losses").begin_array();
  for (const LossLine& line : page.losses) {
    json.begin_object().field("variable", line.loss.path).field("live", line.loss.old_value);
    json.field("after", line.loss.new_value).field("what", line.loss.what).end_object();
  }
  json.end_array();
}

base::Status check_losses(const FatePage& page, bool allowed) {
  if (page.loss_count == 0 || allowed) return base::Ok{};
  return base::Error{base::Refusal::kWouldLose,
                     std::to_string(page.loss_count) + " live value(s) would be lost"};
}

}  // namespace stvm
