// Outputs that nobody writes any more, found where only the POUs that are others are looked at, and
// where all code is.
#include "vm/load/left_outputs.h"

#include <gtest/gtest.h>

#include "online_change/package/package.h"
#include "tests/unit/online_change/plant.h"
#include "vm/load/same_code.h"

namespace {

using plant::Plant;

// `filler`: POUs that stay, so that those which are others are few.
std::string source(const std::string& main, const std::string& setter = "x := TRUE;",
                   const std::string& by_reference = "r^ := 3;",
                   const std::string& taker = "r := REF(level);") {
  std::string filler;
  for (int i = 0; i < 20; ++i) {
    filler += "FUNCTION F" + std::to_string(i) + " : INT VAR_INPUT a : INT; END_VAR F" +
              std::to_string(i) + " := a; END_FUNCTION\n";
  }
  return "VAR_GLOBAL lamp AT %QX0.0 : BOOL; bound AT %QX0.1 : BOOL; level AT %QW2 : INT; "
         "row AT %QB8 : ARRAY[0..3] OF BYTE; r : REF_TO INT; n : INT; END_VAR\n" +
         filler + "FUNCTION_BLOCK Setter VAR_IN_OUT x : BOOL; END_VAR " + setter +
         " END_FUNCTION_BLOCK\nFUNCTION_BLOCK Store VAR k : INT; END_VAR k := 1; " + by_reference +
         " END_FUNCTION_BLOCK\nFUNCTION_BLOCK Taker VAR k : INT; END_VAR k := 1; " + taker +
         " END_FUNCTION_BLOCK\nFUNCTION_BLOCK Other VAR k : INT; END_VAR k := 1; row[1] := 4; "
         "END_FUNCTION_BLOCK\n"
         "PROGRAM Main VAR s : Setter; b : Store; t : Taker; o : Other; END_VAR n := n + 1; " +
         main + " END_PROGRAM";
}
const std::string kAll = "lamp := TRUE; s(x := bound); b(); t(); o(); row[0] := 1; row[1] := 2;";

std::string names(const std::vector<vm::LeftOutput>& outputs) {
  std::string text;
  for (const vm::LeftOutput& output : outputs) text += (text.empty() ? "" : " ") + output.path;
  return text;
}

// The names that are left; "differ" when a look at all code finds others.
std::string left(const std::string& before, const std::string& after) {
  Plant plant(before);
  const base::Bytes bytes = plant.package(after);
  const auto package = online_change::decode(bytes, plant.controller().verified().encoded());
  if (!package.ok()) return base::to_string(package.error());
  const auto next = ir::verify(package->image);
  if (!next.ok()) return base::to_string(next.error());
  const ir::Image& old_image = plant.controller().image();
  EXPECT_TRUE(vm::have_same_places(old_image, next->image()));
  // Tables of their own, so nothing is known to be the same.
  const ir::Image apart = *ir::decode(package->image);
  EXPECT_FALSE(vm::have_same_places(old_image, apart));
  const vm::RunningCode running{old_image, plant.controller().verified().running_pous()};
  const std::string few = names(vm::left_outputs(running, {next->image(), next->running_pous()}));
  const std::string all = names(vm::left_outputs(running, {apart, next->running_pous()}));
  return few == all ? few : "differ";
}

TEST(LeftOutputs, case67_an_edit_that_writes_what_it_wrote_leaves_none) {
  EXPECT_EQ(left(source(kAll), source(kAll + " n := n * 3;")), "");
  EXPECT_EQ(left(source(kAll), source(kAll, "x := NOT x;")), "");
  EXPECT_EQ(left(source("n := 7;"), source("n := 8;")), "");
}

TEST(LeftOutputs, case67_what_one_writer_leaves_another_one_may_still_write) {
  const std::string without = "s(x := bound); b(); t(); o(); row[0] := 1; row[1] := 2;";
  EXPECT_EQ(left(source(kAll), source(without)), "lamp");
  const std::string part = "lamp := TRUE; s(x := bound); b(); t(); o(); row[0] := 1;";
  EXPECT_EQ(left(source(kAll), source(part)), "");  // Other writes row[1]
  const std::string none = "lamp := TRUE; s(x := bound); b(); t(); o(); row[1] := 2;";
  EXPECT_EQ(left(source(kAll), source(none)), "row[0]");
  EXPECT_EQ(left(source(none), source(kAll)), "");
}

TEST(LeftOutputs, case67_writers_by_address_need_both_who_gives_it_and_who_stores) {
  const std::string ungiven = "lamp := TRUE; b(); t(); o(); row[0] := 1; row[1] := 2;";
  EXPECT_EQ(left(source(kAll), source(ungiven)), "bound");
  EXPECT_EQ(left(source(kAll), source(kAll, "IF x THEN n := 4; END_IF;")), "bound");
  EXPECT_EQ(left(source(kAll), source(kAll, "x := TRUE;", "n := r^;")), "level");
  EXPECT_EQ(left(source(kAll), source(kAll, "x := TRUE;", "r^ := 3;", "r := REF(n);")), "level");
  EXPECT_EQ(left(source(kAll, "x := TRUE;", "n := r^;"), source(kAll)), "");
}

}  // namespace
