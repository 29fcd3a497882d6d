#include "tools/common/options.h"

#include <charconv>
#include <cstring>

namespace tools {
namespace {

// The long name of a row: "--output" of "--output|-o".
std::string_view long_name(const OptionRow& row) {
  std::string_view name = row.name;
  return name.substr(0, name.find('|'));
}

const OptionRow* find_row(const Command& command, std::string_view given) {
  for (const OptionRow& row : command.options) {
    std::string_view name = row.name;
    size_t bar = name.find('|');
    if (given == name.substr(0, bar)) return &row;
    if (bar != std::string_view::npos && given == name.substr(bar + 1)) return &row;
  }
  return nullptr;
}

base::Error usage(const Command& command, std::string text) {
  return {base::Refusal::kUsage, std::string(command.name) + ": " + std::move(text)};
}

void pad_to(std::string& line, size_t column) {
  if (line.size() + 1 < column) {
    line.append(column - line.size(), ' ');
  } else {
    line += "  ";
  }
}

}  // namespace

base::Result<Options> Options::parse(const Command& command, std::span<char* const> args) {
  Options out;
  bool options_ended = false;
  for (size_t i = 0; i < args.size(); ++i) {
    std::string_view arg = args[i];
    if (options_ended || arg.size() < 2 || arg[0] != '-') {
      out.arguments_.emplace_back(arg);
      continue;
    }
    if (arg == "--") {
      options_ended = true;
      continue;
    }
    size_t equals = arg.substr(0, 2) == "--" ? arg.find('=') : std::string_view::npos;
    std::string_view given = arg.substr(0, equals);
    const OptionRow* row = find_row(command, given);
    if (row == nullptr) return usage(command, "unknown option " + std::string(given));
    std::string value;
    if (row->value == nullptr) {
      if (equals != std::string_view::npos) {
        return usage(command, std::string(given) + " takes no value");
      }
    } else if (equals != std::string_view::npos) {
      value = arg.substr(equals + 1);
    } else if (++i < args.size()) {
      value = args[i];
    } else {
      return usage(command, std::string(given) + " needs a value: " + row->value);
    }
    out.values_[std::string(long_name(*row))].push_back(std::move(value));
  }
  if (out.arguments_.size() < command.min_arguments) {
    return usage(command, std::string("needs ") + command.arguments);
  }
  if (out.arguments_.size() > command.max_arguments) {
    return usage(command, "too many arguments: " + out.arguments_[command.max_arguments]);
  }
  return out;
}

std::string Options::text(std::string_view name, std::string_view otherwise) const {
  auto found = values_.find(std::string(name));
  return found == values_.end() ? std::string(otherwise) : found->second.back();
}

std::vector<std::string> Options::all(std::string_view name) const {
  auto found = values_.find(std::string(name));
  return found == values_.end() ? std::vector<std::string>{} : found->second;
}

base::Result<uint64_t> Options::number(std::string_view name, uint64_t otherwise) const {
  auto found = values_.find(std::string(name));
  if (found == values_.end()) return otherwise;
  const std::string& text = found->second.back();
  uint64_t value = 0;
  auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) {
    return base::Error{base::Refusal::kUsage,
                       std::string(name) + " needs a whole number, not `" + text + "`"};
  }
  return value;
}

std::string help_text(std::string_view tool, const Command& command) {
  std::string out = "usage: " + std::string(tool) + " " + command.name;
  if (!command.options.empty()) out += " [options]";
  if (*command.arguments != '\0') out += std::string(" ") + command.arguments;
  out += "\n\n" + std::string(command.summary) + "\n";
  if (!command.options.empty()) out += "\n";
  for (const OptionRow& row : command.options) {
    std::string line = "  ";
    std::string_view name = row.name;
    size_t bar = name.find('|');
    line += name.substr(0, bar);
    if (bar != std::string_view::npos) line += ", " + std::string(name.substr(bar + 1));
    if (row.value != nullptr) line += std::string(" ") + row.value;
    pad_to(line, 26);
    out += line + row.help + "\n";
  }
  return out;
}

std::string overview(std::string_view tool, std::string_view purpose,
                     std::span<const Command* const> commands) {
  std::string out = "usage: " + std::string(tool) + " COMMAND [options] ...\n\n";
  out += std::string(purpose) + "\n\n";
  for (const Command* command : commands) {
    std::string line = "  " + std::string(command->name);
    pad_to(line, 13);
    out += line + command->summary + "\n";
  }
  out += "\n`" + std::string(tool) + " COMMAND --help` lists the options of a command.\n";
  return out;
}

bool wants_help(std::span<char* const> args) {
  for (const char* arg : args) {
    if (std::strcmp(arg, "--help") == 0 || std::strcmp(arg, "-h") == 0) return true;
    if (std::strcmp(arg, "--") == 0) return false;
  }
  return false;
}

}  // namespace tools
