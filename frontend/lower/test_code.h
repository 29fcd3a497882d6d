// Phase: assertions and the other calls of tests (test_call.cc). It reads facts and what a build
// for tests has added (Tests), reports wrong arguments, and writes code that puts a message
// together and traps.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frontend/lower/body_phase.h"

namespace frontend {

class TestCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void test_call(const Expr& call, const TestCallRow& row);

 private:
  using Pieces = std::vector<ir::Place>;  // texts, one behind the other

  void assert_relation(TestCall call, const std::vector<ExprId>& args, ExprId message);
  void assert_near(const std::vector<ExprId>& args, ExprId message);
  bool is_message(ExprId message);  // reports, as the next one does
  bool is_time_ahead(ExprId duration);
  void advance_time(ExprId duration);
  void verify_calls(const std::vector<ExprId>& args, bool exact, ExprId message);
  void fail_unless(ir::ValueId holds, ExprId message, const std::function<ir::Place()>& what);
  ir::Place constant_text(std::string text);
  // Structures and arrays (test_parts.cc).
  void assert_parts(TestCall call, const std::vector<ExprId>& args, ir::TypeId type,
                    ExprId message);
  Pieces way_to(const ir::Place& leaf, const ir::Place& whole);
  ir::Place difference(const char* wanted, const Pieces& expected, const Pieces& actual);
  Pieces literal_of(Typed value);
  Pieces literal_of(const ir::Place& text);
  Pieces marked(char sort, const ir::Place& text);
  ir::Place text_of(Typed value);
  ir::Place joined(const ir::Place& first, const ir::Place& second);
};

}  // namespace frontend
