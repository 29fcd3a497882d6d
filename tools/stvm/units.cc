#include "tools/stvm/units.h"

#include <algorithm>

#include "base/joined.h"
#include "base/name_case.h"
#include "ir/bytecode/identities.h"
#include "tools/common/json.h"
#include "tools/common/pattern.h"
#include "tools/common/table.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

constexpr size_t kWhoColumns = 10;
constexpr base::Digest kNoContent{};

const char* slot_text(uint8_t slot) { return slot == 0 ? "A" : "B"; }

const char* pou_kind_text(ir::PouKind kind) {
  constexpr const char* kNames[] = {"function", "function block", "program", "method"};
  return kNames[static_cast<size_t>(kind)];
}

// The short form of a kind in a table: "FB".
std::string short_kind(const std::string& kind) {
  if (kind == "function block") return "FB";
  return kind == "function" ? "FUN" : kind == "program" ? "PRG" : kind == "method" ? "MET" : "";
}

// "11-26 18:05": a row has eighty columns, and JSON has the rest.
std::string minute_text(int64_t time_ns) {
  const std::string text = time_text(time_ns);
  if (text.size() < 16 || text[10] != 'T') return text;
  return text.substr(5, 5) + " " + text.substr(11, 5);
}

std::string content_text(const UnitView& unit) {
  if (unit.content == kNoContent) return "-";
  return base::short_hex(unit.content) + (unit.edited ? "*" : "");
}

// What the other columns leave of eighty for the name of a unit.
size_t name_columns(const std::vector<UnitView>& units) {
  size_t who = 2;
  for (const UnitView& unit : units)
    who = std::max(who, std::min(unit.row.who.size(), kWhoColumns));
  constexpr size_t kOthers = 4 + 13 + 4 + 6 + 11 + 6 * 2;  // and between columns
  return 80 - kOthers - who;
}

std::string cut(std::string name, size_t columns) {
  if (name.size() > columns) name.replace(columns - 2, std::string::npos, "..");
  return name;
}

bool is_wanted(const std::string& name, const std::vector<std::string>& patterns) {
  return patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const auto& one) {
           return tools::matches(one, name);
         });
}

const base::Digest& content_of(const std::vector<ir::Part>& parts, const std::string& unit) {
  const ir::Part* const part = ir::find_part(parts, ir::PartKind::kUnit, unit);
  return part == nullptr ? kNoContent : part->identity;
}

// The newest edit after which the unit is another one than before it.
void find_edit(const std::vector<EditStep>& edits, UnitView& unit) {
  for (auto step = edits.rbegin(); step != edits.rend(); ++step) {
    if (content_of(step->before, unit.unit) == unit.content) continue;
    unit.edit = step->edit.name;
    unit.edited_by = step->edit.who;
    unit.edited_ns = step->edit.time_ns;
    return;
  }
}

std::string fact(const ControllerFacts& facts, const char* name) {
  const auto found = facts.find(name);
  return found == facts.end() ? std::string() : found->second;
}

}  // namespace

std::vector<UnitView> unit_views(const std::vector<UnitRow>& rows, const ir::Image& running,
                                 const std::vector<EditStep>& edits,
                                 const std::vector<std::string>& patterns) {
  std::map<std::string, uint32_t> numbers;
  for (uint32_t i = 0; i < running.pous.size(); ++i) numbers[running.pous[i].name] = i;
  const std::vector<ir::Part> parts = ir::parts_of(running);
  std::vector<UnitView> units;
  for (const UnitRow& row : rows) {
    if (!is_wanted(row.name, patterns)) continue;
    UnitView unit{row, {}, {}, {}, false, {}, {}, 0};
    if (const auto found = numbers.find(row.name); found != numbers.end()) {
      unit.kind = pou_kind_text(running.pous[found->second].kind);
      unit.unit = ir::unit_name(running, found->second);
      unit.content = content_of(parts, unit.unit);
    }
    unit.edited = !edits.empty() && unit.content != content_of(edits.front().before, unit.unit);
    if (unit.edited) find_edit(edits, unit);
    units.push_back(std::move(unit));
  }
  return units;
}

std::string units_text(const std::vector<UnitView>& units) {
  const size_t columns = name_columns(units);
  tools::Table table({"unit", "kind", "identity", "slot", "other", "since (UTC)", "by"});
  bool edited = false;
  for (const UnitView& unit : units) {
    const char* const other =
        unit.row.other == OtherSlot::kEmpty ? "-" : other_slot_name(unit.row.other);
    table.row({cut(unit.row.name, columns), short_kind(unit.kind), content_text(unit),
               slot_text(unit.row.slot), other, minute_text(unit.row.time_ns),
               unit.row.who.substr(0, kWhoColumns)});
    edited = edited || unit.edited;
  }
  return table.text() + (edited ? "* edited since the program was accepted (stvm edits)\n" : "");
}

std::string facts_text(const ControllerFacts& facts, const vm::StatusReport& status) {
  const auto number = [](uint64_t value) { return std::to_string(value); };
  std::string out;
  if (facts.empty()) {
    out = "controller  of an older version, which says no more about itself\n";
  } else {
    out =
        base::joined({"controller  stvm ", fact(facts, "version"), ", images ",
                      fact(facts, "first_image_version"), " to ", fact(facts, "last_image_version"),
                      ", protocol ", fact(facts, "protocol"), "\n"});
  }
  out += base::joined({"memory      ", number(status.memory.capacity), " bytes, ",
                       number(status.memory.free), " free, ", number(status.memory.largest_free),
                       " in one piece\n"});
  const std::string machine = fact(facts, "native_tier");
  out += status.native_pous == 0
             ? std::string("code        interpreted\n")
             : base::joined({"code        native", machine.empty() ? "" : ", " + machine, ", ",
                             number(status.native_pous), " of ", number(status.pous), " POUs\n"});
  if (facts.empty()) return out;
  return out + base::joined({"edits       ", number(status.edits), " on trial of ",
                             fact(facts, "most_edits_on_trial"), " at most; a package of ",
                             fact(facts, "most_package_bytes"), " bytes\n            ",
                             fact(facts, "most_pous"), " POUs, ", fact(facts, "most_instances"),
                             " instances, ", fact(facts, "most_retained_bytes"),
                             " retained bytes at most\n"});
}

static void unit_json(const UnitView& unit, tools::JsonWriter& json) {
  const UnitRow& row = unit.row;
  json.begin_object().field("unit", row.name).field("kind", unit.kind);
  json.field("part_of", unit.unit);
  json.field("content", unit.content == kNoContent ? std::string() : base::to_hex(unit.content));
  json.field("edited", unit.edited);
  if (unit.edited) {
    json.field("edit", unit.edit).field("edited_by", unit.edited_by);
    json.field("edited_at", unit.edit.empty() ? std::string() : time_text(unit.edited_ns));
  }
  json.field("instances", row.instances);
  json.field("slot", slot_text(row.slot)).field("identity", base::to_hex(row.unit));
  json.field("other_slot", other_slot_name(row.other));
  if (row.other != OtherSlot::kEmpty) {
    json.field("other_identity", base::short_hex(row.other_unit));
    json.field("other_version", base::short_hex(row.other_version));
  }
  json.field("since", time_text(row.time_ns)).field("cycle", row.cycle);
  json.field("event", row.event).field("by", row.who).end_object();
}

std::string units_json(const std::vector<UnitView>& units, const ControllerFacts& facts,
                       const vm::StatusReport& status) {
  tools::JsonWriter json;
  json.begin_object().key("units").begin_array();
  for (const UnitView& unit : units) unit_json(unit, json);
  json.end_array().key("controller").begin_object();
  for (const auto& [name, value] : facts) {
    const bool digits = !value.empty() && value.find_first_not_of("0123456789") == value.npos;
    json.key(name);
    digits ? json.number(value) : json.value(value);
  }
  json.field("memory", status.memory.capacity).field("memory_free", status.memory.free);
  json.field("largest_free", status.memory.largest_free).field("pous", status.pous);
  json.field("native_pous", status.native_pous).field("edits", status.edits);
  json.end_object().end_object();
  return json.finish();
}

}  // namespace stvm
