// <SFC> -> steps, transitions and actions as text. Elements name what is above them; what is
// between transitions and steps (divergences, convergences, jumps) is followed here and then gone.
#include <algorithm>
#include <map>
#include <set>

#include "adapters/plcopen/drawing.h"
#include "adapters/plcopen/reader.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

struct Action {
  Node node;
  std::string name;  // of an ACTION or variable
  std::string body;  // of one that stands in the step; empty: elsewhere
};

struct Element {
  Node node;
  std::string name;             // steps: as the text has it
  std::vector<uint64_t> above;  // ids
  std::vector<size_t> below;    // elements
  std::vector<Action> actions;  // steps
};

class Chart {
 public:
  Chart(Node sfc, Node pou, Reporter& report)
      : sfc_(sfc), pou_(pou), report_(report), drawing_(true, report) {}
  std::string text();

 private:
  void collect();
  void add_condition_element(Node node);
  void connect();
  void add_actions(Node block);
  std::string step_name(Node node);
  void reserve_names();
  const Element* at(uint64_t id) const;
  // Names of the steps that a transition leaves or enters, through what lies between.
  void steps_above(const Element& element, bool joined, std::vector<std::string>& out);
  void steps_below(const Element& element, bool joined, std::vector<std::string>& out);
  std::string step_text(const Element& step);
  std::string use_text(const Action& action);
  std::string transition_text(const Element& transition);
  std::string condition(const Element& transition);
  std::string priority(Node transition);

  Node sfc_;
  Node pou_;
  Reporter& report_;
  Drawing drawing_;                // conditions
  std::vector<Element> elements_;  // in the order of the drawing
  std::map<uint64_t, size_t> by_id_;
  xml::Names steps_;
  std::map<std::string, std::string> renamed_;  // steps, by their folded names in XML
  xml::Names actions_;                          // and what else actions may not be called
  bool prioritised_ = false;
  std::set<const Element*> followed_;  // for one transition: each once, so loops end
};

const char* const kBetween[] = {"selectionDivergence", "selectionConvergence",
                                "simultaneousDivergence", "simultaneousConvergence"};

bool is_between(Node node) {
  return std::any_of(std::begin(kBetween), std::end(kBetween),
                     [&](const char* name) { return xml::is(node, name); });
}

// 0: none, or no number.
uint64_t number_of(std::string_view text) {
  uint64_t out = 0;
  if (text.empty() || text.size() > 19) return 0;
  for (char c : text) {
    if (c < '0' || c > '9') return 0;
    out = out * 10 + static_cast<uint64_t>(c - '0');
  }
  return out + 1;  // ids begin at 0
}

double place(Node node, const char* axis) {
  return xml::child(node, "position").attribute(axis).as_double();
}

// Empty, after a report, when it has none, or that of another step.
std::string Chart::step_name(Node node) {
  const std::string name(report_.required(node, "name"));
  if (name.empty()) return name;
  if (renamed_.count(base::fold_name(name)) != 0) {
    report_.add(Code::kBadXmlChart, node, "there are two steps `" + name + "`");
    return {};
  }
  std::string own = name;
  for (char& c : own) {
    if (!xml::is_name("x" + std::string(1, c))) c = '_';
  }
  if (!xml::is_name(own)) own = "_" + own;
  own = steps_.take(own);
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
  for (const Element& element : elements_) {
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
    if (xml::is(node, "comment")) continue;
    if (!step && !xml::is(node, "transition") && !xml::is(node, "jumpStep") && !is_between(node)) {
      add_condition_element(node);
      continue;
    }
    Element element{node, {}, {}, {}, {}};
    if (step) {
      element.name = step_name(node);
      if (element.name.empty()) continue;
    }
    elements_.push_back(std::move(element));
  }
  std::stable_sort(elements_.begin(), elements_.end(), [](const Element& a, const Element& b) {
    return std::pair(place(a.node, "y"), place(a.node, "x")) <
           std::pair(place(b.node, "y"), place(b.node, "x"));
  });
  for (size_t i = 0; i < elements_.size(); ++i) {
    Node node = elements_[i].node;
    const uint64_t id = number_of(report_.required(node, "localId"));
    if (id == 0) {
      report_.add(Code::kXmlBadValue, node, "localId of " + xml::shown(node) + " is no number");
    } else if (!by_id_.emplace(id, i).second) {
      report_.add(Code::kXmlDoubleId, node,
                  "localId " + std::to_string(id - 1) + " is there twice");
    }
    std::string_view order = xml::attribute(node, "priority");
    if (xml::is(node, "transition") && !order.empty() && order != "0") prioritised_ = true;
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
                     xml::is(node, "continuation") ||
                     (xml::is(node, "block") && xml::attribute(node, "instanceName").empty());
  if (!reads || !drawing_.add(node)) {
    report_.add(Code::kXmlBody, node, xml::shown(node) + " in a chart is not understood");
  }
}

// Points at which an element hangs: several of divergences and convergences.
void Chart::connect() {
  for (size_t i = 0; i < elements_.size(); ++i) {
    Element& element = elements_[i];
    for (Node point : xml::children(element.node, "connectionPointIn")) {
      for (Node connection : xml::children(point, "connection")) {
        const uint64_t id = number_of(xml::attribute(connection, "refLocalId"));
        auto found = by_id_.find(id);
        if (found == by_id_.end()) {
          report_.add(Code::kDanglingConnection, connection,
                      xml::shown(element.node) + " hangs at `" +
                          std::string(xml::attribute(connection, "refLocalId")) +
                          "`, which is no element of the chart");
          continue;
        }
        element.above.push_back(id);
        elements_[found->second].below.push_back(i);
      }
    }
  }
}

const Element* Chart::at(uint64_t id) const {
  auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &elements_[found->second];
}

void Chart::add_actions(Node block) {
  Node connection = xml::find(block, {"connectionPointIn", "connection"});
  auto found = by_id_.find(number_of(xml::attribute(connection, "refLocalId")));
  if (found == by_id_.end() || !xml::is(elements_[found->second].node, "step")) {
    return report_.add(Code::kDanglingConnection, block, "an action block hangs at no step");
  }
  Element& step = elements_[found->second];
  for (Node node : xml::children(block, "action")) {
    Action action{node, {}, {}};
    Node reference = xml::child(node, "reference");
    Node inside = xml::child(node, "inline");
    if (reference) {
      action.name = std::string(xml::trimmed(report_.required(reference, "name")));
    } else if (inside) {
      action.name = actions_.take(step.name + "_action");
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

// `joined`: behind a convergence of simultaneous branches, so several are meant.
void Chart::steps_above(const Element& element, bool joined, std::vector<std::string>& out) {
  if (!followed_.insert(&element).second) return;
  const bool many = joined || xml::is(element.node, "simultaneousConvergence");
  if (element.above.size() > 1 && !many && !xml::is(element.node, "selectionConvergence")) {
    report_.add(Code::kBadXmlChart, element.node,
                xml::shown(element.node) + " hangs at several elements");
  }
  for (uint64_t id : element.above) {
    const Element* above = at(id);
    if (xml::is(above->node, "step")) {
      out.push_back(above->name);
    } else if (is_between(above->node)) {
      steps_above(*above, many, out);
    } else {
      report_.add(Code::kBadXmlChart, element.node,
                  xml::shown(above->node) + " is followed by " + xml::shown(element.node) +
                      " without a step between them");
    }
  }
}

void Chart::steps_below(const Element& element, bool joined, std::vector<std::string>& out) {
  if (!followed_.insert(&element).second) return;
  const bool many = joined || xml::is(element.node, "simultaneousDivergence");
  if (element.below.size() > 1 && !many) {
    report_.add(Code::kBadXmlChart, element.node,
                "several elements follow " + xml::shown(element.node) +
                    " without a divergence of simultaneous branches");
  }
  for (size_t index : element.below) {
    const Element& below = elements_[index];
    if (xml::is(below.node, "step")) {
      out.push_back(below.name);
    } else if (xml::is(below.node, "jumpStep")) {
      std::string target(report_.required(below.node, "targetName"));
      auto known = renamed_.find(base::fold_name(target));
      if (known != renamed_.end()) {
        out.push_back(known->second);
      } else if (!target.empty()) {
        report_.add(Code::kBadXmlChart, below.node,
                    "a jump leads to `" + target + "`, which is no step of this chart");
      }
    } else if (is_between(below.node)) {
      steps_below(below, many, out);
    } else {
      report_.add(Code::kBadXmlChart, below.node,
                  xml::shown(below.node) + " follows " + xml::shown(element.node) +
                      " without a step between them");
    }
  }
}

std::string Chart::use_text(const Action& action) {
  static constexpr const char* kQualifiers[] = {"N",  "R",  "S",  "L",  "D", "P",
                                                "P0", "P1", "SD", "DS", "SL"};
  std::string qualifier(xml::trimmed(xml::attribute(action.node, "qualifier")));
  if (qualifier.empty()) qualifier = "N";
  const bool known = std::any_of(std::begin(kQualifiers), std::end(kQualifiers),
                                 [&](const char* each) { return qualifier == each; });
  if (!known) {
    report_.add(Code::kXmlBadValue, action.node, "`" + qualifier + "` is no action qualifier",
                "known are N R S L D P P0 P1 SD DS SL");
  }
  std::string out = action.name + "(" + qualifier;
  std::string time(xml::trimmed(xml::attribute(action.node, "duration")));
  const bool timed = qualifier == "L" || qualifier == "D" || qualifier.size() == 2;
  if (!time.empty() && timed && qualifier[0] != 'P') {
    const bool bare = time[0] >= '0' && time[0] <= '9';
    out += ", " + (bare ? "T#" + time : time);
  }
  std::string indicator(xml::trimmed(xml::attribute(action.node, "indicator")));
  if (!indicator.empty()) out += ", " + indicator;
  return out + ");";
}

std::string Chart::step_text(const Element& step) {
  const bool initial = xml::boolean(xml::attribute(step.node, "initialStep")).value_or(false);
  std::string out = documentation(step.node, "");
  out += (initial ? "INITIAL_STEP " : "STEP ") + step.name + ":\n";
  for (const Action& action : step.actions) out += kIndent + use_text(action) + "\n";
  vendor_data(step.node, report_);
  return out + "END_STEP\n";
}

std::string Chart::priority(Node transition) {
  std::string text(xml::trimmed(xml::attribute(transition, "priority")));
  if (!prioritised_ || text.empty()) return {};
  if (number_of(text) != 0) return " (PRIORITY := " + text + ")";
  report_.add(Code::kXmlBadValue, transition, "priority `" + text + "` is no number");
  return {};
}

std::string Chart::condition(const Element& transition) {
  Node condition = xml::child(transition.node, "condition");
  const std::string negated = xml::attribute(condition, "negated") == "true" ? "NOT " : "";
  Node inside = xml::child(condition, "inline");
  Node reference = xml::child(condition, "reference");
  std::string out;
  if (inside) {
    out = condition_text(inside, std::string(xml::attribute(inside, "name")), report_);
  } else if (reference) {
    const std::string name(report_.required(reference, "name"));
    Node named;
    for (Node each : xml::children(xml::child(pou_, "transitions"), "transition")) {
      if (base::same_name(xml::attribute(each, "name"), name)) named = each;
    }
    // Without a transition of that name it is a variable.
    out = named ? condition_text(xml::child(named, "body"), name, report_) : " := " + name + ";\n";
  } else if (Node point = xml::child(condition, "connectionPointIn")) {
    std::vector<network::Link> links = drawing_.links_of(point);
    if (drawing_.failed()) return error_text("a condition was not imported");
    out = links_text(drawing_.elements(), links, transition.node, report_);
    out = out.empty() ? error_text("a condition was not imported") : " := " + out + ";\n";
  } else {
    report_.add(Code::kXmlBody, transition.node, "a transition has no condition");
    return error_text("a transition has no condition");
  }
  if (negated.empty() || !out.starts_with(" := ")) return out;
  return " := NOT (" + out.substr(4, out.size() - 6) + ");\n";
}

std::string Chart::transition_text(const Element& transition) {
  std::vector<std::string> from, to;
  followed_.clear();
  steps_above(transition, false, from);
  followed_.clear();
  steps_below(transition, false, to);
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
  return out + condition(transition) + "END_TRANSITION\n";
}

std::string Chart::text() {
  collect();
  std::string steps, transitions, actions;
  for (const Element& element : elements_) {
    if (xml::is(element.node, "step")) {
      steps += step_text(element);
      for (const Action& action : element.actions) actions += action.body;
    } else if (xml::is(element.node, "transition")) {
      transitions += transition_text(element);
    }
  }
  return steps + transitions + actions;
}

}  // namespace

std::string chart_text(Node sfc, Node pou, Reporter& report) {
  return Chart(sfc, pou, report).text();
}

}  // namespace plcopen
