// stc explain: the page of a code, or a whole table.
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <cstring>

#include "base/diagnostics.h"
#include "base/diagnostics_render.h"
#include "base/limits.h"
#include "base/nearest_name.h"
#include "base/result.h"
#include "base/warning_policy.h"
#include "frontend/dialect.h"
#include "ir/bytecode/code.h"
#include "ir/bytecode/devices.h"
#include "ir/opt/optimise.h"
#include "ir/program/ir.h"
#include "stdlib/registry.h"
#include "tools/common/project_file.h"
#include "tools/common/table.h"
#include "tools/stc/commands.h"
#include "tools/stc/online_base.h"
#include "tools/stc/online_edits.h"
#include "tools/stc/project_schema.h"
#include "tools/stc/session.h"
#include "tools/stc/test_page.h"

namespace stc {
namespace {

// Terminals get 80 columns; files (the generated reference) get every word.
uint32_t page_width() { return ::isatty(1) != 0 ? 80 : 400; }
std::string fitted(const tools::Table& table) { return table.text(page_width()); }

constexpr tools::OptionRow kExplainOptions[] = {
    kTargetOption,
    {"--format", "FORM", "of online-edits: text (default) or json", "text|json"},
};
constexpr tools::Command kExplainCommand{
    "explain",
    "[CODE|TRAP|TABLE]",
    "Explains a code such as E3001 or R0303, a trap, or prints a table.",
    kExplainOptions,
    0,
    1};

std::string limits_page() {
  tools::Table table({"> limit", "what", "name"});
#define LIMIT(id, value, what) table.row({std::to_string(static_cast<uint64_t>(value)), what, #id});
#include "base/limits.def"
#include "base/tool_limits.def"
#undef LIMIT
  return fitted(table);
}

std::string opcodes_page() {
  tools::Table table({"> n", "opcode", "meaning"});
  for (uint32_t i = 0; i < ir::kOpcodeCount; ++i) {
    const ir::OpcodeRow& row = ir::opcode_row(static_cast<ir::Opcode>(i));
    table.row({std::to_string(i), std::string(row.name), std::string(row.meaning)});
  }
  return fitted(table);
}

std::string refusals_page() {
  tools::Table table({"code", "title"});
#define REFUSAL(id, code, title, help) table.row({code, title});
#include "base/refusals.def"
#undef REFUSAL
  return fitted(table);
}

std::string traps_page() {
  tools::Table table({"trap", "title"});
#define TRAP(id, text, title, help) table.row({text, title});
#include "ir/program/traps.def"
#undef TRAP
  return fitted(table);
}

std::string diagnostics_page() {
  tools::Table table({"code", "severity", "title"});
  for (uint32_t i = 0; i < base::diagnostic_count(); ++i) {
    const auto& row = base::diagnostic_row(static_cast<base::DiagnosticCode>(i));
    table.row({std::string(row.code), std::string(base::severity_name(row.severity)),
               std::string(row.title)});
  }
  return fitted(table);
}

std::string overview_page() {
  return "stc explain CODE     E.... and W.... of the compiler, R.... of everything else\n"
         "stc explain TRAP     a run-time trap by name\n"
         "stc explain TABLE    limits, opcodes, functions, refusals, diagnostics, traps, "
         "dialects, devices,\n"
         "                     passes, exit_codes, stc.toml, stc.toml.schema\n"
         "stc explain test     how unit tests are written\n"
         "stc explain online-edits [--target HOST|VERSION]\n"
         "                     what can be edited while a program runs\n";
}

std::string devices_page() {
  std::string page;
  for (const ir::DriverRow& driver : ir::driver_rows()) {
    page += std::string(driver.name) + ": " + std::string(driver.meaning) + "\n\n";
    tools::Table table({"setting", "default", "meaning"});
    for (const ir::SettingRow& row : ir::setting_rows()) {
      if ((row.families & driver.family) == 0) continue;
      const std::string fallback = row.fallback == nullptr ? "(needed)" : row.fallback;
      table.row({std::string(row.key), fallback, std::string(row.meaning)});
    }
    for (const ir::TableRow& row : ir::table_rows()) {
      if ((row.families & driver.family) == 0) continue;
      table.row({"map: " + std::string(row.name), "", std::string(row.meaning)});
    }
    page += fitted(table) + "\n";
  }
  return page;
}

std::string functions_page() {
  std::string page;
  std::optional<tools::Table> table;
  auto flush = [&] {
    if (table) page += fitted(*table) + "\n";
  };
  for (const stdlib::PageRow& row : stdlib::page_rows()) {
    if (row.interface.empty()) {
      flush();
      page += std::string(row.name) + "\n\n";
      table.emplace(std::vector<std::string>{"name", "signature", "meaning"});
    } else {
      table->row({std::string(row.name), std::string(row.interface), std::string(row.meaning)});
    }
  }
  flush();
  return page;
}

std::string verdict(std::string_view code) { return code.empty() ? "accepted" : std::string(code); }

std::string dialects_page() {
  std::string page;
  for (const frontend::DialectRow& row : frontend::dialect_rows()) {
    std::string line(row.name);
    line.resize(10, ' ');
    page += line + std::string(row.what) + "\n";
  }
  page += "\n";
  tools::Table table({"what", "iec", "codesys, twincat", "example"});
  for (const frontend::DialectRule& rule : frontend::dialect_rules()) {
    table.row({std::string(rule.what), verdict(rule.iec), verdict(rule.others),
               std::string(rule.example)});
  }
  return page + fitted(table);
}

std::string passes_page() {
  tools::Table table({"pass", "what it does"});
  for (const ir::PassRow& row : ir::pass_rows()) {
    table.row({std::string(row.name), std::string(row.what)});
  }
  return fitted(table);
}

std::string exit_codes_page() {
  tools::Table table({"> code", "name", "meaning"});
  for (const tools::ExitRow& row : tools::exit_rows()) {
    table.row({std::to_string(row.code), row.name, row.meaning});
  }
  return fitted(table);
}

std::string project_page() {
  tools::Table table({"key", "default", "meaning"});
  for (const tools::ProjectKey& key : tools::project_keys()) {
    table.row({std::string(key.name), std::string(key.fallback), std::string(key.help)});
  }
  return fitted(table);
}

struct Page {
  const char* name;
  std::string (*text)();
};
constexpr Page kPages[] = {{"limits", limits_page},     {"functions", functions_page},
                           {"opcodes", opcodes_page},   {"refusals", refusals_page},
                           {"traps", traps_page},       {"diagnostics", diagnostics_page},
                           {"dialects", dialects_page}, {"devices", devices_page},
                           {"passes", passes_page},     {"exit_codes", exit_codes_page},
                           {"stc.toml", project_page},  {"stc.toml.schema", project_schema},
                           {"test", test_page}};

constexpr const char* kOnlineEdits = "online-edits";

// Which page was meant, perhaps: codes and traps, too.
std::string nearest_page(const std::string& what) {
  base::NearestName nearest(what);
  for (const Page& page : kPages) nearest.offer(page.name);
  nearest.offer(kOnlineEdits);
  for (uint32_t i = 0; i < ir::kTrapCount; ++i) {
    nearest.offer(ir::trap_name(static_cast<ir::TrapKind>(i)));
  }
  for (uint32_t i = 0; i < base::diagnostic_count(); ++i) {
    nearest.offer(base::diagnostic_row(static_cast<base::DiagnosticCode>(i)).code);
  }
#define REFUSAL(id, code, title, help) nearest.offer(code);
#include "base/refusals.def"
#undef REFUSAL
  return nearest.question();
}

// Codes in letters of either case.
std::string code_of(const std::string& what) {
  std::string upper = what;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const bool known = base::refusal_from_code(upper) || base::diagnostic_code(upper);
  return known ? upper : what;
}

std::optional<std::string> page_of(const std::string& given) {
  const std::string what = code_of(given);
  for (const Page& page : kPages) {
    if (what == page.name) return page.text();
  }
  if (auto refusal = base::refusal_from_code(what)) {
    return what + ": " + base::refusal_title(*refusal) + "\n\n" + base::refusal_help(*refusal) +
           "\n";
  }
  if (const auto code = base::diagnostic_code(what)) {
    const base::DiagnosticRow& row = base::diagnostic_row(*code);
    return what + ": " + std::string(row.title) + " (" +
           std::string(base::severity_name(row.severity)) + ")\n\n" +
           std::string(base::diagnostic_page(*code)) + "\n";
  }
  for (uint32_t i = 0; i < ir::kTrapCount; ++i) {
    auto kind = static_cast<ir::TrapKind>(i);
    if (what == ir::trap_name(kind)) {
      return what + ": " + ir::trap_title(kind) + "\n\n" + ir::trap_help(kind) + "\n";
    }
  }
  return std::nullopt;
}

// The page that has options.
int explain_online_edits(const tools::Options& options) {
  const std::vector<std::string> targets = target_versions(options);
  const bool json = options.text("--format") == "json";
  std::fputs((json ? online_edits_json(targets) : online_edits_page(targets, page_width())).c_str(),
             stdout);
  return tools::kOk;
}

int run_explain(const tools::Options& options) {
  if (!options.arguments().empty() && options.arguments()[0] == kOnlineEdits) {
    return explain_online_edits(options);
  }
  if (options.has("--target") || options.has("--format")) {
    return tools::refuse(
        "stc", {base::Refusal::kUsage, "explain: --target and --format are for online-edits"});
  }
  if (options.arguments().empty()) {
    std::fputs(overview_page().c_str(), stdout);
    return tools::kOk;
  }
  std::optional<std::string> page = page_of(options.arguments()[0]);
  if (!page) {
    return tools::refuse(
        "stc", {base::Refusal::kUsage, "explain: nothing is called `" + options.arguments()[0] +
                                           "`" + nearest_page(options.arguments()[0])});
  }
  std::fputs(page->c_str(), stdout);
  return tools::kOk;
}

}  // namespace

const Entry kExplain{&kExplainCommand, run_explain};

}  // namespace stc
