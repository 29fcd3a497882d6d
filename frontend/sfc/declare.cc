#include "frontend/sfc/declare.h"

#include "frontend/sfc/check.h"
#include "frontend/sfc/net.h"

namespace frontend::sfc {
namespace {

SpecId named_type(Tree& tree, const char* name, base::SourceSpan span) {
  Spec spec;
  spec.kind = SpecKind::kNamed;
  spec.name = {name, span};
  spec.span = span;
  tree.specs.push_back(std::move(spec));
  return SpecId(static_cast<uint32_t>(tree.specs.size() - 1));
}

VarDecl implied(Tree& tree, const char* type, Name name, base::SourceSpan span,
                Range32 attributes) {
  VarDecl decl;
  decl.names = {name};
  decl.attributes = attributes;
  decl.spec = named_type(tree, type, span);
  decl.implied = true;
  decl.span = span;
  return decl;
}

// The name of an action's record: the action's own, unless that is a variable.
Name record_name(Tree& tree, const Action& action) {
  if (action.decl != nullptr) return action.name;
  tree.made_names.push_back(std::string(action.name.text) + kRecordSuffix);
  return {tree.made_names.back(), action.name.span};
}

void declare(Tree& tree, PouDecl& pou, const Chart& chart, const Net& net) {
  VarBlock block;
  block.scope = pou.scope;
  block.span = chart.span;
  for (const ChartStep& step : chart.steps) {  // names stand twice, too
    block.vars.push_back(implied(tree, kStepType, step.name, chart.span, step.attributes));
  }
  for (const Action& action : net.actions) {
    const Range32 attributes = action.decl == nullptr ? Range32{} : action.decl->attributes;
    block.vars.push_back(
        implied(tree, kActionType, record_name(tree, action), chart.span, attributes));
  }
  for (const ChartAction& action : chart.actions) {
    const Action& first = net.actions[net.action_names.find(action.name.text)->second];
    if (first.decl == &action) continue;
    block.vars.push_back(implied(tree, kActionType, action.name, chart.span, action.attributes));
  }
  tree.made_names.push_back(clock_name(pou));
  const Name clock{tree.made_names.back(), chart.span};
  block.vars.push_back(implied(tree, "TIME", clock, chart.span, {}));
  pou.blocks.push_back(std::move(block));
}

// Where the parser lost something, what seems to be missing may have been there.
bool damaged(const PouDecl& pou, const base::Diagnostics& diagnostics) {
  for (const base::Diagnostic& message : diagnostics.all()) {
    bool inside = !(message.span.begin < pou.span.begin) && message.span.begin < pou.span.end;
    if (inside && base::diagnostic_row(message.code).severity == base::Severity::kError) {
      return true;
    }
  }
  return false;
}

}  // namespace

void declare_charts(Tree& tree, const base::SourceMap& sources, base::Diagnostics& diagnostics) {
  for (PouDecl& pou : tree.pous) {
    if (pou.chart == kNoChart) continue;
    const Chart& chart = tree.charts[pou.chart];
    Net net = resolve(chart);
    if (!damaged(pou, diagnostics)) check(chart, net, pou.name, sources, diagnostics);
    declare(tree, pou, chart, net);
  }
}

std::string clock_name(const PouDecl& pou) {
  return (pou.extends.empty() ? "" : std::string(pou.name.text) + ".") + kClock;
}

}  // namespace frontend::sfc
