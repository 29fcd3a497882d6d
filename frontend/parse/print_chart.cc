#include "frontend/parse/printer.h"

namespace frontend {
namespace {

const char* qualifier_name(ActionQualifier qualifier) {
  static constexpr const char* kNames[] = {"N",  "R",  "S",  "L",  "D", "P",
                                           "P0", "P1", "SD", "DS", "SL"};
  return kNames[static_cast<uint8_t>(qualifier)];
}

std::string step_list(const std::vector<Name>& steps) {
  std::string out;
  for (const Name& step : steps) out += (out.empty() ? "" : ", ") + std::string(step.text);
  return out;
}

}  // namespace

void Printer::chart(const Chart& chart) {
  for (const ChartStep& step : chart.steps) {
    line((step.initial ? "INITIAL_STEP " : "STEP ") + std::string(step.name.text));
    ++depth_;
    for (const ActionUse& use : step.uses) {
      std::string text = std::string(use.action.text) + ' ' + qualifier_name(use.qualifier);
      if (use.time.valid()) text += ' ' + expression(use.time);
      for (ExprId indicator : use.indicators) text += ", " + expression(indicator);
      line(text);
    }
    --depth_;
  }
  for (const ChartTransition& transition : chart.transitions) {
    std::string text = "TRANSITION ";
    if (!transition.name.empty()) text += std::string(transition.name.text) + ' ';
    if (transition.has_priority) text += "PRIORITY " + std::to_string(transition.priority) + ' ';
    text += "FROM " + step_list(transition.from) + " TO " + step_list(transition.to);
    if (transition.condition.valid()) text += " := " + expression(transition.condition);
    line(text);
  }
  for (const ChartAction& action : chart.actions) {
    nested("ACTION " + std::string(action.name.text), action.body);
  }
}

}  // namespace frontend
