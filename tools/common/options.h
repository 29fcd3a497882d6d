// Command lines: a command declares its options in a table, and gets values or
// one clear line (kUsage). `--name value` and `--name=value` are the same; `--`
// ends the options; the help text comes from the same table.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace tools {

struct OptionRow {
  const char* name;   // "--scans"; a one-letter form may follow: "--output|-o"
  const char* value;  // name of its value in the help, nullptr for a flag
  const char* help;
};

struct Command {
  const char* name;       // "run"
  const char* arguments;  // "IMAGE|SOURCES..."
  const char* summary;
  std::span<const OptionRow> options;
  uint32_t min_arguments = 0;
  uint32_t max_arguments = 0xffffffffu;
};

class Options {
 public:
  static base::Result<Options> parse(const Command& command, std::span<char* const> args);

  bool has(std::string_view name) const { return values_.count(std::string(name)) != 0; }
  // The last value given, or `otherwise`.
  std::string text(std::string_view name, std::string_view otherwise = {}) const;
  // Every value given, in order.
  std::vector<std::string> all(std::string_view name) const;
  base::Result<uint64_t> number(std::string_view name, uint64_t otherwise) const;
  const std::vector<std::string>& arguments() const { return arguments_; }

 private:
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> arguments_;
};

// Text of `TOOL COMMAND --help`.
std::string help_text(std::string_view tool, const Command& command);
// Text of `TOOL --help`.
std::string overview(std::string_view tool, std::string_view purpose,
                     std::span<const Command* const> commands);
// Among `args`, is there a --help?
bool wants_help(std::span<char* const> args);

}  // namespace tools
