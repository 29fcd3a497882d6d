// What the last requests asked for is kept (vm/runtime/asked_values.h).
#include "vm/runtime/asked_values.h"

#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"

namespace plc {
namespace {

std::string source_with(const std::string& first) {
  return "PROGRAM Main VAR " + first + " a, b : DINT; c : INT; END_VAR a := b; END_PROGRAM";
}

uint32_t place_of(const ir::VerifiedImage& version, const std::string& path) {
  return ir::find_symbol(version.image(), path)->data;
}

TEST(AskedValues, AreThoseOfTheNamesInTheirOrder) {
  const ir::VerifiedImage version = build(source_with(""));
  vm::AskedValues asked;
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"Main.a", "Main.c"},
                                             {"Main.c", "Main.a"},
                                             {"Main.a"},
                                             {"Main.b"},
                                             {"Main.c"},
                                             {},
                                             {"Main.a", "Main.c"},
                                             {"main.A", "Main.c"}}) {
    for (int times = 0; times < 2; ++times) {
      const auto request = asked.find(version, names);
      ASSERT_TRUE(request.ok());
      ASSERT_EQ((*request)->variables.size(), names.size());
      for (size_t i = 0; i < names.size(); ++i) {
        const auto& variable = (*request)->variables[i];
        EXPECT_EQ(variable.named.path, names[i]);
        EXPECT_EQ(variable.named.symbol.data, place_of(version, names[i]));
        EXPECT_EQ(variable.type, names[i] == "Main.c" ? "INT" : "DINT");
      }
    }
  }
}

TEST(AskedValues, AreLookedUpAnewInAnotherVersion) {
  const ir::VerifiedImage first = build(source_with(""));
  const ir::VerifiedImage second = build(source_with("row : ARRAY[1..9] OF LINT;"));
  ASSERT_NE(place_of(first, "Main.c"), place_of(second, "Main.c"));
  vm::AskedValues asked;
  for (const ir::VerifiedImage& version : {first, second, first}) {
    const auto request = asked.find(version, {"Main.c"});
    ASSERT_TRUE(request.ok());
    EXPECT_EQ((*request)->variables[0].named.symbol.data, place_of(version, "Main.c"));
    EXPECT_FALSE(asked.find(version, {"Main.d"}).ok());
  }
}

// Those of several requests are there at once, and come again.
TEST(AskedValues, AreKeptForTheLastRequests) {
  const ir::VerifiedImage version = build(source_with(""));
  vm::AskedValues asked;
  const auto variables_of = [&](const std::string& name) {
    return (*asked.find(version, {name}))->variables.data();
  };
  const auto* const a = variables_of("Main.a");
  const auto* const b = variables_of("Main.b");
  const auto* const c = variables_of("Main.c");
  EXPECT_TRUE(a != b && b != c && c != a);
  EXPECT_EQ(variables_of("Main.c"), c);
  EXPECT_EQ(variables_of("Main.b"), b);
  EXPECT_EQ(variables_of("Main.a"), a);
}

}  // namespace
}  // namespace plc
