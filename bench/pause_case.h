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
  // More variables, all of which change:
  uint32_t retyped = 0;     // instances of a function block with a member INT -> DINT
  uint32_t elements = 0;    // of an array of INT -> REAL
  uint32_t strings = 0;     // STRING[20] -> STRING[30], of 16 characters
  uint32_t modes = 0;       // an enumeration whose literals get other values
  uint32_t references = 0;  // to variables that move
  uint32_t rewritten = 0;   // pages that every scan writes to; no change
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
  int64_t make_switch();  // its pause; with a deadline, as a controller does it
  void undo();
  int64_t predicted_ns() const { return change_.predicted_pause_ns(); }
  vm::Controller& controller() { return *controller_; }

 private:
  const PauseCase& case_;
  vm::VirtualClock clock_;
  vm::RealClock real_;  // of the deadline that a switch looks at, and of this machine's pace
  vm::NullIo io_;
  std::unique_ptr<vm::Controller> controller_;
  online_change::Change change_;
};

}  // namespace bench
