// A chart as parts that stand below and beside each other: what a picture of it is made of.
// Alternatives and simultaneous branches that meet again are nested; other ways through the chart
// end in an arrow with the name of where they go on.
#pragma once

#include <vector>

#include "frontend/sfc/net.h"

namespace frontend::draw {

enum class PartKind : uint8_t {
  kStep,
  kTransition,
  kAlternatives,  // branches
  kSimultaneous,  // branches
  kJump,          // to a step
  kJoin,          // to a transition that waits for several steps
  kWaits,         // such a transition where its branches do not meet: what it waits for
};

struct Part;
using Sequence = std::vector<Part>;

struct Part {
  PartKind kind = PartKind::kStep;
  uint32_t number = 0;  // of a step or transition
  std::vector<Sequence> branches;
  std::vector<bool> meets;  // by branch: goes on after all of them
};

// Sequences beside each other: one for each network, and for what no other one leads to. Every
// step and transition is in exactly one of them.
std::vector<Sequence> chart_parts(const sfc::Net& net);

}  // namespace frontend::draw
