#include "tools/stc/start_steps.h"

#include <algorithm>

#include "base/tool_limits.h"
#include "ir/bytecode/verify.h"
#include "linker/merge.h"

namespace stc {
namespace {

base::Error start_usage(const std::string& text) {
  return {base::Refusal::kUsage, "fleet: " + text};
}

std::vector<std::string> listed_names(const std::string& text) {
  std::vector<std::string> names;
  for (size_t at = 0; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    names.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return names;
}

base::Result<std::vector<std::string>> ordered(const tools::Options& options,
                                               const linker::EditImages& edit) {
  using linker::StepOrder;
  const std::string order = options.text("--order");
  if ((order == "list") != options.has("--list")) {
    return start_usage("--order list and --list A,B,C belong together");
  }
  if (order == "list") return linker::listed_steps(edit, listed_names(options.text("--list")));
  if (order == "table-last") return linker::edit_steps(edit, StepOrder::kTableLast);
  if (order == "callers-first") return linker::edit_steps(edit, StepOrder::kCallersFirst);
  if (order == "callees-first" || order == "auto") {
    return linker::edit_steps(edit, StepOrder::kCalleesFirst);
  }
  return linker::edit_steps(edit, StepOrder::kTableFirst);
}

base::Status check_mixtures(const linker::EditImages& edit, const std::vector<std::string>& steps) {
  base::Result<std::vector<linker::RunsBefore>> before = linker::runs_before(edit, steps);
  if (!before.ok()) return before.error();
  if (before->empty()) return base::Ok{};
  std::string text;
  for (const linker::RunsBefore& one : *before) {
    text += (text.empty() ? "" : ", ") + ("`" + one.unit + "` before `" + one.needs + "`");
  }
  return base::Error{base::Refusal::kMixture,
                     "these would run with an old version of what they call: " + text +
                         "; choose --order callees-first, or allow it with --allow-mixture"};
}

// Each step in turn, in the original itself: what cannot come there cannot come anywhere.
base::Status check_steps(const linker::EditImages& edit, const std::vector<std::string>& steps) {
  ir::Image now = edit.original;
  for (const std::string& step : steps) {
    linker::MergeOptions one;
    one.step = step;
    base::Result<ir::Image> next = linker::merge({edit.original, edit.edited, now}, one);
    if (!next.ok()) {
      return base::Error{next.error().refusal,
                         "`" + ir::step_text(step) + "` cannot come before what is left: " +
                             next.error().text + "; choose another --order, or --start together"};
    }
    base::Result<ir::VerifiedImage> sound = ir::verify(ir::encode(*next));
    if (!sound.ok()) return sound.error();
    now = sound->image();
  }
  return base::Ok{};
}

}  // namespace

base::Result<std::vector<std::string>> start_steps(const tools::Options& options,
                                                   const linker::EditImages& edit) {
  const std::string start = options.text("--start");
  if (start.empty() || start == "together") {
    for (const char* const name : {"--order", "--list", "--allow-mixture", "--show-order"}) {
      if (options.has(name)) return start_usage(std::string(name) + " is for --start each or auto");
    }
    return std::vector<std::string>();
  }
  base::Result<std::vector<std::string>> steps = ordered(options, edit);
  if (!steps.ok()) return steps;
  if (steps->size() > base::kMostEditsOnTrial) {
    return start_usage(std::to_string(steps->size()) + " steps are more than the " +
                       std::to_string(base::kMostEditsOnTrial) +
                       " edits that can be on trial at once (kMostEditsOnTrial); let them start "
                       "together, or make several files");
  }
  if (!options.has("--allow-mixture")) {
    if (base::Status whole = check_mixtures(edit, *steps); !whole.ok()) return whole.error();
  }
  if (base::Status good = check_steps(edit, *steps); !good.ok()) return good.error();
  return steps;
}

std::string order_text(const std::vector<std::string>& steps) {
  std::string text;
  for (size_t i = 0; i < steps.size(); ++i) {
    text += std::to_string(i + 1) + " " + ir::step_text(steps[i]) + "\n";
  }
  return text;
}

}  // namespace stc
