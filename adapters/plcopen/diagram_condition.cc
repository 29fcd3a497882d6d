// Conditions of charts that are drawn: an expression, or, where something is called or remembered,
// a method that the condition calls.
#include <algorithm>
#include <utility>

#include "adapters/plcopen/drawing.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

using network::Element;
using network::Kind;
using network::Link;
using network::Modifier;

constexpr size_t kMaxExpression = 20'000;  // shared parts of a network are written out each time

// What a link carries, as an expression of Structured Text.
class ExpressionText {
 public:
  ExpressionText(const network::Network& all) : all_(all) {}

  std::string text(const std::vector<Link>& links) {
    std::string out;
    for (Link link : links) out += (out.empty() ? "" : " OR ") + text(link);
    return links.size() > 1 ? "(" + out + ")" : out;
  }
  std::string arrives(const network::Input& input) {
    if (input.modifier > Modifier::kNegated) return fail("sees an edge, which needs a memory");
    return (input.modifier == Modifier::kNegated ? "NOT " : "") + text(input.from);
  }
  const std::string& problem() const { return problem_; }

 private:
  std::string fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
    return {};
  }

  std::string text(Link link) {
    written_ += 8;
    if (depth_ > 60 || written_ > kMaxExpression) return fail("is too long for an expression");
    const Element& from = all_.elements[link.element];
    written_ += from.operand.text.size();
    ++depth_;
    std::string out = element(from, link.output);
    --depth_;
    const bool negated = link.output < from.outputs.size() && from.outputs[link.output].negated;
    return negated ? "NOT (" + out + ")" : out;
  }

  std::string element(const Element& from, uint32_t output) {
    switch (from.kind) {
      case Kind::kLeftRail:
        return "TRUE";
      case Kind::kSource:
        return "(" + from.operand.text + ")";
      case Kind::kContact:
        return contact(from);
      case Kind::kBlock:
        return block(from, output);
      case Kind::kCoil:
        return arrives(from.inputs[0]);
      default:
        return fail("is no expression");
    }
  }

  std::string contact(const Element& from) {
    if (from.modifier > Modifier::kNegated) return fail("sees an edge, which needs a memory");
    std::string own = "(" + from.operand.text + ")";
    if (from.modifier == Modifier::kNegated) own = "NOT " + own;
    std::string before = arrives(from.inputs[0]);
    return before == "TRUE" ? own : "(" + before + " AND " + own + ")";
  }

  std::string block(const Element& from, uint32_t output) {
    if (!from.operand.empty()) {  // its value of now; something else calls it
      return from.operand.text + "." + from.outputs[output].name;
    }
    for (uint32_t i = 0; i < output; ++i) {
      if (!base::same_name(from.outputs[i].name, "ENO")) return fail("needs a second output");
    }
    std::string arguments;
    for (const network::Input& input : from.inputs) {
      if (input.from.empty()) continue;
      std::string value = arrives(input);
      if (!input.name.empty()) value = input.name + " := " + value;
      arguments += (arguments.empty() ? "" : ", ") + value;
    }
    return from.type.text + "(" + arguments + ")";
  }

  const network::Network& all_;
  std::string problem_;
  uint32_t depth_ = 0;
  size_t written_ = 0;
};

constexpr const char* kResult =
    "let one coil or <outVariable> with the name of the transition take the condition";

// The end of a condition's body: the one called `name`, or the only one. Null after a report.
const Element* end_of(const Drawing& drawing, Node body, const std::string& name,
                      Reporter& report) {
  const Element* end = nullptr;
  uint32_t ends = 0;
  uint32_t named = 0;
  for (const Element& element : drawing.elements().elements) {
    if (element.kind != Kind::kCoil && element.kind != Kind::kSink) continue;
    const bool own = base::same_name(element.operand.text, name);
    named += own ? 1 : 0;
    if (ends++ == 0 || own) end = &element;
  }
  std::string problem;
  if (named > 1) {
    problem = "the condition ends in " + std::to_string(named) + " coils and variables `" + name +
              "` instead of one";
  } else if (ends == 0 || (ends > 1 && named == 0)) {
    problem = "the condition ends in " + std::to_string(ends) + " coils and variables" +
              (ends == 0 ? "" : ", and none has the name of its transition");
  } else if (end->modifier == Modifier::kSet || end->modifier == Modifier::kReset) {
    problem = "the condition sets or resets its own end, which keeps nothing";
  }
  if (problem.empty()) return end;
  report.add(Code::kXmlBody, body, problem, kResult);
  return nullptr;
}

constexpr const char* kComputeInAction =
    "compute it in an action, and make a variable the condition";

}  // namespace

std::string links_text(const network::Network& all, const std::vector<Link>& links, Node at,
                       Reporter& report) {
  ExpressionText expression(all);
  std::string text = expression.text(links);
  if (expression.problem().empty() && !links.empty()) return text;
  report.add(Code::kXmlBody, at,
             links.empty() ? "nothing is connected to a condition"
                           : "what is connected to a condition " + expression.problem(),
             kComputeInAction);
  return {};
}

void report_in_chart(Node node, Reporter& report) {
  const std::string instance(xml::trimmed(xml::attribute(node, "instanceName")));
  const std::string what = xml::shown(node);
  if (xml::is(node, "macroStep")) {
    return report.add(
        Code::kXmlBody, node, what + ": steps of a chart inside of a step do not come in",
        "draw its steps into the chart itself, or into a function block of their own");
  }
  if (xml::is(node, "block") && !instance.empty()) {
    return report.add(Code::kXmlBody, node,
                      what + " calls `" + instance + "`, and leads to no condition of the chart",
                      "connect it to a transition, or call it in an action");
  }
  for (const char* name : {"coil", "outVariable", "inOutVariable", "jump", "return"}) {
    if (!xml::is(node, name)) continue;
    return report.add(Code::kXmlBody, node, what + " does something, and a chart has it nowhere",
                      "put it into an action");
  }
  report.add(Code::kXmlBody, node, what + " in a chart is not understood");
}

std::string diagram_condition(Node body, const std::string& name, Reporter& report) {
  Drawing drawing(xml::is(body, "LD"), report);
  if (!add_all(body, drawing, "a condition", report)) return {};
  const Element* end = end_of(drawing, body, name, report);
  if (end == nullptr) return {};
  std::string text = links_text(drawing.elements(), end->inputs[0].from, body, report);
  return end->modifier == Modifier::kNegated && !text.empty() ? "NOT (" + text + ")" : text;
}

bool is_more_than_expression(Node body) {
  uint32_t ends = 0;
  for (Node node : xml::children(body)) {
    const bool both = xml::is(node, "inOutVariable");
    if (xml::is(node, "jump") || xml::is(node, "return") || both) return true;
    if (xml::is(node, "coil") || xml::is(node, "outVariable")) ++ends;
    if (xml::is(node, "block") && !xml::attribute(node, "instanceName").empty()) return true;
    std::vector<Node> places = {node};
    for (Node list : xml::children(node)) {
      for (Node pin : xml::children(list, "variable")) places.push_back(pin);
    }
    for (Node place : places) {
      const std::string_view edge = xml::attribute(place, "edge");
      if (!edge.empty() && edge != "none") return true;
    }
  }
  return ends > 1;
}

bool is_more_than_expression(const network::Network& all) {
  return std::ranges::any_of(all.elements, [](const Element& element) {
    if (element.kind == Kind::kBlock && !element.operand.empty()) return true;
    return element.modifier > Modifier::kNegated ||
           std::ranges::any_of(element.inputs, [](const network::Input& input) {
             return input.modifier > Modifier::kNegated;
           });
  });
}

std::string condition_body(Node body, const std::string& name, const std::string& method,
                           Reporter& report) {
  Drawing drawing(xml::is(body, "LD"), report);
  if (!add_all(body, drawing, "a condition", report)) return {};
  const Element* end = end_of(drawing, body, name, report);
  if (end == nullptr) return {};
  const bool same = base::same_name(end->operand.text, method);
  drawing.redirect(static_cast<uint32_t>(end - drawing.elements().elements.data()), method);
  std::string text =
      drawing_text(drawing, body, method, same ? plain_xml(body) : std::string(), report);
  return drawing.failed() ? std::string() : text;
}

}  // namespace plcopen
