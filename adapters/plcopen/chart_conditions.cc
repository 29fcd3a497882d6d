// Conditions of transitions, in all forms that TC6 has for them.
#include "adapters/plcopen/chart_reader.h"
#include "base/name_case.h"

namespace plcopen {

std::string Chart::priority(Node transition) {
  std::string text(xml::trimmed(xml::attribute(transition, "priority")));
  if (!prioritised_ || text.empty()) return {};
  if (id_of(text) != 0) return " (PRIORITY := " + text + ")";
  report_.add(Code::kXmlBadValue, transition, "priority `" + text + "` is no number");
  return {};
}

// What an expression cannot say is a method of the POU, so the drawing stays one.
std::string Chart::method_call(const std::string& name, const std::string& body) {
  if (body.empty()) return error_text("a condition was not imported");
  made_members.insert(base::fold_name(name));
  methods_ +=
      "METHOD PRIVATE " + name + " : BOOL\n" + xml::indented(body, kIndent) + "END_METHOD\n";
  return " := " + name + "();\n";
}

std::string Chart::body_condition(Node body, const std::string& name, const std::string& step) {
  for (Node node : xml::children(body)) {
    const bool drawn = xml::is(node, "LD") || xml::is(node, "FBD");
    if (!drawn || !is_more_than_expression(node)) continue;
    std::string& call = calls_[node.internal_object()];
    if (!call.empty()) return call;  // several transitions have it
    const std::string method =
        actions_.take(name.empty() ? step + "_condition" : xml::as_name(name));
    return call = method_call(method, condition_body(node, name, method, report_));
  }
  if (std::string text = statements_of_condition(body, name); !text.empty()) {
    std::string& call = calls_[body.internal_object()];
    if (!call.empty()) return call;
    const std::string method = actions_.take(xml::as_name(name));
    if (method != name) {
      text = "VAR\n  " + name + " : BOOL;\nEND_VAR\n" + text + method + " := " + name + ";\n";
    }
    return call = method_call(method, text);
  }
  return condition_text(body, name, report_);
}

// A box that two conditions have would be called by both of them. False after a report.
bool Chart::take_boxes(const Drawing& part) {
  bool good = true;
  for (uint32_t i = 0; i < part.elements().elements.size(); ++i) {
    const network::Element& element = part.elements().elements[i];
    const Node node = part.place_of(i);
    if (element.kind != network::Kind::kBlock || element.operand.empty() || !node) continue;
    if (taken_boxes_.insert(node.internal_object()).second) continue;
    report_.add(Code::kXmlBody, node,
                xml::shown(node) + " leads to several transitions, and each would call `" +
                    element.operand.text + "`",
                "call it in an action, and make its outputs the conditions");
    good = false;
  }
  return good;
}

void Chart::report_idle_boxes() {
  for (Node node : boxes_) {
    if (taken_boxes_.count(node.internal_object()) == 0) report_in_chart(node, report_);
  }
}

// Has following what is connected cost too much? After one report.
bool Chart::is_too_much(Node transition) {
  if (ways_ <= kMaxWays) return false;
  if (!reported_) {
    report_.add(Code::kBadXmlChart, transition,
                "there are too many ways through divergences, convergences and conditions");
  }
  return reported_ = true;
}

std::string Chart::linked_condition(Node point, Node transition, const std::string& step) {
  const std::vector<network::Link> links = drawing_.links_of(point);
  if (drawing_.failed() || is_too_much(transition)) {
    return error_text("a condition was not imported");
  }
  Drawing part = drawing_.part(links, {}, ways_);
  if (links.empty() || !is_more_than_expression(part.elements())) {
    std::string out = links_text(drawing_.elements(), links, transition, report_);
    return out.empty() ? error_text("a condition was not imported") : " := " + out + ";\n";
  }
  // Each has a copy of what it shares with others.
  ways_ += kWaysOfCopy * part.elements().elements.size();
  if (is_too_much(transition) || !take_boxes(part)) {
    return error_text("a condition was not imported");
  }
  const std::string method = actions_.take(step + "_condition");
  part.redirect(static_cast<uint32_t>(part.elements().elements.size() - 1), method);
  const std::string body = drawing_text(part, transition, method, {}, report_);
  return method_call(method, part.failed() ? std::string() : body);
}

std::string Chart::plain_condition(const ChartElement& transition, const std::string& step) {
  Node condition = xml::child(transition.node, "condition");
  if (Node inside = xml::child(condition, "inline")) {
    return body_condition(inside, std::string(xml::attribute(inside, "name")), step);
  }
  if (Node reference = xml::child(condition, "reference")) {
    const std::string name(report_.required(reference, "name"));
    auto named = transitions_.find(base::fold_name(name));
    // Without a transition of that name it is a variable.
    if (named == transitions_.end() && !name.empty() && !is_operand(name)) {
      report_.add(Code::kXmlBadValue, reference, "`" + name + "` is no variable");
      return error_text("a condition was not imported");
    }
    return named != transitions_.end()
               ? body_condition(xml::child(named->second, "body"), name, step)
               : " := " + name + ";\n";
  }
  Node point = xml::child(condition, "connectionPointIn");
  if (xml::child(condition, "connection")) point = condition;  // TC6 1.0
  if (point) return linked_condition(point, transition.node, step);
  report_.add(Code::kXmlBody, transition.node, "a transition has no condition");
  return error_text("a transition has no condition");
}

std::string Chart::condition(const ChartElement& transition, const std::string& step) {
  const std::string out = plain_condition(transition, step);
  if (!is_negated(xml::child(transition.node, "condition"), report_)) return out;
  if (out.starts_with(" := ")) return " := NOT (" + out.substr(4, out.size() - 6) + ");\n";
  if (!out.starts_with(":")) return out;  // an error already
  report_.add(Code::kXmlBody, transition.node, "a condition in IL is negated",
              "end it with NOT, or write it as an expression");
  return error_text("a negated condition was not imported");
}

// Steps may have to stay for a time, whatever the condition says.
std::string Chart::late_condition(const ChartElement& transition,
                                  const std::vector<std::string>& from) {
  std::string out = condition(transition, from.front());
  if (chart_attributes(transition.node, &report_).is_true(xml::ChartAttribute::kExclude)) {
    report_.add(Code::kXmlBody, transition.node,
                "a transition that is excluded from the build does not come in",
                "take it out of the chart");
  }
  for (const std::string& step : from) {
    const auto time = least_times_.find(step);
    if (time == least_times_.end()) continue;
    if (out.starts_with(" := ")) {
      out = " := " +
            xml::ChartAttributes::after_least_time(out.substr(4, out.size() - 6), step,
                                                   time->second) +
            ";\n";
    } else if (out.starts_with(":")) {
      report_.add(Code::kXmlBody, transition.node,
                  "a condition in IL behind a step that stays for a time does not come in",
                  "write it as an expression");
    }
  }
  return out;
}

}  // namespace plcopen
