// The code of one chart on its way: its net, where its state lives, and the flags of the
// current call. docs/adr/0009-sfc.md says what happens in which order.
#pragma once

#include "frontend/lower/body.h"
#include "frontend/sfc/net.h"

namespace frontend {

struct Body::ChartCode {
  explicit ChartCode(const Chart& of) : chart(of), net(sfc::resolve(of)) {}

  const Chart& chart;
  sfc::Net net;
  std::vector<VarId> steps;  // variables of the steps and action records
  std::vector<VarId> actions;
  VarId clock;
  std::vector<uint16_t> qualifiers;  // by action: bit 1 << ActionQualifier
  ir::ValueId elapsed;               // ns since the last call
  // BOOL arrays of the frame, all FALSE when a call begins.
  ir::Place active;   // by network: one of its steps is
  ir::Place fired;    // by transition
  ir::Place spent;    // by step: a transition that leaves it has fired
  ir::Place entered;  // by step
  ir::Place left;     // by step
  ir::Place wanted;   // by action: Q, with a final scan
  ir::Place pulsed;   // by action: Q, without one
  ir::Place reset;    // by action
  // BOOL
  ir::Place moved;  // some transition has fired
  ir::Place final;  // some action has its final scan

  bool uses(uint32_t action, ActionQualifier qualifier) const {
    return (qualifiers[action] >> static_cast<uint32_t>(qualifier) & 1) != 0;
  }
};

}  // namespace frontend
