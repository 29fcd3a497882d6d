// Apart from reading the file: stvm takes what it knows of it, and leaves it to stc to check the
// rest.
#include <algorithm>

#include "base/joined.h"
#include "base/limits.h"
#include "base/nearest_name.h"
#include "base/warning_policy.h"
#include "tools/common/options.h"
#include "tools/common/project_file.h"

namespace tools {
namespace {

#define DIALECT(id, name, what) name "|"
constexpr char kDialects[] =
#include "frontend/dialects.def"
    ;
#define STC_DIALECTS kDialects
constexpr ProjectKey kKeys[] = {
#define PROJECT_KEY(name, kind, low, high, choices, fallback, help) \
  {name, KeyKind::kind, low, high, choices, fallback, help},
#include "tools/common/project_keys.def"
};

// "slack." of "slack.free_bytes"; "" of a key outside of tables.
std::string_view table_of(std::string_view key) { return key.substr(0, key.find('.') + 1); }

constexpr std::string_view kKnownTables =
    "[slack], [change], [warnings], [outputs], [format], [units] and [devices.NAME]";

bool is_table(std::string_view prefix) {
  return std::any_of(std::begin(kKeys), std::end(kKeys),
                     [&](const ProjectKey& row) { return table_of(row.name) == prefix; });
}

// What belongs into the same table, or at the top the tables, too.
std::string known_keys(std::string_view table) {
  std::string known;
  for (const ProjectKey& row : kKeys) {
    if (table_of(row.name) != table) continue;
    if (!known.empty()) known += ", ";
    known += row.name.substr(table.size());
  }
  if (!table.empty()) {
    const bool codes = table == kWarningTable;
    return base::joined({"known in [", table.substr(0, table.size() - 1), "] are ", known,
                         codes ? " and the codes of warnings" : ""});
  }
  return base::joined({"known are ", known, " and the tables ", kKnownTables});
}

// Of a table without keys: these are refused one by one.
std::string unknown_table(std::string_view name) {
  base::NearestName nearest(name);
  for (const ProjectKey& row : kKeys) {
    const std::string_view table = table_of(row.name);
    if (!table.empty()) nearest.offer(table.substr(0, table.size() - 1));
  }
  nearest.offer("units");
  if (!nearest.best().empty()) {
    return base::joined({"unknown table `", name, "`", nearest.question()});
  }
  return base::joined({"unknown table `", name, "`; known are ", kKnownTables});
}

base::Status check_header(const std::string& file, std::string_view prefix, TomlPlace place) {
  const bool known = prefix.starts_with(kDeviceTables) || prefix == kUnitTable || is_table(prefix);
  if (known) return base::Ok{};
  return toml_error(file, place.line, place.column,
                    unknown_table(prefix.substr(0, prefix.size() - 1)));
}

std::string unknown_key(std::string_view key) {
  base::NearestName nearest(key);
  for (const ProjectKey& row : kKeys) nearest.offer(row.name);
  if (key.starts_with(kWarningTable)) {
    const std::string code = base::nearest_warning(key.substr(kWarningTable.size()));
    if (!code.empty()) nearest.offer(base::joined({kWarningTable, code}));
  }
  const std::string_view table = is_table(table_of(key)) ? table_of(key) : std::string_view();
  if (!nearest.best().empty()) return base::joined({"unknown key `", key, "`", nearest.question()});
  return base::joined({"unknown key `", key, "`; ", known_keys(table)});
}

std::string list_of(const std::vector<std::string_view>& words) {
  std::string out;
  for (size_t i = 0; i < words.size(); ++i) {
    const bool last = i + 1 == words.size();
    out += base::joined({i == 0 ? "\"" : last ? " or \"" : ", \"", words[i], "\""});
  }
  return out;
}

// What the value of a key must be, when it is not; "": it is.
std::string fault(const ProjectKey& key, const TomlValue& value) {
  switch (key.kind) {
    case KeyKind::kText: {
      const std::string* text = std::get_if<std::string>(&value.data);
      if (key.choices.empty()) return text != nullptr && !text->empty() ? "" : "a text";
      const std::vector<std::string_view> words = words_of(key.choices);
      if (text == nullptr) return list_of(words);
      if (std::find(words.begin(), words.end(), *text) != words.end()) return "";
      base::NearestName nearest(*text);
      for (std::string_view word : words) nearest.offer(word);
      return base::joined({list_of(words), ", not \"", *text, "\"", nearest.question()});
    }
    case KeyKind::kNumber: {
      const int64_t* number = std::get_if<int64_t>(&value.data);
      if (number != nullptr && *number >= key.low && *number <= key.high) return "";
      return base::joined(
          {"a whole number between ", std::to_string(key.low), " and ", std::to_string(key.high)});
    }
    case KeyKind::kFlag:
      return std::holds_alternative<bool>(value.data) ? "" : "true or false";
    case KeyKind::kTexts:
      return std::holds_alternative<std::vector<std::string>>(value.data) ? "" : "a list of texts";
  }
  return {};
}

// [warnings] has the codes of warnings for keys, beside those of the table.
base::Status check_warning(const std::string& file, std::string_view code, const TomlValue& value) {
  const std::string wrong = warning_code_fault(code);
  if (!wrong.empty()) return toml_error(file, value.line, value.column, wrong);
  const ProjectKey row{code, KeyKind::kText, 0, 0, base::kWarningLevels, "", ""};
  const std::string must_be = fault(row, value);
  if (must_be.empty()) return base::Ok{};
  return toml_error(file, value.place.line, value.place.column,
                    base::joined({"`", code, "` must be ", must_be}));
}

base::Status check_key(const std::string& file, const std::string& name, const TomlValue& value) {
  const auto key = std::find_if(std::begin(kKeys), std::end(kKeys),
                                [&](const ProjectKey& row) { return row.name == name; });
  const std::string_view in_table = name.starts_with(kWarningTable)
                                        ? std::string_view(name).substr(kWarningTable.size())
                                        : std::string_view();
  if (key == std::end(kKeys) && base::diagnostic_code(in_table)) {
    return check_warning(file, in_table, value);
  }
  if (key == std::end(kKeys)) return toml_error(file, value.line, value.column, unknown_key(name));
  const std::string must_be = fault(*key, value);
  if (must_be.empty()) return base::Ok{};
  return toml_error(file, value.place.line, value.place.column,
                    base::joined({"`", name, "` must be ", must_be}));
}

}  // namespace

std::span<const ProjectKey> project_keys() { return kKeys; }

std::string warning_code_fault(std::string_view code) {
  const auto known = base::diagnostic_code(code);
  if (!known) {
    const std::string nearest = base::nearest_warning(code);
    return base::joined({"`", code, "` is no code of a warning",
                         nearest.empty() ? "" : "; did you mean `", nearest,
                         nearest.empty() ? "" : "`?"});
  }
  if (base::diagnostic_row(*known).severity != base::Severity::kError) return {};
  return base::joined({"`", code, "` is an error; only warnings and notes have a level"});
}

// The file is TOML: nothing else of it begins a line with a bracket.
std::vector<std::pair<std::string, TomlPlace>> project_tables(const ProjectFile& file) {
  std::vector<std::pair<std::string, TomlPlace>> tables;
  const std::string& text = file.text;
  uint32_t line = 1;
  const size_t mark = text.starts_with("\xef\xbb\xbf") ? 3 : 0;  // as in parse_toml()
  for (size_t begin = mark; begin < text.size(); ++line) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const size_t bracket = text.find_first_not_of(" \t", begin);
    if (bracket < end && text[bracket] == '[') {
      const size_t name = text.find_first_not_of('[', bracket);
      const size_t size = text.find(']', name) - name;
      const auto column = static_cast<uint32_t>(name - begin) + 1;
      tables.emplace_back(text.substr(name, size) + ".", TomlPlace{line, column});
    }
    begin = end + 1;
  }
  return tables;
}

base::Status check_project_keys(const ProjectFile& file) {
  for (const auto& [name, value] : file.table) {
    if (name.starts_with(kDeviceTables) || name.starts_with(kUnitTable)) continue;
    if (base::Status known = check_key(file.path, name, value); !known.ok()) return known;
  }
  for (const auto& [prefix, place] : project_tables(file)) {
    if (base::Status known = check_header(file.path, prefix, place); !known.ok()) return known;
  }
  return base::Ok{};
}

base::Result<ProjectFile> read_checked_project_file(const std::string& path) {
  base::Result<ProjectFile> file = read_project_file(path);
  if (!file.ok()) return file;
  if (base::Status known = check_project_keys(*file); !known.ok()) return known.error();
  return file;
}

}  // namespace tools
