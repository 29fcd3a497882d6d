#include "tools/stc/format_settings.h"

#include <filesystem>

#include "tools/common/files.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

struct NumberKey {
  const char* name;
  uint32_t frontend::FormatOptions::*member;
  uint32_t least;
  uint32_t most;
};
constexpr NumberKey kNumbers[] = {
    {"format.indent", &frontend::FormatOptions::indent, 1, 16},
    {"format.width", &frontend::FormatOptions::width, 40, 1000},
};

struct SwitchKey {
  const char* name;
  bool frontend::FormatOptions::*member;
};
constexpr SwitchKey kSwitches[] = {
    {"format.tabs", &frontend::FormatOptions::tabs},
    {"format.align_declarations", &frontend::FormatOptions::align_declarations},
    {"format.align_arguments", &frontend::FormatOptions::align_arguments},
    {"format.align_assignments", &frontend::FormatOptions::align_assignments},
    {"format.align_comments", &frontend::FormatOptions::align_comments},
};

base::Status apply_keyword_case(const std::string& file, const tools::TomlValue& value,
                                frontend::FormatOptions& options) {
  const std::string* word = std::get_if<std::string>(&value.data);
  if (word == nullptr || (*word != "upper" && *word != "keep")) {
    return tools::toml_error(file, value.line, value.column,
                             "`format.keyword_case` must be \"upper\" or \"keep\"");
  }
  options.upper_keywords = *word == "upper";
  return base::Ok{};
}

base::Status apply_number(const std::string& file, const tools::TomlValue& value,
                          const NumberKey& key, frontend::FormatOptions& options) {
  const int64_t* number = std::get_if<int64_t>(&value.data);
  if (number == nullptr || *number < key.least || *number > key.most) {
    return tools::toml_error(file, value.line, value.column,
                             std::string("`") + key.name + "` must be a whole number between " +
                                 std::to_string(key.least) + " and " + std::to_string(key.most));
  }
  options.*key.member = static_cast<uint32_t>(*number);
  return base::Ok{};
}

std::string nearest_project_file(const std::string& path) {
  std::error_code error;
  fs::path folder = fs::absolute(path, error).lexically_normal();
  if (!fs::is_directory(folder, error)) folder = folder.parent_path();
  for (;;) {
    fs::path file = folder / "stc.toml";
    if (fs::is_regular_file(file, error)) return file.string();
    if (folder == folder.parent_path()) return {};
    folder = folder.parent_path();
  }
}

}  // namespace

base::Status apply_format_key(const std::string& file, const std::string& key,
                              const tools::TomlValue& value, frontend::FormatOptions& options) {
  if (key == "format.keyword_case") return apply_keyword_case(file, value, options);
  for (const NumberKey& known : kNumbers) {
    if (key == known.name) return apply_number(file, value, known, options);
  }
  for (const SwitchKey& known : kSwitches) {
    if (key != known.name) continue;
    const bool* on = std::get_if<bool>(&value.data);
    if (on == nullptr) {
      return tools::toml_error(file, value.line, value.column,
                               "`" + key + "` must be true or false");
    }
    options.*known.member = *on;
    return base::Ok{};
  }
  return tools::toml_error(
      file, value.line, value.column,
      "unknown key `" + key +
          "`; known in [format] are indent, tabs, width, keyword_case, "
          "align_declarations, align_arguments, align_assignments, align_comments");
}

base::Result<frontend::FormatOptions> format_settings(const std::string& path) {
  frontend::FormatOptions options;
  std::string file = nearest_project_file(path);
  if (file.empty()) return options;
  base::Result<std::string> text = tools::read_text(file);
  if (!text.ok()) return text.error();
  base::Result<tools::TomlTable> table = tools::parse_toml(file, *text);
  if (!table.ok()) return table.error();
  for (const auto& [key, value] : *table) {
    if (!key.starts_with(kFormatTable)) continue;
    base::Status status = apply_format_key(file, key, value, options);
    if (!status.ok()) return status.error();
  }
  return options;
}

}  // namespace stc
