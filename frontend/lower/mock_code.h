// Phase: mocks, which tests put in the place of functions and of function block bodies (mock.cc).
// It reads the slots that a build for tests has added (MockSlots), and writes the code that looks
// there.
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"

namespace frontend {

class MockCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  std::optional<ir::Place> mock_slot(ExprId target, uint32_t MockSlots::*slot);
  void mock_statement(const Stmt& stmt);
  void mock_prologue();
  void activate_mock_bodies();

 private:
  void forward_to_mock(const PouInfo& mock);
};

}  // namespace frontend
