// A chart with its names resolved: steps by number, transitions in the order in which
// they are tried. Made anew by whoever needs it, from a Chart that outlives it; costs
// time in proportion to the chart. What names nothing is left out (check.h reports it).
#pragma once

#include <vector>

#include "frontend/parse/tree.h"
#include "frontend/sema/names.h"

namespace frontend::sfc {

inline constexpr uint32_t kNone = 0xffffffffu;

struct Transition {
  const ChartTransition* decl = nullptr;
  std::vector<uint32_t> from;  // sorted; as `to` never empty
  std::vector<uint32_t> to;
};

struct Action {  // an ACTION, or a name that may be a BOOL variable's
  Name name;
  const ChartAction* decl = nullptr;  // null: no ACTION has that name
  ExprId target;                      // the first association's
  uint32_t uses = 0;                  // associations
};

struct Use {
  uint32_t action = 0;  // Net::actions
  const ActionUse* decl = nullptr;
};

struct Step {
  const ChartStep* decl = nullptr;
  uint32_t network = 0;       // numbers of networks: 0 .. Net::initial.size() - 1
  std::vector<uint32_t> out;  // transitions that leave it
  std::vector<Use> uses;
};

struct Net {
  std::vector<Step> steps;              // in source order
  std::vector<Transition> transitions;  // by priority, then in source order
  std::vector<Action> actions;          // those with a body first, in source order
  std::vector<uint32_t> initial;        // of each network: its initial step, or kNone
  NameMap<uint32_t> step_names;
  NameMap<uint32_t> action_names;
};

Net resolve(const Chart& chart);

}  // namespace frontend::sfc
