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

  // What is known within one call: an array of BOOL in the frame, all FALSE when the call
  // begins. Numbers of its elements; kNone where nobody asks.
  ir::Place flags;
  uint32_t flag_count = 0;
  using Numbers = std::vector<uint32_t>;
  Numbers active;      // by network: one of its steps is
  Numbers fired;       // by transition
  Numbers spent;       // by step: a transition that leaves it has fired, of several
  Numbers entered;     // by step
  Numbers left;        // by step
  Numbers wanted;      // by action: Q, with a final scan
  Numbers pulsed;      // by action: P1
  Numbers released;    // by action: P0
  Numbers reset;       // by action
  Numbers late;        // by action: its statements run behind those that end
  uint32_t moved = 0;  // some transition has fired
  uint32_t early = 0;  // some action has its final scan, or runs by P0

  bool uses(uint32_t action, ActionQualifier qualifier) const {
    return (qualifiers[action] >> static_cast<uint32_t>(qualifier) & 1) != 0;
  }
  void number_flags();
};

}  // namespace frontend
