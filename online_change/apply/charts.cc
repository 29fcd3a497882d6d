#include "online_change/apply/charts.h"

#include <algorithm>
#include <cstring>

#include "online_change/diff/instance_match.h"
#include "online_change/diff/steps.h"

namespace online_change {

Charts::Charts(const ir::Image& old_image, const ir::Image& new_image) {
  const InstanceMatch match = match_instances(old_image, new_image);
  for (uint32_t id : match.old_order) {
    if (id != 0 && match.new_of_old[id] != kNoInstance) {
      add(old_image, new_image, id, match.new_of_old[id]);
    }
  }
}

void Charts::add(const ir::Image& old_image, const ir::Image& new_image, uint32_t old_id,
                 uint32_t new_id) {
  const ir::TypeId old_type = old_image.instances[old_id].type;
  const ir::TypeId new_type = new_image.instances[new_id].type;
  const std::vector<ir::Member>& members = old_image.types[old_type].members;
  Chart chart;
  for (uint32_t i = 0; i < members.size(); ++i) {
    if (!is_step(old_image, members[i].type)) continue;
    Step step;
    step.at = old_image.instances[old_id].data + old_image.layouts[old_type].member_offsets[i];
    step.size = old_image.layouts[members[i].type].size;
    const int32_t stays = new_image.types.find_member(new_type, members[i].name);
    step.goes = stays < 0;
    if (!step.goes) {
      step.new_at = new_image.instances[new_id].data +
                    new_image.layouts[new_type].member_offsets[static_cast<size_t>(stays)];
    }
    step.taken = step.goes && taker_of_step(old_image, old_type, new_image, new_type, i) >= 0;
    step.path = old_image.instance_path(old_id) + "." + members[i].name;
    chart.steps.push_back(std::move(step));
  }
  add_new_steps(old_image, old_type, new_image, new_id, chart);
  const bool any = std::any_of(chart.steps.begin(), chart.steps.end(),
                               [](const Step& step) { return step.goes; });
  if (any || !chart.added.empty()) charts_.push_back(std::move(chart));
}

void Charts::add_new_steps(const ir::Image& old_image, ir::TypeId old_type,
                           const ir::Image& new_image, uint32_t new_id, Chart& chart) {
  const ir::Instance& row = new_image.instances[new_id];
  const std::vector<ir::Member>& members = new_image.types[row.type].members;
  for (uint32_t i = 0; i < members.size(); ++i) {
    if (!is_step(new_image, members[i].type)) continue;
    if (old_image.types.find_member(old_type, members[i].name) >= 0) continue;
    Step step;
    step.new_at = row.data + new_image.layouts[row.type].member_offsets[i];
    step.path = new_image.instance_path(new_id) + "." + members[i].name;
    chart.added.push_back(std::move(step));
  }
}

std::string Charts::deserted(const uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    const Step* gone = nullptr;
    bool goes_on = false;
    for (const Step& step : chart.steps) {
      if (memory[step.at] == 0) continue;
      if (step.goes && !step.taken) {
        gone = &step;
      } else {
        goes_on = true;
      }
    }
    if (gone != nullptr && !goes_on) return gone->path;
  }
  return {};
}

void Charts::note(const uint8_t* memory) {
  for (Chart& chart : charts_) {
    for (Step& step : chart.steps) step.active = memory[step.at] != 0;
  }
}

std::string Charts::lost_on_the_way_back(const uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    const Step* dropped = nullptr;  // while it was active
    const Step* beside = nullptr;   // active with it, and stayed
    const Step* added = nullptr;
    bool moved = false;
    bool goes_on = false;
    for (const Step& step : chart.steps) {
      if (step.goes) {
        if (step.active && !step.taken) dropped = &step;
        continue;
      }
      const bool active = memory[step.new_at] != 0;
      if (step.active) beside = &step;
      goes_on = goes_on || active;
      moved = moved || active != step.active;
    }
    for (const Step& step : chart.added) {
      if (memory[step.new_at] != 0) added = &step;
    }
    if (added != nullptr && !goes_on) {
      return "`" + added->path +
             "` is active, and the version before has no such step; undo when "
             "it has been left, or accept";
    }
    if (dropped != nullptr && beside != nullptr && moved) {
      return "`" + dropped->path + "` was active beside `" + beside->path +
             "` when it was dropped, and the chart has gone on: whether its branch is over is not "
             "known; undo when `" +
             beside->path + "` is active again, or accept";
    }
  }
  return {};
}

void Charts::settle(uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    bool moved = false;  // steps that stayed are not those that were active then
    bool any = false;
    for (const Step& step : chart.steps) {
      if (step.goes) continue;
      const bool active = memory[step.at] != 0;
      any = any || active;
      moved = moved || active != step.active;
    }
    if (!moved || !any) continue;
    for (const Step& step : chart.steps) {
      if (step.goes) std::memset(memory + step.at, 0, step.size);
    }
  }
}

}  // namespace online_change
