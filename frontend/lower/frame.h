// Phase: what a body does around its statements: variables that begin anew at each call (frame.cc),
// edges of inputs (edge_input.cc), and connections of a program instance (connection.cc).
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class Frame : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void initialise_locals();
  void detect_edges();
  void connect_inputs();
  void connect_outputs();

 private:
  void make_instance(VarId id);
  void initialise(const ir::Place& where, const Variable& variable);
  void connect_input(const Target& input, const Arg& arg);
  void connect_output(const Variable& output, const Arg& arg);
};

}  // namespace frontend
