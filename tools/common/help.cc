#include "tools/common/help.h"

#include <algorithm>
#include <cstring>

#include "base/wrapped.h"
#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/common/option_rows.h"

namespace tools {
namespace {

constexpr size_t kColumns = 80;

// `head` in front, and `text` from `column` on, in as many lines as it needs.
std::string row_text(std::string head, size_t column, std::string_view text) {
  const std::vector<std::string> lines = base::wrapped(text, kColumns - column);
  if (column != 0 && head.size() + 2 > column) {
    head += "\n" + std::string(column, ' ');
  } else {
    head.append(column - head.size(), ' ');
  }
  for (size_t i = 0; i < lines.size(); ++i) {
    if (i != 0) head += std::string(column, ' ');
    head += lines[i] + "\n";
  }
  return head;
}

std::string paragraph(std::string_view text) { return row_text("", 0, text); }

std::string option_text(const OptionRow& row) {
  std::string head = "  " + std::string(long_name(row));
  if (!short_name(row).empty()) head += ", " + std::string(short_name(row));
  if (row.value != nullptr) head += std::string(" ") + row.value;
  return row_text(std::move(head), 26, row.help);
}

bool has_option(const Command& command, std::string_view name) {
  return std::any_of(command.options.begin(), command.options.end(),
                     [&](const OptionRow& row) { return long_name(row) == name; });
}

void option_json(const OptionRow& row, const Command& command, JsonWriter& json) {
  json.begin_object().field("name", long_name(row));
  if (!short_name(row).empty()) json.field("short", short_name(row));
  if (row.value != nullptr) json.field("value", row.value);
  json.key("choices").begin_array();
  for (std::string_view word : words_of(row.choices)) json.value(word);
  json.end_array().key("excludes").begin_array();
  for (std::string_view word : words_of(row.excludes)) {
    if (has_option(command, word)) json.value(word);
  }
  json.end_array().field("repeatable", row.times == Times::kMany);
  json.field("help", row.help).end_object();
}

}  // namespace

std::string help_text(std::string_view tool, const Command& command) {
  std::string out = "usage: " + std::string(tool) + " " + command.name + " [options]";
  if (*command.arguments != '\0') out += std::string(" ") + command.arguments;
  out += "\n\n" + paragraph(command.summary);
  if (!command.options.empty()) out += "\n";
  for (const OptionRow& row : command.options) out += option_text(row);
  out += "\nof every command:\n";
  for (const OptionRow& row : kEveryCommand) out += option_text(row);
  return out;
}

std::string overview(std::string_view tool, std::string_view purpose,
                     std::span<const Command* const> commands) {
  std::string out = "usage: " + std::string(tool) + " COMMAND [options] ...\n\n";
  out += paragraph(purpose) + "\n";
  for (const Command* command : commands) {
    out += row_text("  " + std::string(command->name), 13, command->summary);
  }
  out += "\nexit codes:\n\n";
  for (const ExitRow& row : exit_rows()) {
    out += row_text("  " + std::to_string(row.code), 6, row.meaning);
  }
  const std::string name(tool);
  return out + "\n" +
         paragraph("`" + name + " help COMMAND` lists the options of a command, `" + name +
                   " --version` says what this " + name + " is.");
}

std::string help_json(std::string_view tool, std::string_view purpose,
                      std::span<const Command* const> commands) {
  JsonWriter json;
  json.begin_object().field("tool", tool).field("purpose", purpose);
  json.key("commands").begin_array();
  for (const Command* command : commands) {
    json.begin_object().field("name", command->name).field("arguments", command->arguments);
    json.field("summary", command->summary).key("options").begin_array();
    for (const OptionRow& row : command->options) option_json(row, *command, json);
    for (const OptionRow& row : kEveryCommand) option_json(row, *command, json);
    json.end_array().end_object();
  }
  json.end_array().key("exit_codes").begin_array();
  for (const ExitRow& row : exit_rows()) {
    json.begin_object().field("code", row.code).field("name", row.name);
    json.field("meaning", row.meaning).end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

bool wants_help(std::span<char* const> args) {
  for (const char* arg : args) {
    if (std::strcmp(arg, "--help") == 0 || std::strcmp(arg, "-h") == 0) return true;
    if (std::strcmp(arg, "--") == 0) return false;
  }
  return false;
}

}  // namespace tools
