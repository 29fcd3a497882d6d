// Every pair of elementary types and strings: the conversion exists and runs on every
// default value, or is refused with one message.
#include <gtest/gtest.h>

#include "frontend/sema/types/conversion.h"
#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

std::vector<ir::Kind> kinds() {
  std::vector<ir::Kind> out;
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) out.push_back(static_cast<ir::Kind>(i));
  out.push_back(ir::Kind::kString);
  out.push_back(ir::Kind::kWstring);
  return out;
}

std::string name_of(ir::Kind kind) {
  if (kind == ir::Kind::kString) return "STRING";
  if (kind == ir::Kind::kWstring) return "WSTRING";
  return std::string(ir::elementary_name(kind));
}

TEST(Conversions, EveryPairThatExistsRuns) {
  std::string vars;
  std::string body;
  uint32_t pairs = 0;
  for (ir::Kind from : kinds()) {
    vars += "v" + name_of(from) + ", r" + name_of(from) + " : " + name_of(from) + ";\n";
    for (ir::Kind to : kinds()) {
      if (!frontend::is_convertible(from, to)) continue;
      ++pairs;
      const std::string argument = "(v" + name_of(from) + ");\n";
      body += "r" + name_of(to) + " := " + name_of(from) + "_TO_" + name_of(to) + argument;
      body += "r" + name_of(to) + " := TO_" + name_of(to) + argument;
    }
  }
  EXPECT_GT(pairs, 600u);
  Controlled program(vars, body);
  EXPECT_EQ(program.problem(), "");
  EXPECT_EQ(program.scan(2), "");
}

TEST(Conversions, EveryPairThatDoesNotExistIsRefused) {
  uint32_t pairs = 0;
  for (ir::Kind from : kinds()) {
    for (ir::Kind to : kinds()) {
      if (frontend::is_convertible(from, to)) continue;
      ++pairs;
      const std::string vars = "a : " + name_of(from) + "; b : " + name_of(to) + "; ";
      for (const std::string& name : {name_of(from) + "_TO_", std::string("TO_")}) {
        const std::string body = "b := " + name + name_of(to) + "(a);";
        EXPECT_EQ(compile("PROGRAM P VAR " + vars + "END_VAR " + body + " END_PROGRAM").errors(),
                  "E4060")
            << name << name_of(to);
      }
    }
  }
  EXPECT_GT(pairs, 40u);
}

}  // namespace
}  // namespace frontend_test
