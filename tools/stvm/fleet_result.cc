#include "tools/stvm/fleet_result.h"

#include <algorithm>

#include "tools/common/exit.h"
#include "tools/common/fleet_parts.h"
#include "tools/common/json.h"
#include "tools/common/table.h"
#include "tools/stvm/switch_text.h"

namespace stvm {
namespace {

// The text of units alone: "2 of 3", what the controller has as the edit wants it.
std::string units_text(const FleetRow& row) {
  size_t all = 0;
  size_t fit = 0;
  for (const ir::PartEdit& edit : row.parts) {
    if (edit.kind != ir::PartKind::kUnit) continue;
    ++all;
    fit += edit.state == ir::PartState::kOk || edit.state == ir::PartState::kHasIt;
  }
  return std::to_string(fit) + " of " + std::to_string(all);
}

std::string remark(const FleetRow& row) {
  if (row.report) {
    return "pause " + std::to_string(row.report->pause_ns / 1000) + " us, missed " +
           std::to_string(row.report->missed);
  }
  return row.why ? std::string(base::refusal_code(row.why->refusal)) + ": " + row.why->text : "";
}

}  // namespace

std::string_view outcome_name(FleetOutcome outcome) {
  constexpr std::string_view kNames[] = {"done",        "possible",  "had it",    "refused",
                                         "unreachable", "cancelled", "not asked", "reached",
                                         "undone",      "accepted",  "had it not",
                                         "taken back"};
  return kNames[static_cast<size_t>(outcome)];
}

bool is_good(FleetOutcome outcome) {
  switch (outcome) {
    case FleetOutcome::kRefused:
    case FleetOutcome::kUnreachable:
    case FleetOutcome::kCancelled:
    case FleetOutcome::kNotAsked:
    case FleetOutcome::kTakenBack:
      return false;
    default:
      return true;
  }
}

std::string fleet_text(const std::vector<FleetRow>& rows) {
  const bool of_edits =
      std::any_of(rows.begin(), rows.end(), [](const FleetRow& row) { return !row.edits.empty(); });
  const bool of_parts =
      std::any_of(rows.begin(), rows.end(), [](const FleetRow& row) { return !row.parts.empty(); });
  std::vector<std::string> titles = {"controller", "program", "outcome"};
  if (of_parts) titles.emplace_back("units fit");
  if (of_edits) titles.emplace_back("edit");
  titles.emplace_back("remark");
  tools::Table table(titles);
  for (const FleetRow& row : rows) {
    std::vector<std::string> cells = {row.place, row.program,
                                      std::string(outcome_name(row.outcome))};
    if (of_parts) cells.push_back(row.parts.empty() ? "-" : units_text(row));
    if (of_edits) cells.push_back(row.edits.empty() ? "-" : row.edits);
    cells.push_back(remark(row));
    table.row(std::move(cells));
  }
  return table.text();
}

std::string reasons_text(const std::vector<FleetRow>& rows) {
  std::string out;
  for (const FleetRow& row : rows) {
    if (row.why) out += row.place + ": " + remark(row) + "\n";
  }
  return out;
}

static void names_json(const char* key, const std::vector<std::string>& names,
                       tools::JsonWriter& json) {
  json.key(key).begin_array();
  for (const std::string& name : names) json.value(name);
  json.end_array();
}

static void mixtures_json(const std::vector<Mixture>& mixtures, tools::JsonWriter& json) {
  json.key("mixtures").begin_array();
  for (const Mixture& mixture : mixtures) {
    json.begin_object().field("cycle", mixture.cycle);
    names_json("new", mixture.new_ones, json);
    names_json("old", mixture.old_ones, json);
    json.end_object();
  }
  json.end_array();
}

static void row_json(const FleetRow& row, tools::JsonWriter& json) {
  json.begin_object().field("controller", row.place).field("program", row.program);
  json.field("outcome", std::string(outcome_name(row.outcome)));
  const bool known = row.from != base::Digest{};
  json.field("from", known ? base::to_hex(row.from) : std::string());
  json.key("parts");
  tools::part_edits_json(row.parts, true, json);
  json.key("table");
  tools::own_table_json(row.table, json);
  if (!row.edits.empty()) json.field("edits", row.edits);
  if (!row.mixtures.empty()) mixtures_json(row.mixtures, json);
  if (row.report) switch_json(*row.report, json);
  if (row.why) {
    json.field("refused", base::refusal_code(row.why->refusal));
    json.field("message", row.why->text);
  }
  json.end_object();
}

void fleet_rows_json(const std::vector<FleetRow>& rows, tools::JsonWriter& json) {
  json.begin_array();
  for (const FleetRow& row : rows) row_json(row, json);
  json.end_array();
}

std::string fleet_json(const base::Digest& file, const std::vector<FleetRow>& rows) {
  tools::JsonWriter json;
  json.begin_object().field("file", base::to_hex(file)).key("controllers");
  fleet_rows_json(rows, json);
  json.end_object();
  return json.finish();
}

int fleet_exit_code(const std::vector<FleetRow>& rows) {
  const auto good = std::count_if(rows.begin(), rows.end(),
                                  [](const FleetRow& row) { return is_good(row.outcome); });
  if (good == static_cast<std::ptrdiff_t>(rows.size())) return tools::kOk;
  return good == 0 ? tools::kRefused : tools::kFindings;
}

}  // namespace stvm
