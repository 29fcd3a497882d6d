#include "adapters/twincat/chart.h"

#include <algorithm>
#include <map>
#include <vector>

#include "adapters/twincat/archive.h"
#include "adapters/xml/operand.h"
#include "base/limits.h"
#include "base/name_case.h"

namespace twincat {
namespace {

using xml::ChartAttribute;
using xml::ChartAttributes;
using xml::Code;
using xml::Node;

constexpr const char* kRowIndent = "  ";

struct Transition {
  std::vector<std::string> from;
  std::vector<std::string> to;
  std::string condition;
  std::string comment;
};

// Where a list of elements ends: steps that a transition is to leave together, or transitions whose
// next steps are to come. Neither: nothing goes on, as behind a jump.
struct End {
  std::vector<std::string> steps;
  std::vector<size_t> transitions;
};

ChartAttributes attributes_of(Node element, xml::Reporter* report) {
  ChartAttributes out;
  for (const Item& item : items(element, "Attributes")) {
    out.add(member_text(item.node, "AttributeId"), member_text(member(item.node, "Value"), "Value"),
            element, report);
  }
  return out;
}

std::vector<Item> elements_of(Node segment) {
  return items(member(segment, "ElementList"), "InnerList");
}

class ChartReader {
 public:
  ChartReader(Node object, const std::string& what, xml::Reporter& report)
      : object_(object), what_(what), report_(report) {
    for (Node named : xml::children(object, "Transition")) {
      named_.emplace(base::fold_name(xml::attribute(named, "Name")), named);
    }
  }
  std::string run(Node root);

 private:
  void fail(Code code, Node at, const std::string& text, const std::string& fix = {});
  End list(Node segment, End at);
  End step(Node node, End at);
  End transition(Node node, const End& at);
  End branch(Node node, const End& at);
  bool count(Node at, size_t links);
  void enter(Node at, const End& from, const std::string& step);
  std::string condition(const ChartAttributes& attributes, Node node);
  void flags(Node object);

  Node object_;
  const std::string& what_;
  xml::Reporter& report_;
  bool failed_ = false;
  size_t links_ = 0;
  std::string steps_;
  std::vector<Transition> transitions_;
  std::map<std::string, std::string> least_times_;  // by step
  std::map<std::string, Node> named_;               // <Transition> of the POU, by folded name
};

void ChartReader::fail(Code code, Node at, const std::string& text, const std::string& fix) {
  report_.add(code, at, "the chart of " + what_ + ": " + text, fix);
  failed_ = true;
}

// False, after a report: transitions leave and enter too many steps.
bool ChartReader::count(Node at, size_t links) {
  links_ += links;
  if (links_ <= base::kMaxLinks) return true;
  if (!failed_) {
    fail(Code::kXmlLimit, at,
         "its transitions leave and enter more than " + std::to_string(base::kMaxLinks) + " steps");
  }
  return false;
}

void ChartReader::enter(Node at, const End& from, const std::string& step) {
  if (!count(at, from.transitions.size())) return;
  for (const size_t number : from.transitions) transitions_[number].to.push_back(step);
}

End ChartReader::step(Node node, End at) {
  const ChartAttributes attributes = attributes_of(node, &report_);
  const std::string name = attributes[ChartAttribute::kName];
  if (!xml::is_name(name)) {
    fail(Code::kXmlBadValue, node, "a step is called `" + name + "`, which is no name");
    return {};
  }
  if (!at.steps.empty()) {
    fail(Code::kBadXmlChart, node, "step `" + name + "` stands behind a step",
         "draw a transition between them");
  }
  for (const char* embedded : {"EmbeddedMainAction", "EmbeddedEntryAction", "EmbeddedExitAction"}) {
    if (!member(node, embedded)) continue;
    fail(Code::kXmlBody, node, "step `" + name + "` has an action inside of it",
         "make it an action of the POU");
  }
  const std::string comment = attributes[ChartAttribute::kComment];
  if (!comment.empty()) steps_ += xml::comment(comment, "");
  steps_ += (attributes.is_true(ChartAttribute::kInitial) ? "INITIAL_STEP " : "STEP ") + name +
            ":\n" + attributes.action_rows(node, kRowIndent, report_);
  for (const Item& item : elements_of(node)) {  // IEC actions
    const ChartAttributes of_action = attributes_of(item.node, &report_);
    const std::string qualifier = of_action[ChartAttribute::kQualifier];
    if (!xml::is_name(of_action[ChartAttribute::kName]) || qualifier.empty()) {
      fail(Code::kXmlBody, item.node,
           "an action of step `" + name + "` has no name or no qualifier");
      continue;
    }
    const size_t end = std::min(qualifier.find_first_of(" ,"), qualifier.size());
    const std::string time(
        xml::trimmed(std::string_view(qualifier).substr(std::min(end + 1, qualifier.size()))));
    const bool excluded = of_action.is_true(ChartAttribute::kExclude);
    if (excluded || !xml::is_name(qualifier.substr(0, end)) ||
        (!time.empty() && !xml::is_plain_operand(time))) {
      fail(Code::kXmlBody, item.node,
           "an action of step `" + name + "` has the qualifier `" + qualifier +
               (excluded ? "` and is excluded from the build" : "`, which is not known here"));
    }
    steps_ += kRowIndent + of_action[ChartAttribute::kName] + "(" + qualifier.substr(0, end) +
              (time.empty() ? "" : ", " + time) + ");\n";
  }
  steps_ += "END_STEP\n";
  if (const std::string time = attributes[ChartAttribute::kLeastTime]; !time.empty()) {
    if (!xml::is_plain_operand(time)) {
      fail(Code::kXmlBadValue, node,
           "the shortest time `" + time + "` of a step is neither time nor variable");
    }
    least_times_[name] = time;
  }
  enter(node, at, name);
  return {{name}, {}};
}

// An expression, or the name of a <Transition> of the POU, whose body is one.
std::string ChartReader::condition(const ChartAttributes& attributes, Node node) {
  const std::string name = attributes[ChartAttribute::kName];
  if (const auto found = named_.find(base::fold_name(name)); found != named_.end()) {
    const Node named = found->second;
    const Node body = xml::child(xml::child(named, "Implementation"), "ST");
    std::string text(xml::trimmed(xml::text_of(body)));
    const size_t assigned = text.find(":=");
    if (assigned != std::string::npos &&
        base::same_name(xml::trimmed(std::string_view(text).substr(0, assigned)), name)) {
      text.erase(0, assigned + 2);
    }
    while (!text.empty() && (text.back() == ';' || text.back() == ' ')) text.pop_back();
    text = xml::trimmed(text);
    if (xml::is_operand(text)) return text;
    fail(Code::kXmlBody, named, "transition `" + name + "` is no single expression in ST",
         "write it as one");
    return {};
  }
  if (name.empty()) {
    fail(Code::kXmlBody, node, "a transition has no condition");
  } else if (!xml::is_operand(name)) {
    fail(Code::kXmlBody, node, "the condition `" + name + "` is no expression");
  }
  return name;
}

End ChartReader::transition(Node node, const End& at) {
  const ChartAttributes attributes = attributes_of(node, &report_);
  if (at.steps.empty()) {
    fail(Code::kBadXmlChart, node, "a transition stands behind a transition",
         "draw a step between them");
    return {};
  }
  if (member(node, "EmbeddedTransition")) {
    fail(Code::kXmlBody, node, "a transition has its condition inside of it, as a body",
         "write it as an expression, or make it a transition of the POU");
  }
  if (attributes.is_true(ChartAttribute::kExclude)) {
    fail(Code::kXmlBody, node, "a transition that is excluded from the build does not come in",
         "take it out of the chart");
  }
  if (!count(node, at.steps.size())) return {};
  Transition out;
  out.from = at.steps;
  out.condition = condition(attributes, node);
  out.comment = attributes[ChartAttribute::kComment];
  transitions_.push_back(std::move(out));
  return {{}, {transitions_.size() - 1}};
}

// Ways that exclude each other begin and end with a transition; those that run beside each other
// begin and end with a step.
End ChartReader::branch(Node node, const End& at) {
  const ChartAttributes attributes = attributes_of(node, &report_);
  const bool parallel = attributes.is_true(ChartAttribute::kParallel);
  if (attributes.is_true(ChartAttribute::kExclude) || items(node, "Segments").empty()) {
    fail(Code::kXmlBody, node, "branches that have no ways, or are excluded, do not come in");
    return {};
  }
  if (parallel ? at.transitions.empty() : at.steps.empty()) {
    fail(Code::kBadXmlChart, node,
         parallel ? "parallel branches stand behind a step" : "branches stand behind a transition");
    return {};
  }
  End out;
  for (const Item& segment : items(node, "Segments")) {
    const End end = list(segment.node, at);
    out.transitions.insert(out.transitions.end(), end.transitions.begin(), end.transitions.end());
    out.steps.insert(out.steps.end(), end.steps.begin(), end.steps.end());
  }
  if (parallel ? !out.transitions.empty() : !out.steps.empty()) {
    fail(Code::kBadXmlChart, node,
         parallel ? "a parallel branch ends with a transition" : "a branch ends with a step");
    return {};
  }
  return out;
}

End ChartReader::list(Node segment, End at) {
  for (const Item& item : elements_of(segment)) {
    if (failed_) return {};
    if (item.type == "SFCJump") {
      const ChartAttributes attributes = attributes_of(item.node, &report_);
      const std::string target = attributes[ChartAttribute::kName];
      if (attributes.is_true(ChartAttribute::kExclude)) {
        fail(Code::kXmlBody, item.node, "a jump that is excluded from the build does not come in");
      }
      if (at.transitions.empty() || !xml::is_name(target)) {
        fail(Code::kBadXmlChart, item.node,
             "a jump to `" + target + "` stands behind no transition");
      }
      enter(item.node, at, target);
      at = {};
    } else if (item.type == "SFCStep") {
      at = step(item.node, std::move(at));
    } else if (item.type == "SFCTransition") {
      at = transition(item.node, at);
    } else if (item.type == "SFCBranch") {
      at = branch(item.node, at);
    } else if (item.type != "SFCComment") {
      fail(Code::kXmlBody, item.node,
           "an element of type `" + std::string(item.type) + "` is not known here");
    }
  }
  return at;
}

// Variables with which others command the chart. Not used: they do nothing there either.
void ChartReader::flags(Node object) {
  const Node all = member(find_object(object, "SFCProperty"), "Flags");
  std::string name;
  for (Node each : xml::children(all)) {
    if (xml::is(each, "v")) name = each.text().get();
    if (!xml::is(each, "o") || !is_true(each, "Use")) continue;
    report_.add(Code::kXmlNotUnderstood, each,
                "the chart of " + what_ + ": the flag `SFC" + name + "` does nothing here");
  }
}

std::string ChartReader::run(Node root) {
  const End end = list(root, {});
  if (!failed_ && !end.transitions.empty()) {
    fail(Code::kBadXmlChart, root, "it ends with a transition", "draw a step or a jump behind it");
  }
  flags(object_);
  std::string out = steps_;
  const auto names = [](const std::vector<std::string>& steps) {
    std::string list;
    for (const std::string& step : steps) list += (list.empty() ? "" : ", ") + step;
    return steps.size() == 1 ? list : "(" + list + ")";
  };
  for (const Transition& one : transitions_) {
    std::string condition = one.condition;
    for (const std::string& step : one.from) {
      const auto time = least_times_.find(step);
      if (time == least_times_.end()) continue;
      condition = ChartAttributes::after_least_time(condition, step, time->second);
    }
    if (!one.comment.empty()) out += xml::comment(one.comment, "");
    out += "TRANSITION FROM " + names(one.from) + " TO " + names(one.to) + " := " + condition +
           ";\nEND_TRANSITION\n";
  }
  return failed_ ? std::string() : out;
}

void add_own(Node segment, xml::OwnActions& out) {
  for (const Item& item : elements_of(segment)) {
    if (item.type == "SFCStep") {
      out.add(attributes_of(item.node, nullptr));
      for (const Item& action : elements_of(item.node)) {
        out.add_usual(attributes_of(action.node, nullptr)[ChartAttribute::kName]);
      }
    }
    for (const Item& way : items(item.node, "Segments")) add_own(way.node, out);
  }
}

}  // namespace

std::string chart_text(Node sfc, Node object, const std::string& what, xml::Reporter& report) {
  if (const ArchiveProblem problem = archive_problem(sfc); problem.node) {
    report.add(Code::kXmlBody, problem.node, "the chart of " + what + ": " + problem.text);
    return {};
  }
  const Node root = member(find_object(sfc, "SFCImplementationObject"), "Root");
  if (const std::string conflict = own_actions(sfc).conflict(); !conflict.empty()) {
    report.add(Code::kXmlBody, sfc, "the chart of " + what + ": " + conflict,
               "give each of them an action of its own");
    return {};
  }
  if (!root) {
    report.add(Code::kXmlBody, sfc, "the body of " + what + " holds no chart");
    return {};
  }
  return ChartReader(object, what, report).run(root);
}

xml::OwnActions own_actions(Node sfc) {
  xml::OwnActions out;
  add_own(member(find_object(sfc, "SFCImplementationObject"), "Root"), out);
  return out;
}

}  // namespace twincat
