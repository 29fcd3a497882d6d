// stc diff: the fate report between two versions, without a controller (X1).
#include <cstdio>

#include "tools/common/fate_report.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kOptions[] = {STC_SOURCE_OPTIONS};
constexpr tools::Command kCommand{
    "diff",   "OLD NEW", "Shows the fate of every variable when OLD is changed to NEW.",
    kOptions, 2,         2};

base::Result<online_change::Plan> plan_between(const tools::Options& options) {
  base::Result<Version> before = open_version(options, {options.arguments()[0]}, {});
  if (!before.ok()) return before.error();
  base::Result<Version> after =
      open_version(options, {options.arguments()[1]}, {&before->image, false});
  if (!after.ok()) return after.error();
  return online_change::plan(before->image, after->image);
}

int run(const tools::Options& options) {
  base::Result<online_change::Plan> plan = plan_between(options);
  if (!plan.ok()) return tools::refuse("stc", plan.error());
  if (options.text("--format") == "json") {
    tools::JsonWriter json;
    json.begin_object();
    tools::fate_report(*plan, {}, json);
    json.end_object();
    std::fputs(json.finish().c_str(), stdout);
  } else {
    std::fputs(tools::fate_report(*plan, {}).c_str(), stdout);
  }
  return tools::kOk;
}

}  // namespace

const Entry kDiff{&kCommand, run};

}  // namespace stc
