// stc diff: the fate report between two versions, without a controller (X1).
#include <cstdio>

#include "tools/common/all_system_edits.h"
#include "tools/common/fate_report.h"
#include "tools/common/source_edits.h"
#include "tools/stc/commands.h"
#include "tools/stc/original.h"
#include "tools/stc/session.h"
#include "tools/stc/source_units.h"
#include "tools/stc/unit_report.h"

namespace stc {
namespace {

constexpr tools::OptionRow kDiffOptions[] = {
    STC_SOURCE_OPTIONS,
    tools::kRestrictedOption,
    {"--all", nullptr, "show the fate of each variable too, with its addresses"},
    {"--against", "HOST|DIR", "OLD is what runs there: a state directory, or a host to ssh to"},
    {"--text", nullptr,
     "say in words what differs in the sources; images need theirs (`embed_sources`)"},
};
constexpr tools::Command kDiffCommand{
    "diff", "[OLD] NEW", "Shows the fate of every variable when OLD is changed to NEW.",
    kDiffOptions, 1};

struct Difference {
  online_change::Plan plan;
  tools::PouEdits edits;
  tools::SystemEdits system;
  std::vector<tools::FateLine> every;  // by --all
  std::vector<UnitDifference> words;   // by --text
};

base::Result<Difference> compare_projects(const tools::Options& options) {
  std::vector<std::string> next = options.arguments();
  const bool running = options.has("--against");
  if (!running && next.size() != 2) {
    return base::Error{base::Refusal::kUsage,
                       "diff: OLD and NEW, or --against HOST|DIR and NEW..."};
  }
  std::vector<std::string> old(next.begin(), next.begin() + (running ? 0 : 1));
  base::Result<Version> before =
      running ? running_version(options.text("--against")) : open_version(options, old, {});
  if (!before.ok()) return before.error();
  if (!running) next.erase(next.begin());
  base::Result<Version> after = open_version(options, next, {&before->image, false});
  if (!after.ok()) return after.error();
  Difference out;
  if (options.has("--text")) {
    auto was = running ? source_units(*before) : source_units(options, old, *before);
    if (!was.ok()) return was.error();
    auto is = source_units(options, next, *after);
    if (!is.ok()) return is.error();
    out.words = differences(*was, *is);
  }
  out.edits = online_change::pou_edits(before->image, after->image);
  const auto was = ir::verify(before->bytes);
  if (!was.ok()) return was.error();
  const auto is = ir::verify(after->bytes);
  if (!is.ok()) return is.error();
  out.system = tools::all_system_edits(*was, *is);
  for (auto& edit : tools::source_edits(before->bytes, after->bytes)) {
    out.system.push_back(std::move(edit));
  }
  if (options.has("--restricted")) {
    base::Status kept = online_change::check_restricted(out.edits);
    if (!kept.ok()) return kept.error();
  }
  base::Result<online_change::Plan> plan = online_change::plan(before->image, after->image);
  if (!plan.ok()) return plan.error();
  out.plan = std::move(*plan);
  if (options.has("--all")) {
    out.every = tools::every_line(out.plan, before->image, after->image);
  }
  return out;
}

int run_diff(const tools::Options& options) {
  base::Result<Difference> found = compare_projects(options);
  if (!found.ok()) return tools::refuse("stc", found.error());
  if (options.text("--format") == "json") {
    tools::JsonWriter json;
    json.begin_object();
    tools::fate_report(found->plan, {}, found->edits, found->system, json);
    if (options.has("--all")) tools::every_fate(found->every, json);
    if (options.has("--text")) difference_json(found->words, json);
    json.end_object();
    std::fputs(json.finish().c_str(), stdout);
  } else {
    if (options.has("--text")) std::printf("%s\n", difference_text(found->words).c_str());
    if (options.has("--all")) std::printf("%s\n", tools::every_fate_text(found->every).c_str());
    std::fputs(tools::fate_report(found->plan, {}, found->edits, found->system).c_str(), stdout);
  }
  return tools::kOk;
}

}  // namespace

const Entry kDiff{&kDiffCommand, run_diff};

}  // namespace stc
