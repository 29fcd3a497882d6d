// Transitions of charts that a change adds or takes away, by the names of their steps.
#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "base/name_case.h"
#include "online_change/plan/system_edits.h"

namespace online_change {
namespace {

using Transitions = std::multiset<std::string>;

// "Filling", "(Left, Right)"
std::string steps_text(const ir::Type& type, const std::vector<uint32_t>& members) {
  std::string out;
  for (const uint32_t member : members) {
    out += (out.empty() ? "" : ", ") + type.members[member].name;
  }
  return members.size() == 1 ? out : "(" + out + ")";
}

Transitions transitions_of(const ir::Image& image, const ir::LinkedChart& chart) {
  const ir::Type& type = image.types[image.pous[chart.pou].self];
  Transitions out;
  for (const ir::ChartMove& move : chart.moves) {
    out.insert(steps_text(type, move.from) + " -> " + steps_text(type, move.to));
  }
  return out;
}

// By the folded name of their POU.
std::map<std::string, const ir::LinkedChart*> charts_of(const ir::Image& image) {
  std::map<std::string, const ir::LinkedChart*> out;
  for (const ir::LinkedChart& chart : image.charts) {
    out.emplace(base::fold_name(image.pous[chart.pou].name), &chart);
  }
  return out;
}

void add_rows(const std::string& pou, const Transitions& there, const Transitions& elsewhere,
              const char* what, std::vector<SystemEdit>& rows) {
  Transitions only_there;
  std::ranges::set_difference(there, elsewhere, std::inserter(only_there, only_there.end()));
  for (const std::string& transition : only_there) {
    rows.push_back({"chart", pou, transition + " " + what});
  }
}

}  // namespace

std::vector<SystemEdit> chart_edits(const ir::Image& old_image, const ir::Image& new_image) {
  std::vector<SystemEdit> rows;
  const auto before = charts_of(old_image);
  for (const auto& [name, chart] : charts_of(new_image)) {
    const auto found = before.find(name);
    if (found == before.end()) continue;  // the POU is new, or was no chart: its code says so
    const Transitions old_moves = transitions_of(old_image, *found->second);
    const Transitions new_moves = transitions_of(new_image, *chart);
    const std::string& pou = new_image.pous[chart->pou].name;
    add_rows(pou, old_moves, new_moves, "removed", rows);
    add_rows(pou, new_moves, old_moves, "new", rows);
  }
  return rows;
}

}  // namespace online_change
