#include "tools/stc/device_tables.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/nearest_name.h"
#include "ir/types/address_text.h"
#include "tools/stc/map_entry.h"

namespace stc {
namespace {

base::Error at(std::string_view file, tools::TomlPlace place, const std::string& text) {
  return {base::Refusal::kBadMapping, tools::toml_error(file, place.line, place.column, text).text};
}

bool is_flag(std::string_view key) {
  const auto rows = ir::setting_rows();
  return std::any_of(rows.begin(), rows.end(), [&](const ir::SettingRow& row) {
    return row.kind == ir::SettingKind::kFlag && row.key == key;
  });
}

// HOST, HOST:PORT, [IPV6] or [IPV6]:PORT, as the drivers take it; that the host is there shows when
// the controller runs.
bool is_endpoint(std::string_view text) {
  const bool bracketed = text.starts_with('[');
  const size_t end = std::min(text.find(bracketed ? ']' : ':'), text.size());
  if (end <= (bracketed ? 1u : 0u) || (bracketed && end == text.size())) return false;
  const std::string_view rest = text.substr(bracketed ? end + 1 : end);
  if (rest.empty()) return true;
  unsigned port = 0;
  const auto [last, code] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), port);
  const bool whole = code == std::errc() && last == rest.data() + rest.size();
  return rest[0] == ':' && whole && port > 0 && port <= 65535;
}

// Where the parts of a device stand, for what is found behind them.
struct Places {
  tools::TomlPlace device;  // its driver
  std::vector<tools::TomlPlace> map;
  tools::TomlPlace quality;
  std::string resource;
};

class Reader {
 public:
  explicit Reader(const tools::ProjectFile& file) : file_(file.path), settings_file_(file) {}

  base::Result<std::vector<ProjectDevice>> run() {
    for (const auto& [key, value] : settings_file_.table) {
      if (!key.starts_with(tools::kDeviceTables)) continue;
      const std::string_view rest = std::string_view(key).substr(tools::kDeviceTables.size());
      const size_t dot = rest.find('.');
      if (dot == std::string_view::npos || rest.find('.', dot + 1) != std::string_view::npos) {
        return at(file_, {value.line, value.column},
                  "`" + key + "`: a device is a table [devices.NAME]");
      }
      if (base::Status added = add(rest.substr(0, dot), rest.substr(dot + 1), value); !added.ok()) {
        return added.error();
      }
    }
    if (base::Status tables = check_tables(); !tables.ok()) return tables.error();
    if (base::Status whole = check_whole(); !whole.ok()) return whole.error();
    std::vector<ProjectDevice> out;
    for (size_t i = 0; i < devices_.size(); ++i) {
      const tools::TomlPlace place = places_[i].device;
      out.push_back({std::move(devices_[i]), std::move(places_[i].resource),
                     std::string(file_) + ":" + std::to_string(place.line) + ":" +
                         std::to_string(place.column)});
    }
    return out;
  }

 private:
  // Those without keys, too.
  base::Status check_tables() const {
    for (const auto& [table, place] : tools::project_tables(settings_file_)) {
      const size_t begin = tools::kDeviceTables.size();
      if (!table.starts_with(tools::kDeviceTables) || table.size() == begin) continue;
      const std::string name = table.substr(begin, table.size() - begin - 1);
      const bool has_keys =
          std::any_of(devices_.begin(), devices_.end(),
                      [&](const ir::Device& device) { return device.name == name; });
      if (!has_keys) return at(file_, place, "device `" + name + "` has no `driver`");
    }
    return base::Ok{};
  }

  // Keys come sorted by device, so the last one is the one to add to.
  base::Status add(std::string_view name, std::string_view key, const tools::TomlValue& value) {
    if (devices_.empty() || devices_.back().name != name) {
      devices_.emplace_back().name = name;
      places_.emplace_back().device = {value.line, value.column};
    }
    if (key == "driver") return add_driver(value);
    if (key == "map") return add_map(value);
    if (key == "quality") return add_quality(value);
    if (key == "resource") return add_resource(value);
    return add_setting(key, value);
  }

  base::Status add_driver(const tools::TomlValue& value) {
    const auto* name = std::get_if<std::string>(&value.data);
    places_.back().device = value.place;
    if (name != nullptr && ir::find_driver(*name) != nullptr) {
      devices_.back().driver = *name;
      return base::Ok{};
    }
    std::string known;
    base::NearestName nearest(name == nullptr ? "" : *name);
    for (const ir::DriverRow& row : ir::driver_rows()) {
      nearest.offer(row.name);
      known += (known.empty() ? "\"" : ", \"") + std::string(row.name) + "\"";
    }
    return at(file_, value.place,
              (name == nullptr ? "the driver" : "unknown driver \"" + *name + "\"; it") +
                  " must be one of " + known + nearest.question());
  }

  base::Status add_map(const tools::TomlValue& value) {
    const auto* entries = std::get_if<std::vector<std::string>>(&value.data);
    if (entries == nullptr) return at(file_, value.place, "`map` must be a list of texts");
    for (size_t i = 0; i < entries->size(); ++i) {
      tools::TomlPlace place = value.places[i];
      ++place.column;  // after the quote
      ir::DeviceMapping& mapping = devices_.back().map.emplace_back();
      if (auto fault = parse_map_entry((*entries)[i], mapping)) {
        place.column += static_cast<uint32_t>(fault->at);
        return at(file_, place, "map entry \"" + (*entries)[i] + "\": " + fault->text);
      }
      places_.back().map.push_back(place);
    }
    return base::Ok{};
  }

  base::Status add_quality(const tools::TomlValue& value) {
    const auto* text = std::get_if<std::string>(&value.data);
    const auto address = text != nullptr ? ir::parse_address(*text) : std::nullopt;
    if (!address) {
      return at(file_, value.place, "`quality` must be the address of an input bit: \"%IX100.0\"");
    }
    devices_.back().quality = *address;
    places_.back().quality = value.place;
    return base::Ok{};
  }

  base::Status add_resource(const tools::TomlValue& value) {
    const auto* name = std::get_if<std::string>(&value.data);
    if (name == nullptr || name->empty()) {
      return at(file_, value.place, "`resource` must be the name of a RESOURCE");
    }
    places_.back().resource = *name;
    return base::Ok{};
  }

  base::Status add_setting(std::string_view key, const tools::TomlValue& value) {
    ir::DeviceSetting& setting = devices_.back().settings.emplace_back();
    setting.key = key;
    settings_.push_back({devices_.size() - 1, &value});
    if (const auto* text = std::get_if<std::string>(&value.data)) {
      setting.value = *text;
    } else if (const auto* number = std::get_if<int64_t>(&value.data)) {
      setting.value = std::to_string(*number);
    } else if (const auto* flag = std::get_if<bool>(&value.data); flag != nullptr && is_flag(key)) {
      setting.value = *flag ? "true" : "false";
    } else {
      return at(file_, value.place, "`" + setting.key + "` must be a text or a whole number");
    }
    return base::Ok{};
  }

  base::Status check_settings() const {
    size_t next = 0;
    for (size_t device = 0; device < devices_.size(); ++device) {
      const ir::DriverRow* driver = ir::find_driver(devices_[device].driver);
      if (driver == nullptr) {
        return at(file_, places_[device].device,
                  "device `" + devices_[device].name + "` has no `driver`");
      }
      for (const ir::DeviceSetting& setting : devices_[device].settings) {
        const tools::TomlValue& value = *settings_[next++].value;
        const ir::SettingRow* row = ir::find_setting(*driver, setting.key);
        if (row == nullptr) {
          return at(file_, {value.line, value.column}, unknown_key(*driver, setting.key));
        }
        const std::string bad = ir::bad_value(*row, setting.value);
        if (!bad.empty()) return at(file_, value.place, "`" + setting.key + "` " + bad);
        if (row->key == "address" && !is_endpoint(setting.value)) {
          return at(file_, value.place,
                    "`" + setting.value + "` is no address: 10.0.0.5:502, [fe80::1]:502");
        }
        if (row->kind == ir::SettingKind::kFlag && !devices_[device].map.empty()) {
          return at(file_, value.place,
                    "`" + setting.key + "` is for a device without `map`; in a map, `<->` says it");
        }
      }
    }
    return base::Ok{};
  }

  static std::string unknown_key(const ir::DriverRow& driver, const std::string& given) {
    base::NearestName nearest(given);
    std::string known = "driver \"" + std::string(driver.name) + "\" knows ";
    std::string_view longer;  // `period` is short for `period_ms`
    for (const char* key : {"map", "quality", "resource", "driver"}) nearest.offer(key);
    known += "map, quality, resource";
    for (const ir::SettingRow& row : ir::setting_rows()) {
      if ((row.families & driver.family) == 0) continue;
      nearest.offer(row.key);
      if (row.key.starts_with(given)) longer = row.key;
      known += ", " + std::string(row.key);
    }
    const std::string meant =
        longer.empty() ? nearest.question() : "; did you mean `" + std::string(longer) + "`?";
    return "unknown key `" + given + "`; " + known + meant;
  }

  // What only shows when all is read, in the order of the file's devices.
  base::Status check_whole() const {
    if (base::Status settings = check_settings(); !settings.ok()) return settings;
    for (size_t device = 0; device < devices_.size(); ++device) {
      if (!devices_[device].map.empty() || ir::has_default_map(devices_[device])) continue;
      return at(file_, places_[device].device,
                "device `" + devices_[device].name + "` has no `map`");
    }
    const std::optional<ir::DeviceFault> fault = ir::find_fault(devices_, nullptr);
    if (!fault) return base::Ok{};
    const Places& places = places_[fault->device];
    if (fault->entry == ir::DeviceFault::kQuality) return at(file_, places.quality, fault->text);
    const std::string name = "device `" + devices_[fault->device].name + "`: ";
    if (fault->entry == ir::DeviceFault::kDevice) {
      return at(file_, places.device, name + fault->text);
    }
    const std::string entry = ir::mapping_text(devices_[fault->device].map[fault->entry]);
    return at(file_, places.map[fault->entry], "\"" + entry + "\": " + fault->text);
  }

  struct GivenSetting {
    size_t device = 0;
    const tools::TomlValue* value = nullptr;
  };

  std::string_view file_;
  const tools::ProjectFile& settings_file_;
  std::vector<ir::Device> devices_;
  std::vector<Places> places_;  // parallel
  std::vector<GivenSetting> settings_;
};

}  // namespace

base::Result<std::vector<ProjectDevice>> read_devices(const tools::ProjectFile& file) {
  return Reader(file).run();
}

base::Result<std::vector<ir::Device>> devices_of(const std::vector<ProjectDevice>& devices,
                                                 const std::string& resource,
                                                 const std::vector<std::string>& all) {
  std::vector<ir::Device> own;
  for (const ProjectDevice& row : devices) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const std::string& name) {
      return ir::same_name(name, row.resource);
    });
    if (!all.empty() && !known) {
      return base::Error{
          base::Refusal::kBadMapping,
          row.where + ": device `" + row.device.name + "`: " +
              (row.resource.empty() ? std::string("there are several RESOURCEs")
                                    : "there is no RESOURCE `" + row.resource + "`") +
              "; say which one has it: resource = \"" + all.front() + "\""};
    }
    if (all.empty() || ir::same_name(row.resource, resource)) own.push_back(row.device);
  }
  return own;
}

}  // namespace stc
