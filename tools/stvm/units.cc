#include "tools/stvm/units.h"

#include <algorithm>

#include "tools/common/json.h"
#include "tools/common/table.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

constexpr size_t kWhoColumns = 10;

const char* slot_text(uint8_t slot) { return slot == 0 ? "A" : "B"; }

std::string other_text(const UnitRow& row) {
  if (row.other == OtherSlot::kEmpty) return "-";
  return base::short_hex(row.other_unit).substr(0, 8) + " " + other_slot_name(row.other);
}

// "11-26 18:05": a row has eighty columns, and JSON has the rest.
std::string minute_text(int64_t time_ns) {
  const std::string text = time_text(time_ns);
  if (text.size() < 16 || text[10] != 'T') return text;
  return text.substr(5, 5) + " " + text.substr(11, 5);
}

// What the other columns leave of eighty for the name of a unit.
size_t name_columns(const std::vector<UnitRow>& rows) {
  size_t instances = 4;
  size_t cycle = 5;
  size_t who = 2;
  for (const UnitRow& row : rows) {
    instances = std::max(instances, std::to_string(row.instances).size());
    cycle = std::max(cycle, std::to_string(row.cycle).size());
    who = std::max(who, std::min(row.who.size(), kWhoColumns));
  }
  constexpr size_t kOthers = 4 + 15 + 11 + 6 * 2;  // slot, other slot, since; and between columns
  return std::max<size_t>(80 - std::min<size_t>(kOthers + instances + cycle + who, 72), 8);
}

std::string cut(std::string name, size_t columns) {
  if (name.size() > columns) name.replace(columns - 2, std::string::npos, "..");
  return name;
}

}  // namespace

std::string units_text(const std::vector<UnitRow>& rows) {
  const size_t columns = name_columns(rows);
  tools::Table table({"unit", "> inst", "slot", "other slot", "since (UTC)", "> cycle", "by"});
  for (const UnitRow& row : rows) {
    table.row({cut(row.name, columns), row.instances == 0 ? "" : std::to_string(row.instances),
               slot_text(row.slot), other_text(row), minute_text(row.time_ns),
               std::to_string(row.cycle), row.who.substr(0, kWhoColumns)});
  }
  return table.text();
}

std::string units_json(const std::vector<UnitRow>& rows) {
  tools::JsonWriter json;
  json.begin_object().key("units").begin_array();
  for (const UnitRow& row : rows) {
    json.begin_object().field("unit", row.name).field("instances", row.instances);
    json.field("slot", slot_text(row.slot)).field("identity", base::to_hex(row.unit));
    json.field("other_slot", other_slot_name(row.other));
    if (row.other != OtherSlot::kEmpty) {
      json.field("other_identity", base::short_hex(row.other_unit));
      json.field("other_version", base::short_hex(row.other_version));
    }
    json.field("since", time_text(row.time_ns)).field("cycle", row.cycle);
    json.field("event", row.event).field("by", row.who).end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

}  // namespace stvm
