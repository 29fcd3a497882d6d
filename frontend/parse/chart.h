// A sequential function chart as the sources say it: steps with their associations,
// transitions, actions. Filled by the textual form (parse/chart.cc); other notations
// fill the same model. Names are as written and may name nothing: sfc/net.h resolves them.
#pragma once

#include <vector>

#include "frontend/parse/code_nodes.h"

namespace frontend {

// How a step acts on an action (IEC 61131-3, table 59).
enum class ActionQualifier : uint8_t {
  kN,   // while the step is active
  kR,   // ends what S, SD, DS, SL began, and every other request while the step is active
  kS,   // from now on, until R
  kL,   // while active, for a limited time
  kD,   // while active, after a delay
  kP,   // for the scan that enters the step
  kP0,  // the same for the scan that leaves it, without the final scan
  kP1,  // the same for the scan that enters it, without the final scan
  kSD,  // stored, and delayed even when the step is left meanwhile
  kDS,  // delayed, then stored when the step is still active
  kSL,  // stored, for a limited time even when the step is left meanwhile
};
// Attribute of an ACTION that has no final scan, as the actions that CODESYS and TwinCAT give to a
// step itself.
inline constexpr std::string_view kNoFinalScan = "no_final_scan";

constexpr bool needs_time(ActionQualifier qualifier) {
  return qualifier == ActionQualifier::kL || qualifier == ActionQualifier::kD ||
         qualifier >= ActionQualifier::kSD;
}

struct ActionUse {  // Act(L, T#5s, indicator) in a step
  Name action;
  ActionQualifier qualifier = ActionQualifier::kN;
  ExprId target;  // the action's name as an expression: it may be a variable
  ExprId time;    // invalid unless the qualifier needs one
  std::vector<ExprId> indicators;
  base::SourceSpan span;
};

struct ChartStep {
  Name name;
  Range32 attributes;
  bool initial = false;
  std::vector<ActionUse> uses;
};

struct ChartTransition {
  Name name;  // may be empty
  bool has_priority = false;
  uint32_t priority = 0;  // the lowest number goes first; those without come after
  std::vector<Name> from;
  std::vector<Name> to;
  ExprId condition;       // invalid when damaged
  base::SourceSpan span;  // of the head
};

struct ChartAction {
  Name name;
  Range32 body;  // Tree::stmt_lists
  base::SourceSpan span;
  Range32 attributes;
  uint32_t diagram = 0xffffffffu;  // as in PouDecl
};

// Never without any step or transition; actions in source order.
struct Chart {
  base::SourceSpan span;  // of its first element's head
  std::vector<ChartStep> steps;
  std::vector<ChartTransition> transitions;
  std::vector<ChartAction> actions;
};

}  // namespace frontend
