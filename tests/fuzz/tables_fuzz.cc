// Texts in the subset of TOML: stc.toml with its devices and units, trust files, lists of fleets
// with waves and broker, and the stored plan of a roll-out. Read, or refused with a place in the
// text; what is written again is read as it was.
#include <algorithm>

#include "base/check.h"
#include "tools/common/trust_file.h"
#include "tools/stc/device_tables.h"
#include "tools/stc/unit_settings.h"
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

void read_project(std::string_view text, const tools::TomlTable& table) {
  if (const auto devices = stc::read_devices(kName, table); !devices.ok()) {
    check_error(devices.error());
  }
  const auto units = stc::parse_unit_settings({kName, std::string(text), table});
  if (!units.ok()) check_error(units.error());
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
