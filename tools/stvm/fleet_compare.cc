// stvm fleet diff: each controller against the edited version of a fleet file, or two controllers
// against each other (E-32). 0: nothing differs; 1: something does, or one does not answer; 7: none
// answers.
#include <algorithm>
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/stvm/fleet_command.h"
#include "tools/stvm/fleet_diff.h"
#include "tools/stvm/fleet_visit.h"

namespace stvm {
namespace {

struct Compared {
  std::vector<FleetDifference> differences;
  std::vector<FleetRow> lost;  // who does not answer
};

// A controller of --fleet by its name, or a state directory or host.
FleetMember member_of(const std::vector<FleetMember>& known, const std::string& name) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const FleetMember& one) { return one.name == name; });
  return found == known.end() ? FleetMember{name, name} : *found;
}

base::Result<Compared> with_file(const tools::Options& options, const FleetAccess& access) {
  const std::string& path = options.arguments()[1];
  base::Result<tools::OpenedFleetFile> opened = tools::open_fleet_file(path);
  if (!opened.ok()) return opened.error();
  base::Result<ir::VerifiedImage> edited = ir::verify(std::move(opened->file.edited));
  if (!edited.ok()) return edited.error();
  base::Result<std::vector<FleetMember>> members = fleet_members(options);
  if (!members.ok()) return members.error();
  Compared out;
  for (const FleetMember& member : *members) {
    FleetRow row = FleetTalk(true).begin(member);
    std::optional<FleetSeen> seen = see(access, FleetTalk(true), member, row);
    if (!seen) {
      out.lost.push_back(std::move(row));
      continue;
    }
    out.differences.push_back(fleet_difference(edited->image(), seen->image.image()));
    out.differences.back().one = path;
    out.differences.back().other = member.name;
  }
  return out;
}

base::Result<Compared> with_each_other(const tools::Options& options, const FleetAccess& access) {
  std::vector<FleetMember> known;
  if (options.has("--fleet")) {
    base::Result<std::vector<FleetMember>> listed = read_fleet_list(options.text("--fleet"));
    if (!listed.ok()) return listed.error();
    known = std::move(*listed);
  }
  Compared out;
  std::vector<FleetSeen> both;
  for (size_t i = 1; i <= 2; ++i) {
    const FleetMember member = member_of(known, options.arguments()[i]);
    FleetRow row = FleetTalk(true).begin(member);
    std::optional<FleetSeen> seen = see(access, FleetTalk(true), member, row);
    if (seen) both.push_back(std::move(*seen));
    if (!seen) out.lost.push_back(std::move(row));
  }
  if (both.size() < 2) return out;
  out.differences.push_back(fleet_difference(both[0].image.image(), both[1].image.image()));
  out.differences.back().one = options.arguments()[1];
  out.differences.back().other = options.arguments()[2];
  return out;
}

void print_compared(const Compared& compared) {
  tools::JsonWriter json;
  json.begin_object().key("comparisons").begin_array();
  for (const FleetDifference& one : compared.differences) difference_json(one, json);
  json.end_array().key("controllers");
  fleet_rows_json(compared.lost, json);
  json.end_object();
  std::fputs(json.finish().c_str(), stdout);
}

int compared_exit_code(const Compared& compared) {
  if (compared.differences.empty()) return tools::kRefused;
  const bool same = std::all_of(compared.differences.begin(), compared.differences.end(),
                                [](const FleetDifference& one) { return one.parts.empty(); });
  return same && compared.lost.empty() ? tools::kOk : tools::kFindings;
}

}  // namespace

int compare_fleet(const tools::Options& options, const FleetAccess& access) {
  const size_t count = options.arguments().size();
  if (count == 1) {
    return refuse({base::Refusal::kUsage, "fleet: diff needs a fleet file or two controllers"});
  }
  base::Result<Compared> compared =
      count == 2 ? with_file(options, access) : with_each_other(options, access);
  if (!compared.ok()) return refuse(compared.error());
  if (wants_json(options)) {
    print_compared(*compared);
    return compared_exit_code(*compared);
  }
  for (const FleetDifference& one : compared->differences) {
    std::fputs(difference_text(one).c_str(), stdout);
  }
  if (!compared->lost.empty()) std::printf("\n%s", fleet_text(compared->lost).c_str());
  return compared_exit_code(*compared);
}

}  // namespace stvm
