// stc.toml: where it is found, and what may stand in it (project_keys.def).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/result.h"
#include "tools/common/toml.h"

namespace tools {

enum class KeyKind : uint8_t { kText, kNumber, kFlag, kTexts };

struct ProjectKey {
  std::string_view name;  // "slack.free_bytes"
  KeyKind kind;
  int64_t low;
  int64_t high;
  std::string_view choices;  // "in-place|standby"; "": any
  std::string_view fallback;
  std::string_view help;
};
std::span<const ProjectKey> project_keys();

inline constexpr std::string_view kProjectFile = "stc.toml";
inline constexpr std::string_view kDeviceTables = "devices.";
inline constexpr std::string_view kUnitTable = "units.";
inline constexpr std::string_view kWarningTable = "warnings.";

struct ProjectFile {
  std::string path;
  std::string text;
  TomlTable table;

  const TomlValue* find(std::string_view key) const;
  // Takes the value of `key` over into `out`, when there is one of the kind T.
  template <class T, class Out>
  bool take(std::string_view key, Out& out) const {
    const TomlValue* const value = find(key);
    const T* const data = value == nullptr ? nullptr : std::get_if<T>(&value->data);
    if (data != nullptr) out = static_cast<Out>(*data);
    return data != nullptr;
  }
};

// kBadProject with line and column for what is no TOML; errors of read_text(), too.
base::Result<ProjectFile> read_project_file(const std::string& path);
// The same of a file that was read already.
base::Result<ProjectFile> parse_project_file(const std::string& path, std::string text);
// Its tables, also those without keys: "slack.", "devices.press.".
std::vector<std::pair<std::string, TomlPlace>> project_tables(const ProjectFile& file);
// Refuses unknown keys and wrong values; tables [devices.NAME] and [units] are not looked into.
base::Status check_project_keys(const ProjectFile& file);
// Reads the file and checks its keys.
base::Result<ProjectFile> read_checked_project_file(const std::string& path);

// Why `code` cannot have a level in [warnings] or after --warn; "": it can.
std::string warning_code_fault(std::string_view code);

// The stc.toml that is nearest to `path`: in that folder, or that of the file, or above it; or "".
// It may be a folder or a link that leads nowhere, which cannot be read then.
std::string nearest_project_file(const std::string& path);

}  // namespace tools
