// Diagrams as text: whole bodies, and what arrives somewhere as an expression.
#include <utility>

#include "adapters/plcopen/drawing.h"
#include "adapters/xml/diagram_text.h"
#include "base/name_case.h"
#include "frontend/fbd/read.h"
#include "frontend/network/same.h"

namespace plcopen {
namespace {

using network::Element;
using network::Kind;
using network::Link;
using network::Modifier;

constexpr size_t kMaxExpression = 20'000;  // shared parts of a network are written out each time

// What a link carries, as an expression of Structured Text.
class Expression {
 public:
  Expression(const network::Network& all) : all_(all) {}

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

// Why a network is no condition; empty: it is one. Instances are called somewhere; a condition
// only reads.
std::string condition_problem(const network::Network& all, uint32_t ends) {
  bool edge = false;
  for (const Element& element : all.elements) {
    if (element.kind == Kind::kBlock && !element.operand.empty()) {
      return "the condition calls `" + element.operand.text + "`, and conditions only read";
    }
    const bool end = element.kind == Kind::kCoil || element.kind == Kind::kSink;
    edge = edge || (end && element.modifier > Modifier::kNegated);
    for (const network::Input& input : element.inputs) edge |= input.modifier > Modifier::kNegated;
  }
  if (edge) return "the condition sees an edge or sets something, which needs a memory";
  if (ends == 1) return {};
  return "the condition ends in " + std::to_string(ends) + " coils and variables instead of one";
}

constexpr const char* kComputeInAction =
    "compute it in an action, and make a variable the condition";

bool add_all(Node body, Drawing& drawing, const std::string& name, Reporter& report) {
  bool good = true;
  for (Node node : xml::children(body)) {
    if (xml::is(node, "addData") || xml::is(node, "documentation")) continue;
    if (drawing.add(node)) continue;
    report.add(Code::kXmlBody, node,
               xml::shown(node) + " in the body of " + name + " is not understood");
    good = false;
  }
  return drawing.connect() && good;
}

// Variables and actions that a body sees, between blanks.
std::string names_around(Node body) {
  std::string out;
  auto add = [&](Node list, const char* kind) {
    for (Node each : xml::children(list, kind)) {
      out += ' ' + std::string(xml::attribute(each, "name"));
    }
  };
  for (Node owner = body.parent(); owner; owner = owner.parent()) {
    add(xml::child(owner, "actions"), "action");
    Node interface = xml::child(owner, "interface");
    for (Node list : xml::children(interface)) add(list, "variable");
    if (interface) out += ' ' + xml::text_of(interface);  // as CODESYS keeps it
  }
  return out;
}

}  // namespace

std::string diagram_text(Node body, const std::string& name, Reporter& report) {
  const bool ladder = xml::is(body, "LD");
  Drawing drawing(ladder, report);
  const bool added = add_all(body, drawing, name, report);
  network::Body made = added ? drawing.body() : network::Body();
  if (!added || drawing.failed()) return error_text("the body of " + name + " was not imported");
  if (made.networks.empty()) return {};
  const std::string own = name.substr(name.rfind(' ') + 1);
  const bool whole = base::same_name(own, report.pou());
  xml::KeptDrawing& kept =
      report.out().kept.drawings[base::fold_name(whole ? own : report.pou() + "." + own)];
  kept = {made, {}, report.origin(body) == body ? plain_xml(body) : std::string()};
  xml::DiagramText out = xml::diagram_text(made, names_around(body), report.as_fbd(body));
  if (!out.rows.empty()) {
    base::Diagnostics unheard;
    kept.text = network::canonical(frontend::fbd::read(out.rows, base::SourcePos{0}, unheard));
  }
  return std::move(out.text);
}

std::string links_text(const network::Network& all, const std::vector<Link>& links, Node at,
                       Reporter& report) {
  Expression expression(all);
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
                      what + " calls `" + instance + "`, and conditions of a chart only read",
                      "call it in an action, and make its output the condition");
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
  const network::Network& all = drawing.elements();
  const Element* end = nullptr;
  uint32_t ends = 0;
  for (const Element& element : all.elements) {
    if (element.kind != Kind::kCoil && element.kind != Kind::kSink) continue;
    ++ends;
    if (end == nullptr || base::same_name(element.operand.text, name)) end = &element;
  }
  const std::string problem = condition_problem(all, ends);
  if (!problem.empty()) {
    report.add(Code::kXmlBody, body, problem, kComputeInAction);
    return {};
  }
  std::string text = links_text(all, end->inputs[0].from, body, report);
  return end->modifier == Modifier::kNegated && !text.empty() ? "NOT (" + text + ")" : text;
}

}  // namespace plcopen
