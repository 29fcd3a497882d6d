#include "linker/edit_steps.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/name_case.h"
#include "ir/bytecode/identities.h"
#include "linker/call_graph.h"
#include "linker/unlink.h"

namespace linker {
namespace {

using ir::PartEdit;

std::vector<PartEdit> edits_of(const EditImages& edit) {
  const std::vector<ir::Part> original = ir::parts_of(edit.original, edit.edited.unit_members);
  return ir::part_edits(original, ir::parts_of(edit.edited), original);
}

// Names of units, as they stand in an image.
std::vector<std::string> units_of(const ir::Image& image) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (uint32_t i = 0; i < image.pous.size(); ++i) {
    std::string name = ir::unit_name(image, i);
    if (!name.empty() && seen.insert(ir::fold_name(name)).second) names.push_back(std::move(name));
  }
  return names;
}

struct Steps {
  bool table = false;
  std::vector<std::string> units;  // in the order of the sources, removed ones after
};

Steps all_steps(const EditImages& edit) {
  Steps steps;
  std::map<std::string, std::string> left;
  for (const PartEdit& part : edits_of(edit)) {
    const std::string step(ir::step_of(part, edit.edited.unit_members));
    if (step == ir::kTableStep) {
      steps.table = true;
    } else {
      left.emplace(ir::fold_name(step), step);
    }
  }
  for (const std::string& name : units_of(edit.edited)) {
    if (left.erase(ir::fold_name(name)) != 0) steps.units.push_back(name);
  }
  for (const auto& [folded, name] : left) steps.units.push_back(name);
  return steps;
}

using Calls = std::map<std::string, std::set<std::string>>;  // by folded names of units

base::Result<Calls> calls_between_units(const ir::Image& image) {
  base::Result<Unlinked> parts = unlink(image);
  if (!parts.ok()) return parts.error();
  std::map<std::string, const ir::Object*> by_name;
  for (const ir::Object& object : parts->objects) by_name[ir::fold_name(object.name)] = &object;
  std::vector<const ir::Object*> objects(image.pous.size());
  std::vector<std::string> units(image.pous.size());
  for (uint32_t i = 0; i < image.pous.size(); ++i) {
    const auto found = by_name.find(ir::fold_name(image.pous[i].name));
    if (found != by_name.end()) objects[i] = found->second;
    units[i] = ir::fold_name(ir::unit_name(image, i));
  }
  const std::vector<ir::CallNode> nodes = call_nodes(image, objects);
  Calls calls;
  const auto add = [&](const std::string& caller, uint32_t callee) {
    if (callee < units.size() && !units[callee].empty() && units[callee] != caller) {
      calls[caller].insert(units[callee]);
    }
  };
  for (uint32_t i = 0; i < units.size(); ++i) {
    for (const uint32_t callee : nodes[i].callees) {
      add(units[i], callee);
      if (callee < units.size()) continue;
      for (const uint32_t choice : nodes[callee].callees) add(units[i], choice);
    }
  }
  return calls;
}

// Each unit after those that it calls, of which only those in `units` count; in a circle of calls
// one has to begin.
class CalleesFirst {
 public:
  CalleesFirst(const Calls& calls, const std::vector<std::string>& units) : calls_(calls) {
    for (const std::string& unit : units) names_[ir::fold_name(unit)] = unit;
    for (const std::string& unit : units) visit(ir::fold_name(unit));
  }
  std::vector<std::string> take() { return std::move(order_); }

 private:
  using Callees = std::set<std::string>;
  struct Open {
    std::string unit;
    Callees::const_iterator next;
    Callees::const_iterator end;
  };

  void open(const std::string& folded) {
    if (!seen_.insert(folded).second) return;
    const auto found = calls_.find(folded);
    const Callees& callees = found != calls_.end() ? found->second : none_;
    open_.push_back({folded, callees.begin(), callees.end()});
  }
  // Chains of calls can be as long as a program: not by recursion.
  void visit(const std::string& folded) {
    open(folded);
    while (!open_.empty()) {
      Open& top = open_.back();
      if (top.next != top.end) {
        const std::string& callee = *top.next++;
        open(callee);  // `top` is elsewhere then
        continue;
      }
      const auto name = names_.find(top.unit);
      if (name != names_.end()) order_.push_back(name->second);
      open_.pop_back();
    }
  }

  const Calls& calls_;
  const Callees none_;
  std::vector<Open> open_;
  std::map<std::string, std::string> names_;
  std::set<std::string> seen_;
  std::vector<std::string> order_;
};

base::Error step_usage(const std::string& text) { return {base::Refusal::kUsage, text}; }

}  // namespace

base::Result<std::vector<std::string>> edit_steps(const EditImages& edit, StepOrder order) {
  Steps steps = all_steps(edit);
  if (order == StepOrder::kCalleesFirst || order == StepOrder::kCallersFirst) {
    base::Result<Calls> calls = calls_between_units(edit.edited);
    if (!calls.ok()) return calls.error();
    steps.units = CalleesFirst(*calls, steps.units).take();
    if (order == StepOrder::kCallersFirst) std::reverse(steps.units.begin(), steps.units.end());
  }
  const bool last = order == StepOrder::kTableLast;
  if (steps.table)
    steps.units.insert(last ? steps.units.end() : steps.units.begin(), std::string(ir::kTableStep));
  return std::move(steps.units);
}

base::Result<std::vector<std::string>> listed_steps(const EditImages& edit,
                                                    const std::vector<std::string>& names) {
  base::Result<std::vector<std::string>> all = edit_steps(edit, StepOrder::kTableFirst);
  if (!all.ok()) return all;
  std::map<std::string, std::string> left;
  for (const std::string& step : *all) left.emplace(ir::fold_name(step), step);
  std::vector<std::string> steps;
  for (const std::string& name : names) {
    const bool table = ir::same_name(name, ir::kTableName);
    const auto found = left.find(table ? std::string(ir::kTableStep) : ir::fold_name(name));
    if (found == left.end()) {
      return step_usage("`" + name + "` is no part of the edit, or stands in the list twice");
    }
    steps.push_back(found->second);
    left.erase(found);
  }
  if (left.erase(std::string(ir::kTableStep)) != 0)
    steps.insert(steps.begin(), std::string(ir::kTableStep));
  if (left.empty()) return steps;
  return step_usage("`" + ir::step_text(left.begin()->second) + "` is edited, and not in the list");
}

base::Result<std::vector<RunsBefore>> runs_before(const EditImages& edit,
                                                  const std::vector<std::string>& steps) {
  base::Result<Calls> calls = calls_between_units(edit.edited);
  if (!calls.ok()) return calls.error();
  std::map<std::string, std::string> later;
  for (const std::string& step : steps) later.emplace(ir::fold_name(step), step);
  std::vector<RunsBefore> found;
  for (const std::string& step : steps) {
    later.erase(ir::fold_name(step));
    const auto callees = calls->find(ir::fold_name(step));
    if (callees == calls->end()) continue;
    for (const std::string& callee : callees->second) {
      const auto missing = later.find(callee);
      if (missing != later.end()) found.push_back({step, missing->second});
    }
  }
  return found;
}

}  // namespace linker
