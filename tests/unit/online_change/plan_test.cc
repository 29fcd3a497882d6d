// plan() on images made by hand: fates (X1), update records (A3, A13), what is
// initialised early (A19), and the state after switch and undo.
#include "online_change/plan/plan.h"

#include <gtest/gtest.h>

#include "online_change/package/package.h"
#include "tests/unit/online_change/hand_made.h"

namespace online_change {
namespace {

using hand_made::find_row;
using hand_made::Running;
using hand_made::Version;
using ir::Kind;

TEST(Plan, A1_unchanged_program_needs_nothing) {
  auto make = [](Version& v) {
    ir::TypeId counter = v.block("Counter", {{"n", v.elementary(Kind::kInt), 5}});
    v.globals({{"g", v.elementary(Kind::kDint), 3}});
    v.program("Main", {{"c", counter}, {"x", v.elementary(Kind::kReal)}});
  };
  Version a;
  make(a);
  a.link();
  Version b;
  make(b);
  b.link(&a);
  Running run(a);
  Plan plan = run.change(b);
  EXPECT_TRUE(plan.steps.empty());
  EXPECT_TRUE(plan.fates.empty());
  EXPECT_EQ(plan.counts.kept, 3u);
  EXPECT_EQ(plan.counts.total(), 3u);
}

// No compiler says so of an instance, but an image can.
TEST(Plan, A1_an_instance_that_becomes_constant_stays) {
  auto make = [](Version& v, bool constant) {
    ir::TypeId counter = v.block("Counter", {{"n", v.elementary(Kind::kInt), 5}});
    v.program("Main", {{"c", counter, 0, constant}});
  };
  Version a;
  make(a, false);
  a.link();
  Version b;
  make(b, true);
  b.link(&a);
  Running run(a);
  run.set("Main.c.n", "42");
  EXPECT_EQ(run.change(b).counts.kept, 1u);
  EXPECT_EQ(run.get("Main.c.n"), "42");
  run.undo();
  EXPECT_EQ(run.get("Main.c.n"), "42");
}

TEST(Plan, A2_A15_A19_added_variable_is_initialised_early) {
  Version a;
  a.program("Main", {{"x", a.elementary(Kind::kInt), 7}});
  a.link();
  Version b;
  b.program("Main", {{"y", b.elementary(Kind::kInt), 9},
                     {"x", b.elementary(Kind::kInt), 8},
                     {"z", b.elementary(Kind::kLint)}});
  b.link(&a);
  Running run(a);
  run.set("Main.x", "42");
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.x"), "42");
  EXPECT_EQ(run.get("Main.y"), "9");
  EXPECT_EQ(run.get("Main.z"), "0");
  EXPECT_EQ(plan.counts.kept, 1u);
  EXPECT_EQ(plan.counts.initialised, 2u);
  for (const UpdateStep& step : plan.steps) EXPECT_TRUE(step.early());
  EXPECT_EQ(plan.boundary_bytes, 0u);
  EXPECT_EQ(find_row(plan, "Main.y")->reason, "new");
  // Case 11: the live value stays, and the report says so.
  EXPECT_EQ(find_row(plan, "Main.x")->fate, Fate::kKept);
}

TEST(Plan, A14_case1_retyped_scalar_and_undo) {
  Version a;
  a.program("Main", {{"x", a.elementary(Kind::kInt)}, {"gone", a.elementary(Kind::kInt)}});
  a.link();
  Version b;
  b.program("Main", {{"x", b.elementary(Kind::kSint)}});
  b.link(&a);
  Running run(a);
  run.set("Main.x", "300");
  run.set("Main.gone", "11");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.x"), "127");
  EXPECT_EQ(run.losses().size(), 1u);
  const FateRow* row = find_row(plan, "Main.x");
  EXPECT_EQ(row->fate, Fate::kConverted);
  EXPECT_TRUE(row->may_lose);
  EXPECT_EQ(find_row(plan, "Main.gone")->fate, Fate::kDropped);
  EXPECT_EQ(plan.counts.dropped, 1u);
  run.undo();
  EXPECT_EQ(run.get("Main.x"), "300");  // nobody wrote it since
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, X4_undo_converts_what_was_written_since) {
  Version a;
  a.program("Main", {{"x", a.elementary(Kind::kLreal)}, {"y", a.elementary(Kind::kLreal)}});
  a.link();
  Version b;
  b.program("Main", {{"x", b.elementary(Kind::kReal)}, {"y", b.elementary(Kind::kReal)}});
  b.link(&a);
  Running run(a);
  run.set("Main.x", "0.1");
  run.set("Main.y", "0.1");
  run.change(b);
  run.set("Main.y", "2.5");
  run.undo();
  EXPECT_EQ(run.get("Main.x"), "0.1");  // case 6: the original bits
  EXPECT_EQ(run.get("Main.y"), "2.5");
}

TEST(Plan, A14_arrays_by_index) {
  Version a;
  ir::TypeId integer = a.elementary(Kind::kInt);
  a.program("Main", {{"v", a.array(integer, {{0, 1}, {0, 2}})}});
  a.link();
  Version b;
  b.program("Main", {{"v", b.array(b.elementary(Kind::kInt), {{0, 2}, {0, 1}}), 99}});
  b.link(&a);
  Running run(a);
  const char* kNames[] = {"0,0", "0,1", "0,2", "1,0", "1,1", "1,2"};
  for (int i = 0; i < 6; ++i) {
    run.set("Main.v[" + std::string(kNames[i]) + "]", std::to_string(10 + i));
  }
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.v"), "[10, 11, 13, 14, 99, 99]");
  EXPECT_EQ(plan.counts.moved, 4u);
  EXPECT_EQ(plan.counts.dropped, 2u);
  EXPECT_EQ(plan.counts.initialised, 2u);
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, case17_three_dimensions_middle_grows) {
  Version a;
  a.program("Main", {{"v", a.array(a.elementary(Kind::kInt), {{1, 3}, {1, 4}, {1, 5}})}});
  a.link();
  Version b;
  b.program("Main", {{"v", b.array(b.elementary(Kind::kInt), {{1, 3}, {1, 6}, {1, 5}})}});
  b.link(&a);
  Running run(a);
  auto path = [](int i, int j, int k) {
    return "Main.v[" + std::to_string(i) + "," + std::to_string(j) + "," + std::to_string(k) + "]";
  };
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 4; ++j) {
      for (int k = 1; k <= 5; ++k) run.set(path(i, j, k), std::to_string(100 * i + 10 * j + k));
    }
  }
  Plan plan = run.change(b);
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 6; ++j) {
      for (int k = 1; k <= 5; ++k) {
        EXPECT_EQ(run.get(path(i, j, k)), std::to_string(j > 4 ? 0 : 100 * i + 10 * j + k));
      }
    }
  }
  EXPECT_EQ(plan.counts.moved, 60u);
  EXPECT_EQ(plan.counts.initialised, 30u);
  EXPECT_EQ(plan.counts.dropped, 0u);
}

TEST(Plan, case18_shifted_bounds_and_other_dimensions) {
  Version a;
  a.program("Main", {{"v", a.array(a.elementary(Kind::kInt), {{0, 9}})},
                     {"w", a.array(a.elementary(Kind::kInt), {{1, 10}})}});
  a.link();
  Version b;
  b.program("Main", {{"v", b.array(b.elementary(Kind::kInt), {{1, 10}}), 77},
                     {"w", b.array(b.elementary(Kind::kInt), {{1, 2}, {1, 5}})}});
  b.link(&a);
  Running run(a);
  for (int i = 0; i < 10; ++i) run.set("Main.v[" + std::to_string(i) + "]", std::to_string(i));
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.v"), "[1, 2, 3, 4, 5, 6, 7, 8, 9, 77]");
  const FateRow* row = find_row(plan, "Main.w");
  EXPECT_EQ(row->fate, Fate::kInitialised);
  EXPECT_TRUE(row->may_lose);
  EXPECT_EQ(row->count, 10u);
}

TEST(Plan, case20_element_type_and_bounds) {
  Version a;
  a.program("Main", {{"v", a.array(a.elementary(Kind::kInt), {{0, 4}})}});
  a.link();
  Version b;
  b.program("Main", {{"v", b.array(b.elementary(Kind::kLreal), {{2, 6}})}});
  b.link(&a);
  Running run(a);
  for (int i = 0; i < 5; ++i) run.set("Main.v[" + std::to_string(i) + "]", std::to_string(i + 1));
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.v"), "[3.0, 4.0, 5.0, 0.0, 0.0]");
  EXPECT_EQ(plan.counts.converted, 3u);
  EXPECT_EQ(plan.steps.size(), 2u);  // one step for all elements
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, case21_member_first_in_a_structure_in_arrays_in_blocks) {
  auto make = [](Version& v, bool edited) {
    std::vector<hand_made::Var> vars = {{"a", v.elementary(Kind::kInt), 3},
                                        {"b", v.elementary(Kind::kDint), 4}};
    if (edited) vars.insert(vars.begin(), {"first", v.elementary(Kind::kLint), 1});
    ir::TypeId rec = v.structure(edited ? "Rec2" : "Rec", vars);
    ir::TypeId block = v.block("Block", {{"r", v.array(rec, {{1, 3}})}});
    v.program("Main", {{"f", v.array(block, {{1, 2}})}});
  };
  Version a;
  make(a, false);
  a.link();
  Version b;
  make(b, true);
  b.link(&a);
  Running run(a);
  run.set("Main.f[2].r[3].b", "33");
  run.set("Main.f[1].r[1].a", "11");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.f[2].r[3].b"), "33");
  EXPECT_EQ(run.get("Main.f[1].r[1].a"), "11");
  EXPECT_EQ(run.get("Main.f[1].r[2].first"), "1");
  EXPECT_EQ(plan.counts.initialised, 6u);
  EXPECT_EQ(find_row(plan, "Main.f[1].r[1..3].first")->count, 6u);
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, A5_instance_that_outgrows_its_area_moves_alone) {
  auto make = [](Version& v, bool edited) {
    ir::TypeId inner = v.block("Inner", {{"n", v.elementary(Kind::kInt)}});
    std::vector<hand_made::Var> vars = {{"i", inner}, {"k", v.elementary(Kind::kInt)}};
    if (edited) {
      vars.push_back({"big", v.array(v.elementary(Kind::kLint), {{0, 99}})});
    }
    ir::TypeId outer = v.block("Outer", vars);
    v.program("Main", {{"o", outer}, {"p", inner}});
  };
  Version a;
  make(a, false);
  a.link();
  Version b;
  make(b, true);
  b.link(&a);
  ASSERT_NE(a.image.instances[2].data, b.image.instances[2].data);
  Running run(a);
  run.set("Main.o.k", "5");
  run.set("Main.o.i.n", "6");
  run.set("Main.p.n", "7");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.o.k"), "5");
  EXPECT_EQ(run.get("Main.o.i.n"), "6");
  EXPECT_EQ(run.get("Main.p.n"), "7");
  EXPECT_EQ(plan.counts.moved, 1u);
  EXPECT_EQ(plan.counts.kept, 2u);
  EXPECT_EQ(find_row(plan, "Main.o")->reason, "area moved");
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, case26_another_type_under_the_same_name_is_initialised) {
  Version a;
  ir::TypeId ton = a.block("TON", {{"ET", a.elementary(Kind::kTime), 0}});
  a.program("Main", {{"t", ton}});
  a.link();
  Version b;
  ir::TypeId tof = b.block("TOF", {{"ET", b.elementary(Kind::kTime), 1000}});
  b.program("Main", {{"t", tof}});
  b.link(&a);
  Running run(a);
  run.set("Main.t.ET", "T#3s");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.t.ET"), "T#1us");
  const FateRow* row = find_row(plan, "Main.t");
  EXPECT_EQ(row->fate, Fate::kInitialised);
  EXPECT_EQ(row->old_type, "TON");
  EXPECT_EQ(plan.counts.dropped, 0u);
  run.undo();
  EXPECT_EQ(run.get("Main.t.ET"), "T#3s");
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, X1_identical_instances_are_one_row) {
  auto make = [](Version& v, bool edited) {
    std::vector<hand_made::Var> vars = {{"n", v.elementary(Kind::kInt)}};
    if (edited) vars.push_back({"added", v.elementary(Kind::kInt), 4});
    ir::TypeId block = v.block("Block", vars);
    v.program("Main", {{"f", v.array(block, {{1, 500}})}});
  };
  Version a;
  make(a, false);
  a.link();
  Version b;
  make(b, true);
  b.link(&a);
  Running run(a);
  Plan plan = run.change(b);
  ASSERT_EQ(plan.fates.size(), 1u);
  EXPECT_EQ(plan.fates[0].count, 500u);
  EXPECT_EQ(plan.fates[0].path, "Main.f[1].added");
  EXPECT_EQ(plan.boundary_bytes, 0u);  // all inside the slack, written before the switch
  EXPECT_EQ(run.get("Main.f[500].added"), "4");
}

TEST(Plan, case24_array_of_100000_grows_by_one) {
  Version a;
  a.program("Main", {{"v", a.array(a.elementary(Kind::kDint), {{1, 100000}})}});
  a.link();
  Version b;
  b.program("Main", {{"v", b.array(b.elementary(Kind::kDint), {{1, 100001}}), 0}});
  b.link(&a);
  auto plan = online_change::plan(a.image, b.image);
  ASSERT_TRUE(plan.ok());
  EXPECT_LE(plan->steps.size(), 2u);
  EXPECT_EQ(plan->counts.moved, 100000u);
  EXPECT_EQ(plan->counts.initialised, 1u);
}

TEST(Plan, case12_constant_follows_the_source) {
  Version a;
  a.program("Main", {{"c", a.elementary(Kind::kInt), 10, true},
                     {"v", a.elementary(Kind::kInt), 1},
                     {"same", a.elementary(Kind::kInt), 6, true}});
  a.link();
  Version b;
  b.program("Main", {{"c", b.elementary(Kind::kInt), 12, true},
                     {"v", b.elementary(Kind::kInt), 2, true},
                     {"same", b.elementary(Kind::kInt), 6, true}});
  b.link(&a);
  Running run(a);
  run.set("Main.v", "55");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.get("Main.c"), "12");
  EXPECT_EQ(run.get("Main.v"), "2");
  EXPECT_EQ(find_row(plan, "Main.c")->reason, "constant changed");
  EXPECT_EQ(plan.counts.kept, 1u);
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, law_identity_with_everything_moved) {
  auto make = [](Version& v) {
    ir::TypeId inner = v.block("Inner", {{"n", v.elementary(Kind::kInt), 3}});
    ir::TypeId rec = v.structure("Rec", {{"s", v.image.types.own().string(7)}, {"f", inner}});
    ir::TypeId outer = v.block("Outer", {{"i", inner}, {"x", v.elementary(Kind::kLreal)}});
    v.globals({{"g", outer}, {"flag", v.elementary(Kind::kBool), 1}});
    v.program("Main", {{"o", v.array(outer, {{1, 3}})}});
    (void)rec;
  };
  Version a;
  make(a);
  a.link();
  Version b;
  make(b);
  b.link(&a, 16, true);
  Running run(a);
  run.set("Main.o[2].i.n", "22");
  run.set("g.x", "1.25");
  base::Digest before = run.hash();
  Plan plan = run.change(b);
  EXPECT_EQ(run.hash(), before);
  EXPECT_EQ(plan.counts.moved, plan.counts.total());
  EXPECT_EQ(run.get("Main.o[2].i.n"), "22");
  run.undo();
  EXPECT_EQ(run.hash(), before);
}

TEST(Plan, neighbours_exchange_places) {
  // The same bytes are source of one step and target of another.
  Version a;
  a.program("Main", {{"x", a.elementary(Kind::kInt)}, {"y", a.elementary(Kind::kInt)}});
  a.link();
  Version b;
  b.program("Main", {{"x", b.elementary(Kind::kInt)}, {"y", b.elementary(Kind::kInt)}});
  b.link(&a);
  ir::TypeLayout& layout = b.image.layouts.own().of[b.image.instances[1].type.index];
  std::swap(layout.member_offsets[0], layout.member_offsets[1]);
  Running run(a);
  run.set("Main.x", "1");
  run.set("Main.y", "2");
  run.change(b);
  EXPECT_EQ(run.get("Main.x"), "1");
  EXPECT_EQ(run.get("Main.y"), "2");
  run.undo();
  EXPECT_EQ(run.get("Main.x"), "1");
  EXPECT_EQ(run.get("Main.y"), "2");
}

}  // namespace
}  // namespace online_change
