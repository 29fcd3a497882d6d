// One change whose pause is measured: a program of many variables, some of which change their type.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "online_change/apply/change.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/io.h"

namespace bench {

struct Shape {
  uint32_t variables = 0;  // INT, each with a name of its own
  uint32_t changed = 0;    // of them, evenly spread: INT -> DINT
  uint32_t instances = 0;  // of a function block of ten variables, which gains one in its slack
};

struct PauseCase {
  base::Bytes image;
  base::Bytes package;
  uint64_t steps = 0;  // of the plan
  uint64_t boundary_bytes = 0;
  int64_t predicted_ns = 0;  // in place
};

// Ends the process with a message when the compiler or the linker refuses.
PauseCase make_case(const Shape& shape);

// A controller that runs a case's image, as often as needed.
class PauseRig {
 public:
  explicit PauseRig(const PauseCase& one);
  // Everything before the switch; one scan runs behind it.
  void prepare(online_change::Strategy strategy);
  int64_t make_switch();  // its pause
  void undo();
  int64_t predicted_ns() const { return change_.predicted_pause_ns(); }
  vm::Controller& controller() { return *controller_; }

 private:
  const PauseCase& case_;
  vm::VirtualClock clock_;
  vm::NullIo io_;
  std::unique_ptr<vm::Controller> controller_;
  online_change::Change change_;
};

}  // namespace bench
