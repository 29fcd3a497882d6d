// Phase: arguments of POUs, methods and blocks: which goes to which parameter (arguments.cc), and
// how they get there and back (pass_arguments.cc). It reads the callee's declaration, reports what
// does not fit, and writes the code that evaluates and passes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "frontend/lower/body_phase.h"

namespace frontend {

// One argument of a call on its way from expression to parameter.
struct Binding {
  VarId variable;
  const Arg* arg;
  ir::ValueId value;               // input: scalar; in-out: address
  std::optional<ir::Place> place;  // input: string or aggregate
  std::optional<Target> target;    // output
};

std::string quoted_name(const Name& name);

class Arguments : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  bool bind_arguments(const Expr& call, const PouInfo& callee, std::vector<Binding>& bindings);
  bool bind_named(const Arg& arg, const PouInfo& callee, std::vector<Binding>& bindings);
  bool check_in_outs(const Expr& call, const PouInfo& callee, const std::vector<Binding>& bindings);
  bool check_given(const Expr& call, const PouInfo& callee, const std::vector<Binding>& bindings);
  void evaluate_arguments(const Expr& call, std::vector<Binding>& bindings);
  void pass_input(const Binding& binding, const ir::Place& parameter);
  void pass_defaults(const PouInfo& callee, const std::vector<Binding>& bindings);
  void pass_initial_inputs(const PouInfo& block, const std::vector<Binding>& bindings,
                           const std::function<ir::Place(const Variable&)>& place_of);
  void take_outputs(std::vector<Binding>& bindings,
                    const std::function<ir::Place(const Variable&)>& place_of);
  ir::Place argument_place(const PouInfo& callee, const Variable& variable) const;
  // Says that this code has a value of the callee's unit.
  void hold(const PouInfo& callee);

 private:
  bool is_given(VarId parameter, const std::vector<Binding>& bindings) const;
  void pass_default(const PouInfo& callee, const Variable& variable, const ir::Place& parameter);
  bool bind_positional(const Expr& call, uint32_t count, const PouInfo& callee,
                       std::vector<Binding>& bindings);
  void evaluate_input(Binding& binding, bool keep);
  bool evaluate_in_out(Binding& binding);
  void evaluate_any(Binding& binding);
  bool evaluate_open_array(Binding& binding, const OpenArray& open);
  bool evaluate_read_only(Binding& binding);
  bool may_call(ExprId expr);
};

}  // namespace frontend
