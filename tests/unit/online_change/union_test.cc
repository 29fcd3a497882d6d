// Case 74: unions that gain or lose members keep their bytes.
#include "online_change/package/package.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

std::string with_union(const std::string& members) {
  return "TYPE U : UNION " + members + " END_UNION END_TYPE PROGRAM Main VAR u : U; END_VAR "
         "END_PROGRAM";
}

const std::string kSmall = with_union("w : WORD;");
const std::string kLarge = with_union("w : WORD; l : ARRAY[0..3] OF WORD;");

Package package_of(Plant& plant) {
  base::Result<Package> package = decode(plant.package(kLarge));
  EXPECT_TRUE(package.ok());
  return std::move(*package);
}

TEST(Unions, V17_case74_a_grown_union_begins_with_its_old_bytes) {
  Plant plant(kSmall);
  plant.set("Main.u.w", "16#1234");
  plant.change(kLarge);
  EXPECT_EQ(plant.get("Main.u.l"), "[16#1234, 16#0000, 16#0000, 16#0000]");
  plant.set("Main.u.l[3]", "16#77");
  plant.set("Main.u.w", "16#4321");
  plant.undo();
  EXPECT_EQ(plant.get("Main.u.w"), "16#4321");
}

TEST(Unions, V17_case74_a_grown_union_with_other_bytes_behind_is_refused) {
  Plant plant(kSmall);
  Package package = package_of(plant);
  bool found = false;
  for (UpdateStep& step : package.forward.steps) {
    auto* const initial = step.as<InitialValues>();
    if (initial == nullptr) continue;
    initial->bytes.assign(step.total(), 0x55);
    found = true;
  }
  ASSERT_TRUE(found);
  base::Status staged = plant.stage(encode(package));
  ASSERT_FALSE(staged.ok());
  EXPECT_NE(staged.error().text.find("is written in part only"), std::string::npos)
      << staged.error().text;
}

TEST(Unions, V17_case74_a_grown_union_without_bytes_behind_is_refused) {
  Plant plant(kSmall);
  Package package = package_of(plant);
  std::erase_if(package.forward.steps,
                [](const UpdateStep& step) { return step.as<InitialValues>() != nullptr; });
  EXPECT_FALSE(plant.stage(encode(package)).ok());
}

// What shrinks keeps what fits, and undo brings the rest back.
TEST(Unions, X4_case74_undo_brings_back_what_a_smaller_union_has_no_room_for) {
  Plant plant(kLarge);
  for (int i = 0; i < 4; ++i) {
    plant.set("Main.u.l[" + std::to_string(i) + "]", std::to_string(i + 1));
  }
  plant.change(kSmall);
  EXPECT_EQ(plant.get("Main.u.w"), "16#0001");
  plant.undo();
  EXPECT_EQ(plant.get("Main.u.l"), "[16#0001, 16#0002, 16#0003, 16#0004]");
}

}  // namespace
}  // namespace online_change
