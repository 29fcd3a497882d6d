// X2, case 60: migrations in Structured Text on live values.
#include <gtest/gtest.h>

#include "base/result.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

const std::string kOld =
    "FUNCTION_BLOCK Tank VAR n : INT := 8; d : INT := 2; END_VAR n := n + 1; END_FUNCTION_BLOCK "
    "PROGRAM Main VAR a, b : Tank; END_VAR a(); b(); END_PROGRAM";
const std::string kNew =
    "{migration of := 'Tank'} FUNCTION Divide VAR_INPUT n, d : INT; END_VAR "
    "VAR_OUTPUT q : INT; END_VAR q := n / d; END_FUNCTION "
    "FUNCTION_BLOCK Tank VAR n : INT := 8; d : INT := 2; q : INT; END_VAR n := n + 1; "
    "END_FUNCTION_BLOCK PROGRAM Main VAR a, b : Tank; END_VAR a(); b(); END_PROGRAM";

TEST(Migrations, X2_values_written_after_the_trial_are_migrated_again) {
  Plant plant(kOld);
  plant.run(2);
  ASSERT_TRUE(plant.stage(plant.package(kNew)).ok());
  plant.run(2);
  plant.set("Main.b.d", "3");
  ASSERT_TRUE(plant.driver().arm(false).ok());
  plant.run(1);
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("Main.a.q"), "6");  // 13 / 2
  EXPECT_EQ(plant.get("Main.b.q"), "4");  // 13 / 3
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "14");
}

TEST(Migrations, X2_case60_a_trap_at_the_boundary_abandons_the_switch) {
  Plant plant(kOld);
  plant.run(1);
  ASSERT_TRUE(plant.stage(plant.package(kNew)).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  plant.set("Main.b.d", "0");
  const base::Digest before = plant.hash();
  auto report = plant.driver().switch_now();
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().refusal, base::Refusal::kMigrationFailed);
  EXPECT_NE(report.error().text.find("Main.b"), std::string::npos) << report.error().text;
  EXPECT_EQ(plant.hash(), before);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "10");
}

TEST(Migrations, X2_the_predicted_pause_counts_the_calls) {
  Plant plant(kOld);
  ASSERT_TRUE(plant.stage(plant.package(kNew)).ok());
  EXPECT_EQ(plant.driver().plan().calls.size(), 2u);
  EXPECT_GT(plant.driver().predicted_pause_ns(), plant.driver().plan().predicted_pause_ns);
}

std::string points(const char* members, const char* rest, const char* step) {
  return std::string("TYPE Point : STRUCT ") + members + " END_STRUCT END_TYPE " + rest +
         "PROGRAM Main VAR row : ARRAY[1..500] OF STRUCT p : Point; k : INT; END_STRUCT; i : INT; "
         "END_VAR FOR i := 1 TO 500 DO " +
         step + " END_FOR END_PROGRAM";
}

// One call for each value; those that are written after the trial are made again.
TEST(Migrations, X2_each_value_of_a_structure_is_migrated_by_both_strategies) {
  for (Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Plant plant(points("x : INT;", "", "row[i].p.x := row[i].p.x + i;"));
    plant.use(strategy);
    plant.run(2);
    const std::string there =
        "{migration of := 'Point'} FUNCTION There VAR_INPUT x : INT; END_VAR "
        "VAR_OUTPUT mm : DINT; END_VAR mm := INT_TO_DINT(x) * 10; END_FUNCTION ";
    ASSERT_TRUE(
        plant.stage(plant.package(points("pad, mm : DINT;", there.c_str(), "row[i].k := 1;")))
            .ok());
    EXPECT_EQ(plant.driver().plan().calls.size(), 500u);
    ASSERT_TRUE(plant.driver().arm(false).ok());
    plant.run(1);
    plant.set("Main.row[7].p.x", "-7");
    ASSERT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get("Main.row[7].p.mm"), "-70");
    EXPECT_EQ(plant.get("Main.row[500].p.mm"), "15000");
    plant.run(1);
    plant.undo();
    EXPECT_EQ(plant.get("Main.row[7].p.x"), "-7");
    EXPECT_EQ(plant.get("Main.row[500].p.x"), "1500");
  }
}

// Any change of a call, an input or a step leads to values of another type, or to none.
TEST(Migrations, X2_V17_calls_take_and_give_values_of_their_types_only) {
  Plant plant(kOld);
  base::Result<Package> package = decode(plant.package(kNew));
  ASSERT_TRUE(package.ok());
  const base::Result<ir::VerifiedImage> next = ir::verify(package->image);
  ASSERT_TRUE(next.ok());
  const auto sound = [&](auto edit) {
    Package copy = *package;
    edit(copy.forward);
    return check_package(copy, plant.controller().image(), next->image()).ok();
  };
  const auto migrated = [](Plan& plan) -> UpdateStep& {
    for (UpdateStep& step : plan.steps) {
      if (step.as<GivenValue>() != nullptr) return step;
    }
    return plan.steps[0];
  };
  const auto given = [&](Plan& plan) -> GivenValue& { return *migrated(plan).as<GivenValue>(); };
  EXPECT_TRUE(sound([](Plan&) {}));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].row = 1; }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].instance = 99; }));
  EXPECT_FALSE(sound([](Plan& plan) {
    plan.calls[0].place = 64;
    plan.calls[0].type = ir::TypeId(9999);
  }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs[0].from += 1; }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs[0].from = 0xfffffff0u; }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs[0].slot += 1; }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs[1] = plan.calls[0].inputs[0]; }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs[0].type = ir::TypeId(0); }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls[0].inputs.pop_back(); }));
  EXPECT_FALSE(sound([](Plan& plan) { plan.calls.clear(); }));
  EXPECT_FALSE(sound([&](Plan& plan) { given(plan).call = 7; }));
  EXPECT_FALSE(sound([&](Plan& plan) { given(plan).slot = 0xffff; }));
  EXPECT_FALSE(
      sound([&](Plan& plan) { given(plan).slot = plan.calls[0].inputs[0].slot; }));
  EXPECT_FALSE(sound([&](Plan& plan) { migrated(plan).to += 1; }));
  EXPECT_FALSE(sound([&](Plan& plan) { migrated(plan).size = 1; }));
  EXPECT_FALSE(sound([&](Plan& plan) { given(plan).made = {1, 2}; }));
  EXPECT_FALSE(sound([&](Plan& plan) { given(plan).type = ir::TypeId(9999); }));
}

// What a damaged image says of its migrations.
TEST(Migrations, X2_the_verifier_refuses_migrations_that_are_none) {
  Plant plant(kOld);
  base::Result<Package> package = decode(plant.package(kNew));
  ASSERT_TRUE(package.ok());
  base::Result<ir::Image> image = ir::decode(package->image);
  ASSERT_TRUE(image.ok());
  ASSERT_EQ(image->migrations.size(), 1u);
  const auto sound = [&](auto edit) {
    ir::Image copy = *image;
    edit(copy.migrations[0]);
    return ir::verify(ir::encode(copy)).ok();
  };
  EXPECT_TRUE(sound([](ir::LinkedMigration&) {}));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.pou = 99; }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.pou = row.pou == 0 ? 1 : 0; }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.type = ir::TypeId(0); }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.values.pop_back(); }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.values[0] = row.values[1]; }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.from_other = true; }));
  EXPECT_FALSE(sound([](ir::LinkedMigration& row) { row.values[0].output ^= true; }));
}

// A thousand instances, and one of them written meanwhile.
TEST(Migrations, X2_every_instance_gets_its_own_values) {
  const auto source = [](const std::string& text) {
    return text.substr(0, text.find("PROGRAM")) +
           "PROGRAM Main VAR r : ARRAY[1..1000] OF Tank; i : INT; END_VAR "
           "FOR i := 1 TO 1000 DO r[i](); r[i](); END_FOR END_PROGRAM";
  };
  Plant plant(source(kOld));
  plant.run(1);
  ASSERT_TRUE(plant.stage(plant.package(source(kNew))).ok());
  plant.set("Main.r[500].d", "5");
  ASSERT_TRUE(plant.driver().arm(false, true).ok());
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("Main.r[1].q"), "5");
  EXPECT_EQ(plant.get("Main.r[500].q"), "2");
  EXPECT_EQ(plant.get("Main.r[1000].q"), "5");
}

}  // namespace
}  // namespace online_change
