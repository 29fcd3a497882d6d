// C3: the commands of a change are derived from the layout of the program that runs, whatever it
// has been before, and from the one of the next: for what is added or retyped, and for nothing
// else.
#include <initializer_list>
#include <map>

#include "ir/bytecode/symbols.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string with_variables(const std::string& variables) {
  return "FUNCTION_BLOCK Motor VAR hours : DINT; speed : INT := 5; END_VAR hours := hours + 1; "
         "END_FUNCTION_BLOCK PROGRAM Main VAR m : ARRAY[1..3] OF Motor; " +
         variables + " END_VAR m[2](); last := last + 1; END_PROGRAM";
}

// Which variable of `image` lies at each byte; "" where none does.
std::map<uint32_t, std::string> owners(const ir::Image& image,
                                       std::initializer_list<const char*> paths) {
  std::map<uint32_t, std::string> out;
  for (const char* const path : paths) {
    const auto symbol = ir::find_symbol(image, path);
    EXPECT_TRUE(symbol.ok()) << path;
    if (!symbol.ok()) continue;
    const uint32_t size = image.layouts[symbol->type].size;
    for (uint32_t i = 0; i < size; ++i) out[symbol->data + i] = path;
  }
  return out;
}

TEST(Commands, C3_what_is_added_or_retyped_has_one_and_nothing_else_has) {
  const std::string first = with_variables(
      "kept : ARRAY[0..99] OF INT; wide : INT := 7; gone : LREAL; name : STRING[20]; last : DINT;");
  const std::string second = with_variables(
      "kept : ARRAY[0..99] OF INT; wide : DINT; added : STRING[9] := 'new'; name : STRING[20]; "
      "last : DINT;");
  // What has been there before has left another layout than a first start gives.
  Plant plant(with_variables("before : ARRAY[0..9] OF LINT; last : DINT;"));
  plant.run(1);
  plant.change(first, true);
  plant.accept();
  plant.run(1);
  const ir::Image running = plant.controller().image();
  Plant anew(first);
  const uint32_t wide = ir::find_symbol(running, "Main.wide")->data;
  ASSERT_NE(wide, ir::find_symbol(anew.controller().image(), "Main.wide")->data);

  plant.set("Main.wide", "-300");
  plant.set("Main.kept[50]", "4");
  plant.change(second, true);
  const auto at = owners(plant.controller().image(), {"Main.wide", "Main.added"});
  std::map<std::string, uint32_t> bytes;
  for (const UpdateStep& step : plant.plan().steps) {
    for (uint32_t i = 0; i < step.count; ++i) {
      for (uint32_t b = 0; b < step.size; ++b) {
        const auto owner = at.find(step.place(i) + b);
        ASSERT_NE(owner, at.end()) << "a command for what is unchanged or removed";
        ++bytes[owner->second];
      }
    }
    const auto* converted = step.as<ConvertedValues>();
    EXPECT_EQ(step.source().has_value(), converted != nullptr);
    if (converted != nullptr) {
      EXPECT_EQ(converted->from, wide);
    }
  }
  EXPECT_EQ(bytes.size(), 2u);
  EXPECT_EQ(bytes["Main.wide"], 4u);
  EXPECT_EQ(plant.get("Main.wide"), "-300");
  EXPECT_EQ(plant.get("Main.added"), "'new'");
  EXPECT_EQ(plant.get("Main.kept[50]"), "4");
  EXPECT_EQ(plant.get("Main.last"), "2");
}

}  // namespace
}  // namespace online_change
