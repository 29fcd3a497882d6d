// The subset of TOML that stc.toml uses: comments, [tables] and [tables.of.tables], [[tables]] of
// which there are several (the keys of the first are those of [tables.1]), `key = value`
// with strings ("..." with \" \\ \n \t and no other control characters), decimal integers with
// `_`, true/false, and arrays of strings. Anything else is an error with line and column
// (kBadProject).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"

namespace tools {

struct TomlPlace {
  uint32_t line = 0;
  uint32_t column = 0;
};

struct TomlValue {
  std::variant<std::string, int64_t, bool, std::vector<std::string>> data;
  uint32_t line = 0;  // of the key
  uint32_t column = 0;
  TomlPlace place{};                // of the value
  std::vector<TomlPlace> places{};  // of an array's elements
};

// By full key: "name", "slack.globals_percent", "devices.press.driver". A key given twice is an
// error.
using TomlTable = std::map<std::string, TomlValue>;

// `file` is named in errors: "stc.toml:3:7: ...".
base::Result<TomlTable> parse_toml(std::string_view file, std::string_view text);
// A text in quotes, for the other direction. Blanks take the place of what cannot stand there.
std::string toml_quoted(std::string_view text);
base::Error toml_error(std::string_view file, uint32_t line, uint32_t column, std::string what);

}  // namespace tools
