// Lowers the chart of one body: where its state lives, the flags of one call, and the code that
// moves steps and controls actions. docs/adr/0009-sfc.md says what happens in which order.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "frontend/lower/body_phase.h"
#include "frontend/sfc/net.h"

namespace frontend {

// Flags of steps and actions.
inline constexpr ir::Scalar kFlag = ir::Scalar::kBool;
inline constexpr ir::Scalar kElapsed = ir::Scalar::kI64;

class ChartBody : public BodyPhase {
 public:
  ChartBody(Lowering& body, const PouScope& scope, const Chart& chart)
      : BodyPhase(body, scope), chart_(chart), net_(sfc::resolve(chart)) {}
  void run();

 private:
  // --- state and flags (chart.cc)
  bool find_places();
  void describe_net();
  void number_flags();
  void report_all();
  ir::Place flag(uint32_t number) const;
  ir::ValueId is_raised(uint32_t number);
  void raise(uint32_t number);
  ir::Place part(VarId id, const char* member);
  void set_flag(const ir::Place& flag, bool value = true);
  void when(ir::ValueId condition, const std::function<void()>& then);
  void when(const ir::Place& flag, const std::function<void()>& then);

  // --- steps and transitions (chart_steps.cc)
  void read_clock();
  void pass_time(VarId variable, const char* member);
  void find_leaves();
  bool asks_only(ExprId condition, uint32_t step);
  bool moves_at_once(uint32_t number) const;
  void active_steps();
  void active_step(uint32_t step);
  void stored_times();
  void go_on_if(ir::ValueId condition, bool holds, ir::BlockId otherwise);
  void transition(uint32_t number);
  void fire(uint32_t number);
  void count_transition(uint32_t number);
  void count_steps();
  void leave(uint32_t number);
  void each_fired(const std::function<void(uint32_t)>& then);
  void moves();
  void enter_all(uint32_t number);
  void enter(uint32_t step);
  void starts();

  // --- actions (chart_actions.cc)
  void unused_actions();
  void action_statements(const ChartAction& action, ir::BlockId next);
  void step_uses();
  // Does one of the steps that use the action so hold `of` it? Invalid: none uses it so.
  ir::ValueId any_user(uint32_t action, ActionQualifier qualifier,
                       const std::function<ir::ValueId(uint32_t)>& of);
  ir::ValueId either(ir::ValueId a, ir::ValueId b);
  void add_to(const ir::Place& flag, ir::ValueId value);
  void request(uint32_t step, const sfc::Use& use);
  void begin(VarId record, const sfc::Use& use);
  void controls();
  ir::ValueId wants(uint32_t action, ir::ValueId keep);
  void control(uint32_t number);
  std::optional<Target> variable_of(const sfc::Action& action);
  ir::ValueId limit_of(const ActionUse& use);
  bool is_of_step(const sfc::Action& action) const;
  void bodies();
  void bodies(bool of_steps);
  bool uses(uint32_t action, ActionQualifier qualifier) const {
    return (qualifiers_[action] >> static_cast<uint32_t>(qualifier) & 1) != 0;
  }

  const Chart& chart_;
  sfc::Net net_;
  std::vector<VarId> steps_;  // variables of the steps and action records
  std::vector<VarId> actions_;
  VarId clock_;
  struct User {
    uint32_t step = 0;
    ActionQualifier qualifier = ActionQualifier::kN;
  };
  std::vector<std::vector<User>> users_;  // by action
  std::vector<uint16_t> qualifiers_;      // by action: bit 1 << ActionQualifier
  ir::ValueId elapsed_;                   // ns since the last call
  // By step: whether its transitions are tried where its time grows, as their conditions ask for
  // nothing that other steps have, cannot trap and call nothing.
  std::vector<bool> alone_;
  bool leaves_at_once_ = false;  // so are all conditions: none sees that a step was left

  std::vector<ir::ValueId> active_;  // by network: one of its steps is
  std::vector<ir::Place> fired_;     // a bit for each transition that waits
  std::vector<uint32_t> waiting_;    // transitions that enter their steps when all have been tried
  std::vector<uint32_t> bit_;        // by transition: its bit; kNone: it does not wait

  // What is known within one call: an array of BOOL in the frame, all FALSE when the call
  // begins. Numbers of its elements; kNone where nobody asks.
  ir::Place flags_;
  uint32_t flag_count_ = 0;
  using Numbers = std::vector<uint32_t>;
  Numbers spent_;    // by step that is not alone: a transition that leaves it has fired, of several
  Numbers entered_;  // by step
  Numbers left_;     // by step
  Numbers wanted_;   // by action: Q, with a final scan; of L, D, P
  std::vector<ir::ValueId> late_;  // by action: its statements run after those that end
  // Some action has its final scan, or runs by P0: one of steps themselves, another one.
  std::array<ir::ValueId, 2> early_;
};

}  // namespace frontend
