// stc fleet: two versions of a program -> the one file that takes what differs to many controllers.
#include <cstdio>
#include <iterator>

#include "tools/common/files.h"
#include "tools/common/fleet_parts.h"
#include "tools/stc/commands.h"
#include "tools/stc/declared_places.h"
#include "tools/stc/online_base.h"
#include "tools/stc/original.h"
#include "tools/stc/session.h"
#include "tools/stc/start_steps.h"

namespace stc {
namespace {

constexpr tools::OptionRow kFleetOptions[] = {
    TOOLS_COMPILE_OPTIONS,
    tools::kFormatOption,
    STC_CODE_OPTIONS,
    {"--output|-o", "FILE", "the file to write (required)"},
    {"--author", "NAME", "who made the edit"},
    {"--text", "TEXT", "what the edit is for"},
    kTableOption,
    {"--start", "S",
     "together (default), each: one unit after the other, auto: each where all have "
     "no room",
     "together|each|auto"},
    {"--order", "O",
     "of --start each: table-first (default), table-last, callees-first, "
     "callers-first, auto, or list",
     "table-first|table-last|callees-first|callers-first|auto|list"},
    {"--list", "A,B,C", "the order for --order list; each edited unit once"},
    {"--allow-mixture", nullptr, "a unit may run with the old version of one that it calls"},
    {"--show-order", nullptr, "print the order"},
};
constexpr tools::Command kFleetCommand{
    "fleet",
    "ORIGINAL NEW",
    "Makes one file of what differs between two versions, for `stvm change` and `stvm fleet`.",
    kFleetOptions,
    2,
    2};

struct Made {
  base::Bytes bytes;
  std::vector<ir::PartEdit> edits;
  std::vector<std::string> steps;
};

// E-16: additions only. With the places in the sources, where NEW has some.
base::Status check_restricted_table(const tools::Options& options, const Version& original,
                                    const Version& edited) {
  const std::vector<online_change::TableEdit> edits =
      online_change::table_edits(original.image, edited.image, online_change::TableSide::kBefore);
  if (edits.empty()) return base::Ok{};
  const std::string& path = options.arguments()[1];
  base::Result<Project> project =
      is_image(path) ? base::Result<Project>(Project()) : open_project(options, {path});
  if (!project.ok()) return project.error();
  return base::Error{base::Refusal::kTableEdit, placed_table_edits(edits, edited.image, *project)};
}

// Both without the sources that may travel with them.
base::Result<Made> make_file(const tools::Options& options) {
  if (!options.has("--output")) {
    return base::Error{base::Refusal::kUsage, "fleet: --output is required"};
  }
  const std::vector<std::string>& paths = options.arguments();
  base::Result<Version> original = open_original(options, paths[0]);
  if (!original.ok()) return original.error();
  base::Result<Version> edited = open_version(options, {paths[1]}, {&original->image});
  if (!edited.ok()) return edited.error();
  Made made;
  const std::vector<ir::Part> before = ir::parts_of(original->image, edited->image.unit_members);
  made.edits = ir::part_edits(before, ir::parts_of(edited->image), before);
  if (made.edits.empty()) {
    return base::Error{base::Refusal::kNoChange,
                       "nothing is edited between `" + paths[0] + "` and `" + paths[1] + "`"};
  }
  const bool free_table = options.text("--table") == "free";
  if (base::Status kept = check_restricted_table(options, *original, *edited);
      !free_table && !kept.ok()) {
    return kept.error();
  }
  online_change::FleetFile file;
  file.author = options.text("--author");
  file.text = options.text("--text");
  file.free_table = free_table;
  file.steps_if_needed = options.text("--start") == "auto";
  base::Result<std::vector<std::string>> steps =
      start_steps(options, {original->image, edited->image});
  if (!steps.ok()) return steps.error();
  made.steps = file.steps = std::move(*steps);
  file.original = ir::encode(original->image);
  file.edited = ir::encode(edited->image);
  made.bytes = online_change::encode(file);
  base::Status written = tools::write_file(options.text("--output"), made.bytes);
  if (!written.ok()) return written.error();
  return made;
}

int run_fleet(const tools::Options& options) {
  base::Result<base::DiagnosticFormat> format = diagnostic_format(options);
  if (!format.ok()) return tools::refuse("stc", format.error());
  base::Result<Made> made = make_file(options);
  if (!made.ok()) return tools::refuse("stc", made.error());
  const base::Digest digest = online_change::fleet_digest(made->bytes);
  if (*format == base::DiagnosticFormat::kJson) {
    tools::JsonWriter json;
    json.begin_object().field("file", options.text("--output"));
    json.field("digest", base::to_hex(digest)).field("bytes", uint64_t{made->bytes.size()});
    json.key("parts");
    tools::part_edits_json(made->edits, false, json);
    json.key("steps").begin_array();
    for (const std::string& step : made->steps) json.value(ir::step_text(step));
    json.end_array().end_object();
    std::fputs(json.finish().c_str(), stdout);
    return tools::kOk;
  }
  std::fputs(tools::part_edits_text(made->edits, false).c_str(), stdout);
  if (options.has("--show-order")) std::fputs(order_text(made->steps).c_str(), stdout);
  std::printf("%s: %zu part(s), %zu bytes, %s\n", options.text("--output").c_str(),
              made->edits.size(), made->bytes.size(), base::short_hex(digest).c_str());
  return tools::kOk;
}

}  // namespace

const Entry kFleet{&kFleetCommand, run_fleet};

}  // namespace stc
