// Command lines: a command declares its options in a table, and gets values or
// one clear line (kUsage). `--name value` and `--name=value` are the same, and so are `-j 2` and
// `-j2`; `--` ends the options; help, completion and manual pages come from the same table.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace tools {

// How often an option with a value may be given. One that takes one value is refused with two: the
// one that is not used would be lost without a word.
enum class Times : uint8_t { kOnce, kMany };

struct OptionRow {
  const char* name;   // "--scans"; a one-letter form may follow: "--output|-o"
  const char* value;  // name of its value in the help, nullptr for a flag
  const char* help;
  const char* choices = "";   // "text|json": the only values that it takes; "": any
  const char* excludes = "";  // "--cold|--hot": options that contradict it
  Times times = Times::kOnce;
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
  // By the long names of the options.
  const std::map<std::string, std::vector<std::string>>& values() const { return values_; }

 private:
  friend class OptionParser;
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> arguments_;
};

// "--output" and "-o" of "--output|-o"; "" when there is no short form.
std::string_view long_name(const OptionRow& row);
std::string_view short_name(const OptionRow& row);
// The words of "text|json".
std::vector<std::string_view> words_of(std::string_view list);

}  // namespace tools
