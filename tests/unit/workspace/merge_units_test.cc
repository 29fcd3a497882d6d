// Units that are not those of POUs (E-01): several POUs that a project joins, and actions of a
// PROGRAM as sections. An edit in one of them is checked, taken or refused as that unit.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ir/bytecode/symbols.h"
#include "linker/edit_steps.h"
#include "linker/merge.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

using ir::PartEdit;
using ir::PartKind;
using ir::PartState;

const ir::UnitMembers kPumping = {{"Logic", "Pumping"}, {"Pump", "Pumping"}};
const ir::UnitMembers kSections = {{"Main.Fill", "Filling"}};

struct District {
  std::string pump = "n := n + 1;";
  std::string logic = "m := m + 2;";
  std::string main = "pump1(); logic1(); Fill(); Drain();";
  std::string fill = "level := level + 1;";
  std::string drain = "level := level - 3;";

  std::string text() const {
    return "FUNCTION_BLOCK Pump VAR_OUTPUT n : INT; END_VAR " + pump +
           " END_FUNCTION_BLOCK\nFUNCTION_BLOCK Logic VAR_OUTPUT m : INT; END_VAR " + logic +
           " END_FUNCTION_BLOCK\nPROGRAM Main VAR pump1 : Pump; logic1 : Logic; level : INT; "
           "END_VAR " +
           main + "\nACTION Fill: " + fill + " END_ACTION\nACTION Drain: " + drain +
           " END_ACTION\nEND_PROGRAM\n";
  }
};

ir::Image district_image(const District& district, const ir::UnitMembers& members) {
  workspace::Settings settings;
  settings.link.unit_members = members;
  const test::Outcome built = test::build_from_nothing(test::one_file(district.text()), settings);
  EXPECT_TRUE(built.image.has_value());
  return built.image ? std::move(*ir::decode(*built.image)) : ir::Image();
}

const PartEdit* unit_row(const std::vector<PartEdit>& rows, const std::string& name) {
  for (const PartEdit& row : rows) {
    if (row.kind == PartKind::kUnit && row.name == name) return &row;
  }
  return nullptr;
}

const ir::LinkedPou* linked_pou(const ir::Image& image, const std::string& name) {
  for (const ir::LinkedPou& pou : image.pous) {
    if (pou.name == name) return &pou;
  }
  return nullptr;
}

// Nobody has touched Logic, and the other plant's is another one: Pump goes with its own alone.
TEST(Units, E01_JoinedPousAreCheckedAndGoAsOne) {
  const District district;
  District next = district;
  next.pump += " n := n + 10;";
  const ir::Image original = district_image(district, {});
  const ir::Image edited = district_image(next, kPumping);
  const std::vector<PartEdit> there = linker::merge_parts({original, edited, original});
  ASSERT_NE(unit_row(there, "Pumping"), nullptr);
  EXPECT_EQ(unit_row(there, "Pumping")->state, PartState::kOk);
  EXPECT_EQ(unit_row(there, "Pump"), nullptr) << "it is part of its unit";

  District other = district;
  other.logic = "m := m + 200;";
  const ir::Image second = district_image(other, {});
  EXPECT_EQ(unit_row(linker::merge_parts({original, edited, second}), "Pumping")->state,
            PartState::kDifferent);
  const base::Result<ir::Image> refused = linker::merge({original, edited, second}, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kOtherPart);
  EXPECT_NE(refused.error().text.find("unit `Pumping` is another one here"), std::string::npos)
      << refused.error().text;

  // Where Logic is a POU like others, that plant takes the edit.
  EXPECT_TRUE(linker::merge({original, district_image(next, {}), second}, {}).ok());
}

// The next edit finds the units that the last one brought.
TEST(Units, E01_UnitsTravelWithTheEdit) {
  const District district;
  District next = district;
  next.pump += " n := n + 10;";
  const ir::Image original = district_image(district, {});
  District other = district;
  other.drain = "level := level - 30;";
  const ir::Image target = district_image(other, kSections);
  const base::Result<ir::Image> merged =
      linker::merge({original, district_image(next, kPumping), target}, {});
  ASSERT_TRUE(merged.ok()) << base::to_string(merged.error());
  const ir::UnitMembers both = {
      {"Logic", "Pumping"}, {"Main.Fill", "Filling"}, {"Pump", "Pumping"}};
  EXPECT_EQ(merged->unit_members, both);
  const std::vector<ir::Part> parts = ir::parts_of(*merged);
  EXPECT_NE(ir::find_part(parts, PartKind::kUnit, "pumping"), nullptr);
  EXPECT_NE(ir::find_part(parts, PartKind::kUnit, "Filling"), nullptr);
  EXPECT_EQ(ir::find_part(parts, PartKind::kUnit, "Pump"), nullptr);
}

// A section is edited; the rest of the PROGRAM is another one there, and stays byte for byte.
TEST(Units, E01_ASectionOfAProgramIsAUnitByItself) {
  const District district;
  District next = district;
  next.fill = "level := level + 7;";
  const ir::Image original = district_image(district, {});
  const ir::Image edited = district_image(next, kSections);
  District other = district;
  other.drain = "level := level - 33;";
  const ir::Image target = district_image(other, {});

  const base::Result<ir::Image> whole =
      linker::merge({original, district_image(next, {}), target}, {});
  ASSERT_FALSE(whole.ok()) << "as one unit it is another one there";
  EXPECT_EQ(whole.error().refusal, base::Refusal::kOtherPart);

  const std::vector<PartEdit> rows = linker::merge_parts({original, edited, target});
  ASSERT_NE(unit_row(rows, "Filling"), nullptr);
  EXPECT_EQ(unit_row(rows, "Filling")->state, PartState::kOk);
  EXPECT_EQ(unit_row(rows, "Main"), nullptr);
  const base::Result<ir::Image> merged = linker::merge({original, edited, target}, {});
  ASSERT_TRUE(merged.ok()) << base::to_string(merged.error());
  for (const char* const name : {"Main", "Main.Drain", "Pump"}) {
    ASSERT_NE(linked_pou(*merged, name), nullptr) << name;
    EXPECT_EQ(linked_pou(*merged, name)->identity, linked_pou(target, name)->identity) << name;
  }
  EXPECT_EQ(linked_pou(*merged, "Main.Fill")->identity, linked_pou(edited, "Main.Fill")->identity);
}

// The steps of an edit are its units (E-25): joined POUs arrive with all their variables.
TEST(Units, E01_E25_AStepIsAUnit) {
  const District district;
  District next = district;
  next.pump = "n := n + 1;";
  next.logic = "m := m + 5;";
  next.fill = "level := level + 2;";
  ir::UnitMembers members = kPumping;
  members.insert(members.begin() + 1, kSections.front());
  const ir::Image original = district_image(district, {});
  const ir::Image edited = district_image(next, members);
  const base::Result<std::vector<std::string>> steps =
      linker::edit_steps({original, edited}, linker::StepOrder::kTableFirst);
  ASSERT_TRUE(steps.ok());
  EXPECT_EQ(*steps, (std::vector<std::string>{"Pumping", "Filling"}));
  const std::vector<PartEdit> parts = linker::merge_parts({original, edited, original});
  EXPECT_EQ(ir::of_step(parts, "Pumping", members).size(), 1u);

  next.pump = "n := n + 1; k := k + 1;";
  std::string text = next.text();
  text.insert(text.find("n : INT;"), "k : INT; ");
  workspace::Settings settings;
  settings.link.unit_members = members;
  const test::Outcome built = test::build_from_nothing(test::one_file(text), settings);
  ASSERT_TRUE(built.image.has_value());
  const ir::Image wider = std::move(*ir::decode(*built.image));
  const std::vector<PartEdit> with_variables =
      ir::of_step(linker::merge_parts({original, wider, original}), "Pumping", members);
  ASSERT_EQ(with_variables.size(), 2u) << "the unit, and the variables of Pump";
  EXPECT_EQ(with_variables[1].kind, PartKind::kBlock);
  EXPECT_EQ(with_variables[1].name, "Pump");
}

}  // namespace
