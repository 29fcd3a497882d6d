#include "tools/common/change_settings.h"

#include <filesystem>

#include "tools/common/files.h"

namespace tools {
namespace {

namespace fs = std::filesystem;

base::Error wrong(const std::string& file, const std::string& key, const TomlValue& value,
                  const char* what) {
  return toml_error(file, value.line, value.column, "`" + key + "` must be " + what);
}

base::Status apply_file(const std::string& file, ChangeSettings& settings) {
  base::Result<std::string> text = read_text(file);
  if (!text.ok()) return text.error();
  base::Result<TomlTable> table = parse_toml(file, *text);
  if (!table.ok()) return table.error();
  for (const auto& [key, value] : *table) {
    if (!key.starts_with(kChangeTable)) continue;
    base::Status status = apply_change_key(file, key, value, settings);
    if (!status.ok()) return status;
  }
  return base::Ok{};
}

}  // namespace

base::Status apply_change_key(const std::string& file, const std::string& key,
                              const TomlValue& value, ChangeSettings& settings) {
  if (key == "change.strategy") {
    const std::string* name = std::get_if<std::string>(&value.data);
    if (name == nullptr || (*name != "in-place" && *name != "standby")) {
      return wrong(file, key, value, "\"in-place\" or \"standby\"");
    }
    settings.strategy = *name;
  } else if (key == "change.restricted") {
    const bool* on = std::get_if<bool>(&value.data);
    if (on == nullptr) return wrong(file, key, value, "true or false");
    settings.restricted = *on;
  } else if (key == "change.health" || key == "change.unless") {
    const std::string* name = std::get_if<std::string>(&value.data);
    if (name == nullptr || name->empty()) {
      return wrong(file, key, value, "the name of a BOOL, as in \"Main.healthy\"");
    }
    (key == "change.health" ? settings.health : settings.unless) = *name;
  } else if (key == "change.data_limit") {
    const int64_t* bytes = std::get_if<int64_t>(&value.data);
    if (bytes == nullptr || *bytes < 0) {
      return wrong(file, key, value, "a whole number of bytes, 0 for no limit");
    }
    settings.data_limit = static_cast<uint64_t>(*bytes);
  } else {
    return toml_error(
        file, value.line, value.column,
        "unknown key `" + key +
            "`; known in [change] are strategy, restricted, health, unless, data_limit");
  }
  return base::Ok{};
}

base::Result<ChangeSettings> change_settings(const std::vector<std::string>& paths) {
  ChangeSettings settings;
  for (const std::string& path : paths) {
    std::error_code error;
    const fs::path file = fs::path(path) / "stc.toml";
    if (!fs::is_directory(path, error) || !fs::exists(file, error)) continue;
    base::Status applied = apply_file(file.string(), settings);
    if (!applied.ok()) return applied.error();
  }
  return settings;
}

}  // namespace tools
