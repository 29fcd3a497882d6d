// Texts in the subset of TOML: stc.toml with all its tables, trust files, lists of fleets
// with waves and broker, and the stored plan of a roll-out. Read, or refused with a place in the
// text; what is written again is read as it was.
#include <algorithm>

#include "base/check.h"
#include "tools/common/change_settings.h"
#include "tools/common/trust_file.h"
#include "tools/stc/defines.h"
#include "tools/stc/device_tables.h"
#include "tools/stc/format_settings.h"
#include "tools/stc/safe_settings.h"
#include "tools/stc/unit_settings.h"
#include "tools/stc/warning_settings.h"
#include "tools/stvm/fleet_broker.h"
#include "tools/stvm/fleet_plan.h"

namespace {

constexpr const char* kName = "f.toml";

struct Size {
  size_t lines = 1;
  size_t columns = 0;  // of the longest line
};

Size size_of(std::string_view text) {
  Size size;
  size_t column = 0;
  for (const char c : text) {
    column = c == '\n' ? 0 : column + 1;
    size.lines += c == '\n' ? 1 : 0;
    size.columns = std::max(size.columns, column);
  }
  return size;
}

void check_place(const Size& size, uint32_t line, uint32_t column) {
  base::check(line >= 1 && line <= size.lines && column >= 1 && column <= size.columns + 1,
              "a place in the text");
}

void check_error(const base::Error& error) {
  base::check(error.text.find(kName) != std::string::npos, "an error that names the file");
}

void check_keys(const Size& size, const tools::TomlTable& table) {
  for (const auto& [key, value] : table) {
    base::check(!key.empty(), "a name");
    check_place(size, value.line, value.column);
    check_place(size, value.place.line, value.place.column);
    for (const tools::TomlPlace& place : value.places) check_place(size, place.line, place.column);
    const auto* const texts = std::get_if<std::vector<std::string>>(&value.data);
    base::check(texts == nullptr || texts->size() == value.places.size(), "a place for each text");
  }
}

// Settings that have a meaning wherever they are: those of warnings, layout, changes, safe outputs.
void read_settings(const tools::ProjectFile& file) {
  base::WarningPolicy policy;
  stc::apply_warning_table(file, policy);
  (void)stc::format_options(file);
  tools::ChangeSettings change;
  tools::take_change_settings(file, change);
  base::check(
      change.strategy.empty() || change.strategy == "in-place" || change.strategy == "standby",
      "a strategy");
  if (const tools::TomlValue* const defines = file.find("defines")) {
    const auto& texts = std::get<std::vector<std::string>>(defines->data);
    if (const auto mistake = stc::mistake_in(texts)) {
      base::check(mistake->number < texts.size() && !mistake->what.empty(), "a define");
    }
  }
  const tools::TomlValue* const safe = file.find("outputs.safe");
  if (safe == nullptr) return;
  const auto settings = stc::parse_safe_settings(kName, *safe);
  if (!settings.ok()) return check_error(settings.error());
  for (const uint32_t bytes : {0u, 4u, 1u << 20}) {
    const auto inside = stc::safe_rows_inside(*settings, bytes);
    const bool all = stc::check_safe_settings(*settings, bytes).ok();
    base::check(all == (inside.size() == settings->rows.size()), "rows inside of the outputs");
  }
}

void read_project(std::string_view text, const tools::TomlTable& table) {
  const tools::ProjectFile as_it_is{kName, std::string(text), table};
  if (const auto devices = stc::read_devices(as_it_is); !devices.ok()) {
    check_error(devices.error());
  }
  const auto units = stc::parse_unit_settings(as_it_is);
  if (!units.ok()) check_error(units.error());
  const auto file = tools::parse_project_file(kName, std::string(text));
  if (!file.ok()) return check_error(file.error());
  if (const base::Status keys = tools::check_project_keys(*file); !keys.ok()) {
    return check_error(keys.error());
  }
  read_settings(*file);
}

void read_fleet(const std::string& text, const tools::TomlTable& table) {
  const auto members = stvm::parse_fleet_list(kName, text);
  if (!members.ok()) return check_error(members.error());
  if (const auto all = stvm::roll_settings(kName, table, *members); all.ok()) {
    for (const stvm::Wave& wave : all->waves) {
      for (const size_t member : wave.members) {
        base::check(member < members->size(), "a wave of the list's members");
      }
    }
  } else {
    check_error(all.error());
  }
}

void read_broker(const std::string& text) {
  const auto broker = stvm::parse_broker(kName, text);
  if (!broker.ok()) return check_error(broker.error());
  const std::string once = stvm::broker_text(*broker);
  const auto again = stvm::parse_broker(kName, once);
  base::check(again.ok() && stvm::broker_text(*again) == once, "the same table comes back");
}

void read_trust(std::string_view text) {
  const auto trust = tools::parse_trust_file(kName, text);
  if (!trust.ok()) return check_error(trust.error());
  base::check(trust->keys.size() <= tools::kMostTrustedKeys, "no more keys than may be");
  for (const tools::TrustedKey& key : trust->keys) {
    base::check(trust->find(key.id) != nullptr, "a key is found by its hash");
  }
}

void read_stored_plan(const std::string& text) {
  const auto plan = stvm::parse_plan(kName, text);
  if (!plan.ok()) return check_error(plan.error());
  const std::string once = stvm::plan_text(*plan);
  const auto again = stvm::parse_plan(kName, once);
  base::check(again.ok() && stvm::plan_text(*again) == once, "the same plan comes back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto table = tools::parse_toml(kName, text);
  if (!table.ok()) {
    check_error(table.error());
    return 0;
  }
  check_keys(size_of(text), *table);
  read_project(text, *table);
  read_fleet(text, *table);
  read_broker(text);
  read_trust(text);
  read_stored_plan(text);
  return 0;
}
