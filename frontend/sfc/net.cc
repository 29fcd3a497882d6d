#include "frontend/sfc/net.h"

#include <algorithm>
#include <numeric>

namespace frontend::sfc {
namespace {

std::vector<uint32_t> numbers(const Net& net, const std::vector<Name>& names) {
  std::vector<uint32_t> out;
  for (const Name& name : names) {
    auto found = net.step_names.find(name.text);
    if (found != net.step_names.end()) out.push_back(found->second);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void resolve_steps(const Chart& chart, Net& net) {
  for (const ChartStep& step : chart.steps) {
    auto number = static_cast<uint32_t>(net.steps.size());
    if (!net.step_names.emplace(step.name.text, number).second) continue;
    net.steps.emplace_back().decl = &step;
  }
}

void resolve_transitions(const Chart& chart, Net& net) {
  for (const ChartTransition& decl : chart.transitions) {
    Transition transition{&decl, numbers(net, decl.from), numbers(net, decl.to)};
    if (transition.from.empty() || transition.to.empty()) continue;
    net.transitions.push_back(std::move(transition));
  }
  auto rank = [](const Transition& t) {
    return t.decl->has_priority ? uint64_t{t.decl->priority} : uint64_t{1} << 32;
  };
  std::stable_sort(net.transitions.begin(), net.transitions.end(),
                   [&](const Transition& a, const Transition& b) { return rank(a) < rank(b); });
  for (uint32_t t = 0; t < net.transitions.size(); ++t) {
    for (uint32_t step : net.transitions[t].from) net.steps[step].out.push_back(t);
  }
}

void resolve_actions(const Chart& chart, Net& net) {
  auto number_of = [&](const Name& name) {
    auto number = static_cast<uint32_t>(net.actions.size());
    auto [found, added] = net.action_names.emplace(name.text, number);
    if (added) net.actions.emplace_back().name = name;
    return found->second;
  };
  for (const ChartAction& action : chart.actions) {
    Action& known = net.actions[number_of(action.name)];
    if (known.decl == nullptr) known.decl = &action;
  }
  for (Step& step : net.steps) {
    for (const ActionUse& use : step.decl->uses) {
      uint32_t action = number_of(use.action);
      if (net.actions[action].uses++ == 0) net.actions[action].target = use.target;
      step.uses.push_back({action, &use});
    }
  }
}

// Steps that transitions connect are one network.
void find_networks(Net& net) {
  std::vector<uint32_t> parent(net.steps.size());
  std::iota(parent.begin(), parent.end(), 0u);
  auto root = [&](uint32_t step) {
    while (parent[step] != step) step = parent[step] = parent[parent[step]];
    return step;
  };
  for (const Transition& transition : net.transitions) {
    uint32_t first = root(transition.from[0]);
    for (uint32_t step : transition.from) parent[root(step)] = first;
    for (uint32_t step : transition.to) parent[root(step)] = first;
  }
  std::vector<uint32_t> number(net.steps.size(), kNone);
  for (uint32_t step = 0; step < net.steps.size(); ++step) {
    uint32_t& network = number[root(step)];
    if (network == kNone) {
      network = static_cast<uint32_t>(net.initial.size());
      net.initial.push_back(kNone);
    }
    net.steps[step].network = network;
    uint32_t& initial = net.initial[network];
    if (net.steps[step].decl->initial && initial == kNone) initial = step;
  }
}

}  // namespace

Net resolve(const Chart& chart) {
  Net net;
  resolve_steps(chart, net);
  resolve_transitions(chart, net);
  resolve_actions(chart, net);
  find_networks(net);
  return net;
}

}  // namespace frontend::sfc
