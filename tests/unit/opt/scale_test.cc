// Passes take time that is linear in the POU.
#include <gtest/gtest.h>

#include <string>

#include "ir/opt/optimise.h"
#include "ir/program/text.h"
#include "ir/program/verify.h"
#include "tests/growth.h"

namespace {

constexpr const char* kHeader =
    "program p\n"
    "type %25 = globals\n"
    "type Main = program\n"
    "  member local a : %27\n"
    "  member local x : DINT\n"
    "  member local b : BOOL\n"
    "type %27 = array DINT [0..99]\n"
    "globals %25\n"
    "task T period 10000000 priority 0\n"
    "instance Main : Main task 0\n"
    "pou program Main self Main\n"
    "  local temp t : DINT\n";

double seconds_for(const std::string& body) {
  base::Result<ir::Program> program = ir::parse_program(kHeader + body);
  EXPECT_TRUE(program.ok()) << base::to_string(program.error());
  EXPECT_TRUE(ir::verify(*program).ok());
  const double start = tests::processor_seconds();
  EXPECT_TRUE(ir::optimise(*program, ir::PassSet::all(), false).ok());
  const double seconds = tests::processor_seconds() - start;
  EXPECT_TRUE(ir::verify(*program).ok());
  return seconds;
}

std::string number(int i) { return std::to_string(i); }

std::string one_block(int instructions) {
  std::string body = "  b0:\n";
  for (int i = 0; i < instructions; i += 8) {
    std::string v[8];
    for (int k = 0; k < 8; ++k) v[k] = "v" + number(i + k);
    body += "    " + v[0] + " = load i32 self.x\n";
    body += "    " + v[1] + " = const i32 " + number(i) + "\n";
    body += "    " + v[2] + " = add i32 " + v[0] + ", " + v[1] + "\n";
    body += "    store i32 self.a[" + number(i / 8 % 100) + "], " + v[2] + "\n";
    body += "    " + v[3] + " = load i32 self.a[" + v[2] + "]\n";
    body += "    store i32 local.t, " + v[3] + "\n";
    body += "    " + v[4] + " = load i32 local.t\n";
    body += "    store i32 self.x, " + v[4] + "\n";
  }
  return body + "    return\n";
}

TEST(Optimise, V1_ABlockOf40000InstructionsIsQuick) {
  const auto seconds = [](int size) { return seconds_for(one_block(size)); };
  EXPECT_TRUE(tests::grows_linearly(seconds, 40'000));
}

std::string many_blocks(int steps) {  // of three blocks
  std::string body = "  b0:\n    jump b1\n";
  for (int i = 0; i < steps; ++i) {
    const int b = 3 * i + 1;
    const int v = 4 * i;
    body += "  b" + number(b) + ":\n    v" + number(v) + " = load i32 local.t\n    v" +
            number(v + 1) + " = const i32 " + number(i % 7) + "\n    v" + number(v + 2) +
            " = lt i32 v" + number(v) + ", v" + number(v + 1) + "\n    branch v" + number(v + 2) +
            ", b" + number(b + 1) + ", b" + number(b + 2) + "\n";
    body += "  b" + number(b + 1) + ":\n    store i32 local.t, v" + number(v + 1) + "\n    jump b" +
            number(b + 3) + "\n";
    // Every seventh step may go back to the first.
    body += "  b" + number(b + 2) + ":\n    v" + number(v + 3) +
            " = load bool self.b\n    branch v" + number(v + 3) + ", b" +
            number(i % 7 == 0 ? 1 : b + 3) + ", b" + number(b + 3) + "\n";
  }
  return body + "  b" + number(3 * steps + 1) + ":\n    return\n";
}

TEST(Optimise, V1_TenThousandBlocksAreQuick) {
  const auto seconds = [](int steps) { return seconds_for(many_blocks(steps)); };
  EXPECT_TRUE(tests::grows_linearly(seconds, 3'400));
}

// A jump to a jump to ... and back: nothing to do, and no end to it.
TEST(Optimise, V1_JumpsInACircleEnd) {
  seconds_for("  b0:\n    jump b1\n  b1:\n    jump b2\n  b2:\n    jump b1\n");
  seconds_for(
      "  b0:\n    v0 = const bool TRUE\n    jump b1(v0)\n"
      "  b1(v1:bool):\n    branch v1, b2, b3\n  b2:\n    jump b1(v0)\n  b3:\n    return\n");
}

TEST(Optimise, V1_NamesOfPassesAreReadAndWritten) {
  for (const ir::PassRow& row : ir::pass_rows()) {
    base::Result<ir::PassSet> set = ir::PassSet::parse(row.name);
    ASSERT_TRUE(set.ok());
    EXPECT_EQ(set->text(), row.name);
  }
  EXPECT_EQ(ir::PassSet::parse("fold,dead")->text(), "fold,dead");
  EXPECT_EQ(ir::PassSet::parse(ir::PassSet::all().text())->text(), ir::PassSet::all().text());
  EXPECT_TRUE(ir::PassSet::parse("none")->empty());
  EXPECT_FALSE(ir::PassSet::parse("").ok());
  EXPECT_FALSE(ir::PassSet::parse("fold,").ok());
  EXPECT_FALSE(ir::PassSet::parse("Fold").ok());
}

}  // namespace
