// Which types a change edits (D3: what an edit is of).
#include "online_change/plan/type_edits.h"

#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string type_edits_between(const std::string& before, const std::string& after) {
  const std::string main = "PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\n";
  Plant plant(before + main);
  auto package = decode(plant.package(after + main));
  base::check(package.ok(), "a package of a plant");
  const ir::VerifiedImage& old_version = plant.controller().verified();
  const ir::Image new_image = *ir::decode(package->image);
  std::string out;
  for (const TypeEdit& edit :
       type_edits({old_version.image(), old_version.encoded()}, {new_image, package->image})) {
    out += edit.type + " " + type_change_name(edit.change) + ";";
  }
  return out;
}

std::string with_box(const std::string& types) {
  return types + "VAR_GLOBAL box : Box; END_VAR\n";
}
std::string box_type(const std::string& members) {
  return "TYPE Box : STRUCT " + members + " END_STRUCT END_TYPE\n";
}

TEST(TypeEdits, D3_AMemberThatIsAddedRetypedOrMoved) {
  const std::string before = with_box(box_type("a : INT; b : DINT;"));
  EXPECT_EQ(type_edits_between(before, before), "");
  EXPECT_EQ(type_edits_between(before, with_box(box_type("a : INT; b : DINT; c : BOOL;"))),
            "Box edited;");
  EXPECT_EQ(type_edits_between(before, with_box(box_type("a : INT; b : LINT;"))), "Box edited;");
  EXPECT_EQ(type_edits_between(before, with_box(box_type("b : DINT; a : INT;"))), "Box edited;");
}

TEST(TypeEdits, D3_WhatHoldsAnEditedTypeIsNotEditedItself) {
  const auto both = [](const std::string& inner) {
    return with_box("TYPE Inner : STRUCT " + inner + " END_STRUCT END_TYPE\n" +
                    box_type("i : Inner;"));
  };
  EXPECT_EQ(type_edits_between(both("x : INT;"), both("x : INT; y : INT;")), "Inner edited;");
}

TEST(TypeEdits, D3_EnumerationsAndTypesThatComeAndGo) {
  const auto with = [](const std::string& literals) {
    return "TYPE Colour : (" + literals + "); END_TYPE\nVAR_GLOBAL c : Colour; END_VAR\n";
  };
  EXPECT_EQ(type_edits_between(with("red, green"), with("red, blue, green")), "Colour edited;");
  EXPECT_EQ(type_edits_between("VAR_GLOBAL box : INT; END_VAR\n", with_box(box_type("a : INT;"))),
            "Box added;");
  EXPECT_EQ(type_edits_between(with_box(box_type("a : INT;")), "VAR_GLOBAL box : INT; END_VAR\n"),
            "Box removed;");
}

}  // namespace
}  // namespace online_change
