#include "online_change/apply/charts.h"

#include <algorithm>
#include <cstring>

#include "online_change/diff/instance_match.h"
#include "online_change/diff/steps.h"

namespace online_change {
namespace {

using Moves = std::vector<ir::ChartMove>;

const Moves& moves_of(const ir::Image& image, uint32_t pou) {
  static const Moves kNoMoves;
  const auto before = [](const ir::LinkedChart& row, uint32_t number) { return row.pou < number; };
  const auto chart = std::lower_bound(image.charts.begin(), image.charts.end(), pou, before);
  return chart == image.charts.end() || chart->pou != pou ? kNoMoves : chart->moves;
}

using Names = std::vector<std::vector<std::string>>;

// By names: members of two versions have other numbers.
Names names_of(const ir::Image& image, const ir::Instance& row) {
  const std::vector<ir::Member>& members = image.types[row.type].members;
  Names names;
  for (const ir::ChartMove& move : moves_of(image, row.pou)) {
    for (const std::vector<uint32_t>* side : {&move.from, &move.to}) {
      std::vector<std::string>& of = names.emplace_back();
      for (const uint32_t step : *side) of.push_back(ir::fold_name(members[step].name));
      std::sort(of.begin(), of.end());
    }
  }
  return names;
}

// "`A` and `B` are"
std::string listed(const std::vector<const std::string*>& paths) {
  std::string text;
  for (size_t i = 0; i < paths.size(); ++i) {
    text += (i == 0 ? "`" : i + 1 == paths.size() ? " and `" : ", `") + *paths[i] + "`";
  }
  return text + (paths.size() == 1 ? " is" : " are");
}

}  // namespace

bool same_nets(const ir::Image& a, const ir::Image& b) { return a.charts == b.charts; }

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
    step.member = i;
    step.at = old_image.instances[old_id].data + old_image.layouts[old_type].member_offsets[i];
    step.size = old_image.layouts[members[i].type].size;
    const int32_t stays = new_image.types.find_member(new_type, members[i].name);
    step.goes = stays < 0;
    if (!step.goes) {
      step.next = static_cast<uint32_t>(stays);
      step.new_at = new_image.instances[new_id].data +
                    new_image.layouts[new_type].member_offsets[static_cast<size_t>(stays)];
    } else if (const int32_t taker = taker_of_step(old_image, old_type, new_image, new_type, i);
               taker >= 0) {
      step.next = static_cast<uint32_t>(taker);
    }
    step.path = old_image.instance_path(old_id) + "." + members[i].name;
    chart.steps.push_back(std::move(step));
  }
  add_new_steps(old_image, old_type, new_image, new_id, chart);
  // A body that becomes a chart, or is none any more: no step of one goes on, there or back.
  const bool ends = std::all_of(chart.steps.begin(), chart.steps.end(),
                                [](const Step& step) { return step.next == kNone; });
  if (chart.steps.empty() || (ends && chart.added.empty())) return;
  const bool any = std::any_of(chart.steps.begin(), chart.steps.end(),
                               [](const Step& step) { return step.goes; });
  const bool same = !any && chart.added.empty() &&
                    names_of(old_image, old_image.instances[old_id]) ==
                        names_of(new_image, new_image.instances[new_id]);
  if (same) return;
  chart.before = ChartNet(old_image, old_type);
  chart.after = ChartNet(new_image, new_type);
  charts_.push_back(std::move(chart));
}

void Charts::add_new_steps(const ir::Image& old_image, ir::TypeId old_type,
                           const ir::Image& new_image, uint32_t new_id, Chart& chart) {
  const ir::Instance& row = new_image.instances[new_id];
  const std::vector<ir::Member>& members = new_image.types[row.type].members;
  for (uint32_t i = 0; i < members.size(); ++i) {
    if (!is_step(new_image, members[i].type)) continue;
    if (old_image.types.find_member(old_type, members[i].name) >= 0) continue;
    Step step;
    step.member = i;
    step.new_at = row.data + new_image.layouts[row.type].member_offsets[i];
    step.path = new_image.instance_path(new_id) + "." + members[i].name;
    chart.added.push_back(std::move(step));
  }
}

std::string Charts::stuck(const uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    if (std::string why = stuck(chart, memory); !why.empty()) return why;
  }
  return {};
}

// A chart that is where its own net cannot lead is not held to the new one.
std::string Charts::stuck(const Chart& chart, const uint8_t* memory) {
  const Step* gone = nullptr;
  std::vector<uint32_t> now;
  std::vector<uint32_t> next;
  std::vector<const std::string*> paths;
  for (const Step& step : chart.steps) {
    if (memory[step.at] == 0) continue;
    now.push_back(step.member);
    paths.push_back(&step.path);
    if (step.next == kNone) {
      gone = &step;
    } else if (std::find(next.begin(), next.end(), step.next) == next.end()) {
      next.push_back(step.next);
    }
  }
  if (gone != nullptr && next.empty()) {
    const std::string name = gone->path.substr(gone->path.rfind('.') + 1);
    return "`" + gone->path + "` is active; wait until it is left, or write {renamed from := '" +
           name + "'} before the step that goes on for it";
  }
  if (next.empty() || !chart.after.known() || chart.after.reaches(next)) return {};
  if (chart.before.known() && !chart.before.reaches(now)) return {};
  return listed(paths) +
         " active, and the new chart can never be exactly there: it would wait for ever or do two "
         "things at once; make the change when its simultaneous branches have been left";
}

void Charts::note(const uint8_t* memory) {
  for (Chart& chart : charts_) {
    std::vector<uint32_t> active;
    for (Step& step : chart.steps) {
      step.active = memory[step.at] != 0;
      if (step.active) active.push_back(step.member);
    }
    chart.was_legal = chart.before.known() && chart.before.reaches(active);
  }
}

// Do the steps that were dropped while they were active become active again, when the steps
// `staying` are active?
bool Charts::comes_back(const Chart& chart, const std::vector<uint32_t>& staying) {
  std::vector<uint32_t> all = staying;
  bool moved = false;
  for (const Step& step : chart.steps) {
    const bool active = std::find(staying.begin(), staying.end(), step.member) != staying.end();
    if (step.goes && step.active) all.push_back(step.member);
    moved = moved || (!step.goes && active != step.active);
  }
  return chart.was_legal ? chart.before.reaches(all) : !moved || staying.empty();
}

std::string Charts::lost_on_the_way_back(const uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    if (std::string why = lost(chart, memory); !why.empty()) return why;
  }
  return {};
}

std::string Charts::lost(const Chart& chart, const uint8_t* memory) {
  const Step* dropped = nullptr;  // while it was active
  const Step* added = nullptr;
  std::vector<uint32_t> staying;
  std::vector<const std::string*> paths;
  for (const Step& step : chart.steps) {
    if (step.goes && step.active && step.next == kNone) dropped = &step;
    if (step.goes || memory[step.new_at] == 0) continue;
    staying.push_back(step.member);
    paths.push_back(&step.path);
  }
  for (const Step& step : chart.added) {
    if (memory[step.new_at] != 0) added = &step;
  }
  if (added != nullptr && staying.empty()) {
    return "`" + added->path +
           "` is active, and the version before has no such step; undo when it has been left, or "
           "accept";
  }
  if (staying.empty() || comes_back(chart, staying)) return {};
  const bool goes_on = chart.was_legal ? chart.before.reaches(staying) : dropped == nullptr;
  if (goes_on) return {};
  return listed(paths) +
         " active, and the chart of the version before can never be exactly there; undo when its "
         "simultaneous branches have been left, or accept";
}

void Charts::settle(uint8_t* memory) const {
  for (const Chart& chart : charts_) {
    std::vector<uint32_t> staying;
    for (const Step& step : chart.steps) {
      if (!step.goes && memory[step.at] != 0) staying.push_back(step.member);
    }
    if (comes_back(chart, staying)) continue;
    for (const Step& step : chart.steps) {
      if (step.goes) std::memset(memory + step.at, 0, step.size);
    }
  }
}

}  // namespace online_change
