// <SFC> -> steps, transitions and actions as text. Elements name what is above them; what is
// between transitions and steps (divergences, convergences, jumps) is followed here and then gone.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "adapters/plcopen/chart_reader.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

const char* const kBetween[] = {"selectionDivergence", "selectionConvergence",
                                "simultaneousDivergence", "simultaneousConvergence"};

bool is_between(Node node) {
  return std::any_of(std::begin(kBetween), std::end(kBetween),
                     [&](const char* name) { return xml::is(node, name); });
}

double place(Node node, const char* axis) {
  return xml::child(node, "position").attribute(axis).as_double();
}

}  // namespace

// Empty, after a report, when it has none, or that of another step.
std::string Chart::step_name(Node node) {
  const std::string name(report_.required(node, "name"));
  if (name.empty()) return name;
  if (renamed_.count(base::fold_name(name)) != 0) {
    report_.add(Code::kBadXmlChart, node, "there are two steps `" + name + "`");
    return {};
  }
  const std::string own = steps_.take(xml::as_name(name));
  renamed_.emplace(base::fold_name(name), own);
  if (own != name) {
    report_.add(Code::kXmlRenamed, node, "step `" + name + "` became `" + own + "`");
  }
  return own;
}

// Actions that stand in steps get names; these are taken.
void Chart::reserve_names() {
  for (Node action : xml::children(xml::child(pou_, "actions"), "action")) {
    actions_.take(xml::attribute(action, "name"));
  }
  for (Node list : xml::children(xml::child(pou_, "interface"))) {
    for (Node each : xml::children(list, "variable")) actions_.take(xml::attribute(each, "name"));
  }
  for (const ChartElement& element : elements_) {
    if (!element.name.empty()) actions_.take(element.name);
  }
}

void Chart::collect() {
  std::vector<Node> blocks;
  for (Node node : xml::children(sfc_)) {
    const bool step = xml::is(node, "step");
    if (xml::is(node, "actionBlock")) {
      blocks.push_back(node);
      continue;
    }
    if (xml::is(node, "comment")) {
      const std::string text = xml::text_of(xml::child(node, "content"));
      if (!text.empty()) comments_ += xml::comment(text, "");
      continue;
    }
    if (!step && !xml::is(node, "transition") && !xml::is(node, "jumpStep") && !is_between(node)) {
      add_condition_element(node);
      continue;
    }
    ChartElement element{node, {}, {}, {}, {}};
    if (step) {
      element.name = step_name(node);
      if (element.name.empty()) continue;
      const std::string time = chart_attributes(node, nullptr)[xml::ChartAttribute::kLeastTime];
      if (is_plain_operand(time)) {
        least_times_[element.name] = time;
      } else if (!time.empty()) {
        report_.add(Code::kXmlBadValue, node,
                    "the shortest time `" + time + "` of a step is neither time nor variable",
                    "write it like T#5s");
      }
    }
    elements_.push_back(std::move(element));
  }
  const auto above = [](const ChartElement& a, const ChartElement& b) {
    return std::pair(place(a.node, "y"), place(a.node, "x")) <
           std::pair(place(b.node, "y"), place(b.node, "x"));
  };
  std::stable_sort(elements_.begin(), elements_.end(), above);
  for (size_t i = 0; i < elements_.size(); ++i) {
    Node node = elements_[i].node;
    const uint64_t id = id_of(report_.required(node, "localId"));
    if (id == 0) {
      report_.add(Code::kXmlBadValue, node, "localId of " + xml::shown(node) + " is no number");
    } else if (!by_id_.emplace(id, i).second) {
      report_.add(Code::kXmlDoubleId, node,
                  "localId " + std::to_string(id - 1) + " is there twice");
    }
    std::string_view order = xml::attribute(node, "priority");
    if (xml::is(node, "transition") && !order.empty() && order != "0") prioritised_ = true;
  }
  for (Node named : xml::children(xml::child(pou_, "transitions"), "transition")) {
    transitions_[base::fold_name(xml::attribute(named, "name"))] = named;
  }
  connect();
  drawing_.connect();
  reserve_names();
  for (Node block : blocks) add_actions(block);
}

// What conditions are made of. Nothing else of it would ever be executed.
void Chart::add_condition_element(Node node) {
  const bool reads = xml::is(node, "contact") || xml::is(node, "inVariable") ||
                     xml::is(node, "leftPowerRail") || xml::is(node, "connector") ||
                     xml::is(node, "continuation") || xml::is(node, "block");
  if (!reads || !drawing_.add(node)) return report_in_chart(node, report_);
  if (!xml::trimmed(xml::attribute(node, "instanceName")).empty()) boxes_.push_back(node);
}

// Points at which an element hangs: several of divergences and convergences.
void Chart::connect() {
  for (size_t i = 0; i < elements_.size(); ++i) {
    ChartElement& element = elements_[i];
    for (Node point : xml::children(element.node, "connectionPointIn")) {
      for (Node connection : xml::children(point, "connection")) {
        const uint64_t id = id_of(xml::attribute(connection, "refLocalId"));
        auto found = by_id_.find(id);
        if (found == by_id_.end()) {
          report_.add(Code::kDanglingConnection, connection,
                      xml::shown(element.node) + " hangs at `" +
                          std::string(xml::attribute(connection, "refLocalId")) +
                          "`, which is no element of the chart");
          continue;
        }
        element.above.push_back(found->second);
        elements_[found->second].below.push_back(i);
      }
    }
  }
}

void Chart::add_actions(Node block) {
  Node connection = xml::find(block, {"connectionPointIn", "connection"});
  auto found = by_id_.find(id_of(xml::attribute(connection, "refLocalId")));
  if (found == by_id_.end() || !xml::is(elements_[found->second].node, "step")) {
    return report_.add(Code::kDanglingConnection, block, "an action block hangs at no step");
  }
  if (is_negated(block, report_)) {
    report_.add(Code::kXmlBody, block, "an action block is negated",
                "negate the variables in the actions");
  }
  ChartElement& step = elements_[found->second];
  for (Node node : xml::children(block, "action")) {
    ChartAction action{node, {}, {}};
    Node reference = xml::child(node, "reference");
    Node inside = xml::child(node, "inline");
    if (reference) {
      action.name = std::string(xml::trimmed(report_.required(reference, "name")));
      if (!action.name.empty() && !is_plain_operand(action.name)) {
        report_.add(Code::kXmlBadValue, reference,
                    "`" + action.name + "` is no action or variable");
        action.name.clear();
      }
    } else if (inside) {
      action.name = actions_.take(step.name + "_action");
      made_members.insert(base::fold_name(action.name));
      action.body =
          "ACTION " + action.name + ":\n" +
          xml::indented(language_text(inside, pou_, "action " + action.name, report_), kIndent) +
          "END_ACTION\n";
    } else {
      report_.add(Code::kXmlMissing, node, "an action has neither <reference> nor <inline>");
    }
    if (!action.name.empty()) step.actions.push_back(std::move(action));
  }
}

// The first one on top; each element once, so loops end.
void Chart::push_neighbours(const ChartElement& element, bool up, bool joined,
                            std::vector<Way>& todo) {
  if (!followed_.insert(&element).second) return;
  const bool many =
      joined || xml::is(element.node, up ? "simultaneousConvergence" : "simultaneousDivergence");
  const std::vector<size_t>& next = up ? element.above : element.below;
  if (next.size() > 1 && !many && !(up && xml::is(element.node, "selectionConvergence"))) {
    report_.add(Code::kBadXmlChart, element.node,
                up ? xml::shown(element.node) + " hangs at several elements"
                   : "several elements follow " + xml::shown(element.node) +
                         " without a divergence of simultaneous branches");
  }
  for (size_t i = next.size(); i-- > 0;) todo.push_back({&element, &elements_[next[i]], many});
}

std::string Chart::jump_target(const ChartElement& jump) {
  const std::string target(report_.required(jump.node, "targetName"));
  auto known = renamed_.find(base::fold_name(target));
  if (known != renamed_.end()) return known->second;
  if (!target.empty()) {
    report_.add(Code::kBadXmlChart, jump.node,
                "a jump leads to `" + target + "`, which is no step of this chart");
  }
  return {};
}

std::vector<std::string> Chart::steps_beside(const ChartElement& transition, bool up) {
  std::vector<std::string> out;
  std::vector<Way> todo;
  followed_.clear();
  push_neighbours(transition, up, false, todo);
  while (!todo.empty()) {
    ++ways_;
    if (is_too_much(transition.node)) return {};
    const Way way = todo.back();
    todo.pop_back();
    if (xml::is(way.to->node, "step")) {
      out.push_back(way.to->name);
    } else if (is_between(way.to->node)) {
      push_neighbours(*way.to, up, way.joined, todo);
    } else if (!up && xml::is(way.to->node, "jumpStep")) {
      if (std::string target = jump_target(*way.to); !target.empty()) out.push_back(target);
    } else {
      const ChartElement* first = up ? way.to : way.from;
      const ChartElement* second = up ? way.from : way.to;
      report_.add(Code::kBadXmlChart, second->node,
                  xml::shown(second->node) + " follows " + xml::shown(first->node) +
                      " without a step between them");
    }
  }
  return out;
}

std::string Chart::step_text(const ChartElement& step) {
  const bool initial = xml::boolean(xml::attribute(step.node, "initialStep")).value_or(false);
  std::string out = documentation(step.node, "");
  out += (initial ? "INITIAL_STEP " : "STEP ") + step.name + ":\n";
  out += chart_attributes(step.node, &report_).action_rows(step.node, kIndent, report_);
  for (const ChartAction& action : step.actions) {
    out += kIndent + action_use(action.node, action.name, report_) + "\n";
  }
  std::vector<std::string>& kept = report_.out().kept.data[place_of(step.node)];
  const size_t count = kept.size();
  vendor_data(step.node, report_);
  kept.resize(count);  // the kept chart has it
  return out + "END_STEP\n";
}

std::string Chart::transition_text(const ChartElement& transition) {
  std::vector<std::string> from = steps_beside(transition, true);
  std::vector<std::string> to = steps_beside(transition, false);
  if (ways_ > kMaxWays) return {};
  if (from.empty() || to.empty()) {
    const char* side = from.empty() ? "leaves" : "enters";
    report_.add(Code::kBadXmlChart, transition.node,
                std::string("a transition ") + side + " no step");
    return {};
  }
  auto list = [](std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return names.size() == 1 ? out : "(" + out + ")";
  };
  std::string out = documentation(transition.node, "");
  out += "TRANSITION" + priority(transition.node) + " FROM " + list(from) + " TO " + list(to);
  return out + late_condition(transition, from) + "END_TRANSITION\n";
}

// The element that a transition leaves, through alternatives.
const ChartElement& Chart::left_by(const ChartElement& transition) const {
  const ChartElement* at = &transition;
  for (size_t steps = 0; steps <= elements_.size() && !at->above.empty(); ++steps) {
    at = &elements_[at->above.front()];
    if (!xml::is(at->node, "selectionDivergence")) break;
  }
  return *at;
}

// Of alternatives without a priority the first one on the left goes, however high it stands.
std::vector<const ChartElement*> Chart::transitions() const {
  using Place = std::array<double, 4>;
  std::vector<std::pair<Place, const ChartElement*>> found;
  for (const ChartElement& element : elements_) {
    if (!xml::is(element.node, "transition")) continue;
    const Node left = left_by(element).node;
    found.push_back(
        {{place(left, "y"), place(left, "x"), place(element.node, "x"), place(element.node, "y")},
         &element});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const ChartElement*> out;
  for (const auto& [place, element] : found) out.push_back(element);
  return out;
}

std::string Chart::text() {
  collect();
  std::string steps, conditions, actions;
  for (const ChartElement& element : elements_) {
    if (!xml::is(element.node, "step")) continue;
    steps += step_text(element);
    for (const ChartAction& action : element.actions) actions += action.body;
  }
  for (const ChartElement* element : transitions()) conditions += transition_text(*element);
  report_idle_boxes();
  return comments_ + steps + conditions + actions + methods_;
}

std::string chart_text(Node sfc, Node pou, Reporter& report) {
  if (const std::string conflict = own_actions(pou).conflict(); !conflict.empty()) {
    report.add(Code::kXmlBody, sfc, "the chart: " + conflict,
               "give each of them an action of its own");
    return error_text("the chart was not imported");
  }
  Chart chart(sfc, pou, report);
  const std::string text = chart.text();
  keep_chart(sfc, pou, text, std::move(chart.made_members), report);
  return text;
}

}  // namespace plcopen
