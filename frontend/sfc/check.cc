#include "frontend/sfc/check.h"

#include <algorithm>
#include <set>

#include "frontend/parse/declared_twice.h"
#include "frontend/sfc/play.h"

namespace frontend::sfc {
namespace {

using Code = base::DiagnosticCode;

std::string quoted(const Name& name) { return '`' + std::string(name.text) + '`'; }

bool check_step_list(const std::vector<Name>& list, const Net& net,
                     base::Diagnostics& diagnostics) {
  bool good = true;
  std::set<uint32_t> seen;
  for (const Name& name : list) {
    auto found = net.step_names.find(name.text);
    if (found == net.step_names.end()) {
      NearestName nearest(name.text);
      nearest.offer_all(net.step_names);
      diagnostics.add(Code::kUnknownStep, name.span,
                      "there is no step " + quoted(name) + " in this chart", nearest.fix());
      good = false;
    } else if (!seen.insert(found->second).second) {
      diagnostics.add(Code::kDuplicateName, name.span, quoted(name) + " stands twice in this list");
      good = false;
    }
  }
  return good;
}

bool check_transitions(const Chart& chart, const Net& net, const base::SourceMap& sources,
                       base::Diagnostics& diagnostics) {
  bool good = true;
  NameMap<base::SourceSpan> names;
  for (const ChartTransition& transition : chart.transitions) {
    good = check_step_list(transition.from, net, diagnostics) && good;
    good = check_step_list(transition.to, net, diagnostics) && good;
    good = good && !transition.from.empty() && !transition.to.empty();
    if (transition.name.empty()) continue;
    const auto [first, fresh] = names.emplace(transition.name.text, transition.name.span);
    if (fresh) continue;
    diagnostics.add(Code::kDuplicateName, transition.name.span,
                    "the transition " + declared_twice(sources, transition.name.text,
                                                       transition.name.span, first->second));
  }
  return good;
}

bool check_initial(const Net& net, const Name& pou, base::Diagnostics& diagnostics) {
  bool any = false;
  bool good = true;
  for (uint32_t number = 0; number < net.steps.size(); ++number) {
    const Step& step = net.steps[number];
    if (!step.decl->initial) continue;
    any = true;
    uint32_t first = net.initial[step.network];
    if (first == number) continue;
    good = false;
    diagnostics.add(Code::kInitialStep, step.decl->name.span,
                    "this network begins at " + quoted(net.steps[first].decl->name) + " already",
                    "make one of them a STEP, or take away the transitions that connect them");
  }
  if (any) return good;
  diagnostics.add(Code::kInitialStep, pou.span,
                  "no step of the chart " + quoted(pou) + " is an INITIAL_STEP",
                  "write INITIAL_STEP at the step where it begins");
  return false;
}

base::SourceSpan place_of(const ChartTransition& transition) {
  return transition.name.empty() ? transition.span : transition.name.span;
}

// Steps that are not entered only because of transitions that never fire.
std::vector<bool> behind(const Net& net, const std::vector<uint32_t>& dead) {
  std::vector<bool> seen(net.steps.size());
  std::vector<uint32_t> open;
  auto meet = [&](uint32_t transition) {
    for (uint32_t step : net.transitions[transition].to) {
      if (!seen[step]) open.push_back(step);
      seen[step] = true;
    }
  };
  for (uint32_t transition : dead) meet(transition);
  while (!open.empty()) {
    uint32_t step = open.back();
    open.pop_back();
    for (uint32_t transition : net.steps[step].out) meet(transition);
  }
  return seen;
}

// All conditions are free, so a warning may meet a chart whose conditions make it good.
void report_play(const Net& net, const Play& play, base::Diagnostics& diagnostics) {
  std::vector<uint32_t> dead;
  for (uint32_t t = 0; t < net.transitions.size(); ++t) {
    const Transition& transition = net.transitions[t];
    bool entered = std::all_of(transition.from.begin(), transition.from.end(),
                               [&](uint32_t step) { return play.entered[step]; });
    if (play.complete && entered && !play.fired[t]) dead.push_back(t);
  }
  for (uint32_t t : dead) {
    diagnostics.add(Code::kDeadTransition, place_of(*net.transitions[t].decl),
                    "this transition never fires: its steps are never active together",
                    "give each alternative branch a transition of its own");
  }
  std::vector<bool> follows = behind(net, dead);
  for (uint32_t number = 0; number < net.steps.size(); ++number) {
    if (play.entered[number] || follows[number]) continue;
    const Name& name = net.steps[number].decl->name;
    diagnostics.add(Code::kUnreachableStep, name.span,
                    "the step " + quoted(name) + " is never entered",
                    "add a transition that leads to it, or remove it");
  }
  for (uint32_t t : play.unsafe) {
    if (t == kNone) continue;
    const ChartTransition& transition = *net.transitions[t].decl;
    diagnostics.add(Code::kUnsafeTransition, place_of(transition),
                    "this enters " + quoted(transition.to[0]) +
                        ", which may be active by a branch that runs at the same time",
                    "end simultaneous branches together: FROM (a, b)");
  }
}

}  // namespace

void check(const Chart& chart, const Net& net, const Name& pou, const base::SourceMap& sources,
           base::Diagnostics& diagnostics) {
  bool good = check_transitions(chart, net, sources, diagnostics);
  good = check_initial(net, pou, diagnostics) && good;
  for (const Action& action : net.actions) {
    if (action.decl == nullptr || action.uses != 0) continue;
    diagnostics.add(Code::kUnusedAction, action.name.span,
                    "no step uses the action " + quoted(action.name), "write it into a step");
  }
  if (good) report_play(net, play(net), diagnostics);
}

}  // namespace frontend::sfc
