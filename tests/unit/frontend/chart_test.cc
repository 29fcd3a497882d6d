// Sequential function charts of a size that golden files cannot show. What they mean is in
// tests/golden/sfc.
#include <gtest/gtest.h>

#include "tests/growth.h"
#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

std::string steps(uint32_t count) {
  std::string text = "INITIAL_STEP S0: END_STEP\n";
  for (uint32_t i = 1; i < count; ++i) {
    std::string number = std::to_string(i);
    text += "STEP S" + number + ": A" + number + "(N); END_STEP\n";
    text += "ACTION A" + number + ": n := n + 1; END_ACTION\n";
  }
  return text;
}

std::string transition(const std::string& from, const std::string& to) {
  return "TRANSITION FROM " + from + " TO " + to + " := go; END_TRANSITION\n";
}

std::string step(uint32_t number) { return "S" + std::to_string(number); }

std::string program(const std::string& body) {
  return "PROGRAM P VAR go : BOOL := TRUE; n : DINT; END_VAR\n" + body + "END_PROGRAM\n";
}

double seconds_for(const std::string& body) {
  const double begin = tests::processor_seconds();
  EXPECT_EQ(compile(program(body)).text, "");
  return tests::processor_seconds() - begin;
}

std::string row(int count) {
  std::string body = steps(count);
  for (int i = 0; i < count; ++i) body += transition(step(i), step((i + 1) % count));
  return body;
}

// Each action runs twice: once while its step is active, once in its final scan.
TEST(Charts, ThousandStepsInARow) {
  EXPECT_TRUE(tests::grows_linearly([](int count) { return seconds_for(row(count)); }, 1000));
  Controlled run(program(row(1000)));
  EXPECT_EQ(run.scan(100), "");
  EXPECT_EQ(run.number("P.S99.X"), 1);
  EXPECT_EQ(run.number("P.n"), 2 * 98 + 1);
}

std::string alternatives(int count) {
  std::string body = steps(count);
  for (int i = 1; i < count; ++i) body += transition("S0", step(i));
  for (int i = 1; i < count; ++i) body += transition(step(i), "S0");
  return body;
}

TEST(Charts, ThousandAlternatives) {
  const auto seconds = [](int count) { return seconds_for(alternatives(count)); };
  EXPECT_TRUE(tests::grows_linearly(seconds, 1000));
  Controlled run(program(alternatives(1000)));
  EXPECT_EQ(run.scan(2), "");
  EXPECT_EQ(run.number("P.S1.X"), 1);
  EXPECT_EQ(run.number("P.S2.X"), 0);
}

// Forty branches of three steps have 3^40 situations: they are not all played through, and
// nothing is said that is not known.
TEST(Charts, ManySimultaneousBranches) {
  constexpr uint32_t kBranches = 40;
  std::string body = steps(3 * kBranches + 1);
  std::string begins;
  std::string ends;
  for (uint32_t i = 0; i < kBranches; ++i) {
    uint32_t first = 3 * i + 1;
    begins += (i == 0 ? "(" : ", ") + step(first);
    ends += (i == 0 ? "(" : ", ") + step(first + 2);
    body += transition(step(first), step(first + 1)) + transition(step(first + 1), step(first + 2));
  }
  body += transition("S0", begins + ")") + transition(ends + ")", "S0");
  EXPECT_EQ(compile(program(body)).text, "");
  Controlled run(program(body));
  EXPECT_EQ(run.scan(5), "");
  EXPECT_EQ(run.number("P.S0.X"), 1);
  Compiled lost = compile(program(body + "STEP Lost: END_STEP " + transition("Lost", "S0")));
  EXPECT_NE(lost.text.find("`Lost` is never entered"), std::string::npos) << lost.text;
}

// The same with branches that nothing joins: places are taken twice, and it still ends.
TEST(Charts, BranchesThatMultiply) {
  constexpr uint32_t kSteps = 60;
  std::string body = steps(kSteps);
  for (uint32_t i = 0; i < kSteps; ++i) {
    body += transition(step(i), "(" + step((i + 1) % kSteps) + ", " + step((i + 7) % kSteps) + ")");
  }
  EXPECT_EQ(compile(program(body)).warnings(), "W0032");
}

}  // namespace
}  // namespace frontend_test
