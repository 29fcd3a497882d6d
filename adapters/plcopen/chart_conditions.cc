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

std::string Chart::plain_condition(const ChartElement& transition) {
  Node condition = xml::child(transition.node, "condition");
  if (Node inside = xml::child(condition, "inline")) {
    return condition_text(inside, std::string(xml::attribute(inside, "name")), report_);
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
               ? condition_text(xml::child(named->second, "body"), name, report_)
               : " := " + name + ";\n";
  }
  Node point = xml::child(condition, "connectionPointIn");
  if (xml::child(condition, "connection")) point = condition;  // TC6 1.0
  if (point) {
    std::vector<network::Link> links = drawing_.links_of(point);
    std::string out =
        drawing_.failed() ? "" : links_text(drawing_.elements(), links, transition.node, report_);
    return out.empty() ? error_text("a condition was not imported") : " := " + out + ";\n";
  }
  report_.add(Code::kXmlBody, transition.node, "a transition has no condition");
  return error_text("a transition has no condition");
}

std::string Chart::condition(const ChartElement& transition) {
  const std::string out = plain_condition(transition);
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
  std::string out = condition(transition);
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
