#include "tools/stc/package_text.h"

#include "base/visible_text.h"
#include "ir/bytecode/renames.h"
#include "online_change/diff/areas.h"
#include "tools/common/fate_report.h"
#include "tools/common/table.h"

namespace stc {
namespace {

using online_change::Plan;
using online_change::StepKind;
using online_change::UpdateStep;

const char* kind_text(StepKind kind) {
  switch (kind) {
    case StepKind::kInitialise:
      return "initialise";
    case StepKind::kCopy:
      return "copy";
    case StepKind::kConvert:
      return "convert";
    case StepKind::kEnter:
      return "enter step";
    case StepKind::kMigrate:
      return "migrate";
    case StepKind::kGather:
      return "gather";
  }
  return "";
}

// What lies at the first byte: a variable, or the slot of an instance.
std::string variable_at(const online_change::Areas& areas, uint32_t at) {
  std::string path = areas.path_at(at);
  if (!path.empty()) return path;
  const std::optional<uint32_t> owner = areas.instance_at(at);
  if (!owner) return "free bytes";
  path = areas.image().instance_path(*owner);
  return (path.empty() ? "globals" : path) + " + " + std::to_string(at - areas.begin(*owner));
}

std::string types_of(const UpdateStep& step, const ir::Image& from, const ir::Image& to) {
  const auto* how = step.as<online_change::ConvertedValues>();
  if (how == nullptr) return {};
  return from.types.text(how->old_type) + " -> " + to.types.text(how->new_type);
}

std::string direction_text(const char* title, const Plan& plan, const ir::Image& from,
                           const ir::Image& to) {
  const online_change::Areas areas(to);
  tools::Table table({"record", "> from", "> to", "> bytes", "> count", "when", "variable"});
  for (const UpdateStep& step : plan.steps) {
    const auto source = step.source();
    const std::string types = types_of(step, from, to);
    table.row({kind_text(step.kind()), source ? std::to_string(source->from) : "",
               std::to_string(step.to), std::to_string(step.size), std::to_string(step.count),
               step.early() ? "before" : "boundary",
               variable_at(areas, step.to) + (types.empty() ? "" : " : " + types)});
  }
  std::string out = std::string(title) + ": " + std::to_string(plan.steps.size()) +
                    " update records, " + std::to_string(plan.boundary_bytes) +
                    " bytes at the boundary, pause " + tools::duration(plan.predicted_pause_ns) +
                    "\n";
  return plan.steps.empty() ? out : out + table.text();
}

}  // namespace

std::string package_text(const online_change::Package& package, const ir::Image& old_image,
                         const ir::Image& new_image) {
  const ir::OldUnderNewNames old(old_image, new_image);
  std::string out = "change package for " + base::short_hex(package.base) + ", to " +
                    base::short_hex(ir::digest(package.image)) + " (" +
                    std::to_string(package.image.size()) + " bytes)\n\n";
  out += direction_text("forward", package.forward, old.image(), new_image) + "\n";
  out += direction_text("back", package.inverse, new_image, old.image());
  return base::visible_lines(out);
}

}  // namespace stc
