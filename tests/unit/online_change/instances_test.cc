// Programs and function block instances across a change: A4 to A12, cases 25 to 35,
// 50, and the old program going on where it was.
#include <gtest/gtest.h>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

TEST(Instances, A9_A10_to_the_letter) {
  auto source = [](const char* second, const char* def2, const char* calls, const char* calls2) {
    return "FUNCTION_BLOCK FBDef3 VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK "
           "FUNCTION_BLOCK FBDef2 VAR inst1 : FBDef3; " +
           std::string(def2) + " END_VAR inst1(); " + calls2 +
           " END_FUNCTION_BLOCK "
           "FUNCTION_BLOCK FBDef1 VAR inst1, inst2 : FBDef3; END_VAR inst1(); inst2(); "
           "END_FUNCTION_BLOCK "
           "PROGRAM Prog1 VAR inst1 : FBDef1; " +
           second + " inst3 : FBDef2; END_VAR inst1(); " + calls +
           " inst3(); END_PROGRAM "
           "PROGRAM Prog2 VAR inst1 : FBDef3; END_VAR inst1(); END_PROGRAM";
  };
  Plant plant(source("inst2 : FBDef2;", "", "inst2();", ""));
  EXPECT_EQ(plant.id_of("Prog1"), 1u);
  EXPECT_EQ(plant.id_of("Prog2"), 2u);
  EXPECT_EQ(plant.id_of("Prog1.inst1"), 3u);
  EXPECT_EQ(plant.id_of("Prog1.inst1.inst1"), 4u);
  EXPECT_EQ(plant.id_of("Prog1.inst1.inst2"), 5u);
  EXPECT_EQ(plant.id_of("Prog1.inst2"), 6u);
  EXPECT_EQ(plant.id_of("Prog1.inst2.inst1"), 7u);
  EXPECT_EQ(plant.id_of("Prog1.inst3"), 8u);
  EXPECT_EQ(plant.id_of("Prog1.inst3.inst1"), 9u);
  EXPECT_EQ(plant.id_of("Prog2.inst1"), 10u);
  plant.run(5);
  base::Digest before = plant.hash();
  plant.change(source("", "inst2 : FBDef3;", "", "inst2();"), true);
  EXPECT_EQ(plant.id_of("Prog1.inst3"), 8u);
  EXPECT_EQ(plant.id_of("Prog1.inst3.inst1"), 9u);
  uint32_t child = plant.id_of("Prog1.inst3.inst2");
  EXPECT_TRUE(child == 11 || child == 6 || child == 7) << child;
  EXPECT_EQ(plant.row("Prog1.inst2")->fate, Fate::kDropped);
  EXPECT_EQ(plant.row("Prog1.inst3.inst2")->fate, Fate::kInitialised);
  plant.undo();
  EXPECT_EQ(plant.hash(), before);
  plant.change(source("", "inst2 : FBDef3;", "", "inst2();"), true);
  plant.run(2);
  EXPECT_EQ(plant.get("Prog1.inst3.inst1.n"), "7");
  EXPECT_EQ(plant.get("Prog1.inst3.inst2.n"), "2");
  EXPECT_EQ(plant.get("Prog2.inst1.n"), "7");
}

TEST(Instances, A4_A8_case25_timer_fires_to_the_scan) {
  auto source = [](const char* added) {
    return "FUNCTION_BLOCK Delay VAR t : TON; " + std::string(added) +
           " END_VAR t(IN := TRUE, PT := T#500ms); END_FUNCTION_BLOCK "
           "PROGRAM Main VAR d : Delay; END_VAR d(); END_PROGRAM";
  };
  Plant reference(source(""));
  Plant plant(source(""));
  for (int scan = 0; scan < 60; ++scan) {
    if (scan == 30) plant.change(source("more : LREAL := 1.5; text : STRING[40];"));
    reference.run(1);
    plant.run(1);
    EXPECT_EQ(plant.get("Main.d.t.Q"), reference.get("Main.d.t.Q")) << scan;
    EXPECT_EQ(plant.get("Main.d.t.ET"), reference.get("Main.d.t.ET")) << scan;
  }
  EXPECT_EQ(plant.get("Main.d.t.Q"), "TRUE");
}

TEST(Instances, case26_ton_becomes_tof) {
  auto source = [](const char* type) {
    return "PROGRAM Main VAR t : " + std::string(type) +
           "; n : INT; END_VAR t(IN := TRUE, PT := T#5s); n := n + 1; END_PROGRAM";
  };
  Plant plant(source("TON"));
  plant.run(100);
  EXPECT_NE(plant.get("Main.t.ET"), "T#0s");
  base::Digest before = plant.hash();
  EXPECT_EQ(plant.refused(source("TOF")), base::Refusal::kWouldLose);
  plant.change(source("TOF"), true);
  EXPECT_EQ(plant.get("Main.t.ET"), "T#0s");
  EXPECT_EQ(plant.get("Main.n"), "100");
  EXPECT_EQ(plant.row("Main.t")->fate, Fate::kInitialised);
  plant.undo();
  EXPECT_EQ(plant.hash(), before);
}

TEST(Instances, D2_case28_interface_changes_while_unedited_pous_call_it) {
  auto source = [](const char* inputs, const char* body) {
    return "FUNCTION_BLOCK Scale VAR_INPUT " + std::string(inputs) +
           " END_VAR VAR_OUTPUT y : DINT; END_VAR " + body +
           " END_FUNCTION_BLOCK "
           "PROGRAM Main VAR s : Scale; r : DINT; END_VAR s(x := 3); r := r + s.y; END_PROGRAM";
  };
  Plant plant(source("x : INT;", "y := x;"));
  plant.run(2);
  EXPECT_EQ(plant.get("Main.r"), "6");
  plant.change(source("gain : INT := 10; x : INT;", "y := x * gain;"), true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.r"), "36");
  plant.accept();
  plant.change(source("gain : INT := 10; x : DINT;", "y := x * gain + 1;"), true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.r"), "67");
  plant.accept();
  plant.change(source("x : DINT;", "y := x;"), true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.r"), "70");
}

TEST(Instances, A12_structure_changes_under_a_pou_that_nobody_edited) {
  auto source = [](const char* first) {
    return "TYPE Rec : STRUCT before : " + std::string(first) +
           "; used : INT; END_STRUCT; END_TYPE VAR_GLOBAL g : Rec; END_VAR "
           "PROGRAM Main VAR n : INT; END_VAR g.used := g.used + 1; n := g.used; END_PROGRAM";
  };
  Plant plant(source("UINT"));
  plant.run(4);
  plant.change(source("ARRAY[0..9] OF UINT"), true);
  EXPECT_EQ(plant.get("g.used"), "4");
  plant.run(1);
  EXPECT_EQ(plant.get("Main.n"), "5");
}

TEST(Instances, A5_case30_instance_moves_and_is_still_the_same) {
  auto source = [](const char* added) {
    return "FUNCTION_BLOCK Inner VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK "
           "FUNCTION_BLOCK Outer VAR i : Inner; k : INT; " +
           std::string(added) +
           " END_VAR i(); k := k + i.n; END_FUNCTION_BLOCK "
           "PROGRAM Main VAR a, b : Outer; END_VAR a(); b(); END_PROGRAM";
  };
  Plant reference(source(""));
  Plant plant(source(""));
  reference.run(20);
  plant.run(10);
  plant.change(source("big : ARRAY[0..299] OF LINT;"));
  EXPECT_EQ(plant.row("Main.a")->fate, Fate::kMoved);
  plant.run(10);
  EXPECT_EQ(plant.get("Main.a.k"), reference.get("Main.a.k"));
  EXPECT_EQ(plant.get("Main.b.i.n"), reference.get("Main.b.i.n"));
  plant.undo();
  EXPECT_EQ(plant.hash(), reference.hash());
}

TEST(Instances, case35_many_instances_one_caller_edited) {
  auto source = [](const char* step) {
    return "FUNCTION_BLOCK Cell VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK "
           "PROGRAM Other VAR c : Cell; k : INT; END_VAR c(); k := k + " +
           std::string(step) +
           "; END_PROGRAM PROGRAM Main VAR c : ARRAY[1..1000] OF Cell; i : INT; END_VAR "
           "FOR i := 1 TO 1000 DO c[i](); END_FOR END_PROGRAM";
  };
  Plant plant(source("1"));
  plant.run(2);
  plant.change(source("5"));
  EXPECT_TRUE(plant.plan().steps.empty());
  EXPECT_TRUE(plant.plan().fates.empty());
  plant.run(1);
  EXPECT_EQ(plant.get("Main.c[1000].n"), "3");
  EXPECT_EQ(plant.get("Other.k"), "7");
}

TEST(Instances, A19_case35_all_instances_gain_a_variable_in_their_slack) {
  auto source = [](const char* added) {
    return "FUNCTION_BLOCK Cell VAR n : INT; " + std::string(added) +
           " END_VAR n := n + 1; END_FUNCTION_BLOCK "
           "PROGRAM Main VAR c : ARRAY[1..1000] OF Cell; i : INT; END_VAR "
           "FOR i := 1 TO 1000 DO c[i](); END_FOR END_PROGRAM";
  };
  Plant plant(source(""));
  plant.run(2);
  plant.change(source("m : INT := 8;"));
  EXPECT_EQ(plant.plan().boundary_bytes, 0u);  // A19: nothing is left for the boundary
  EXPECT_EQ(plant.get("Main.c[1].m"), "8");
  EXPECT_EQ(plant.get("Main.c[1000].m"), "8");
  EXPECT_EQ(plant.get("Main.c[1000].n"), "2");
}

TEST(Instances, A7_case50_exactly_into_the_slack_and_beyond) {
  linker::Slack slack;
  slack.program_percent = 0;
  slack.program_bytes = 16;
  slack.globals_bytes = 0;
  slack.globals_percent = 0;
  slack.free_bytes = 4096;
  slack.free_percent = 0;
  auto source = [](int bytes) {
    std::string added = bytes == 0 ? "" : "s : ARRAY[1.." + std::to_string(bytes) + "] OF SINT;";
    return "PROGRAM Main VAR n : LINT; " + added + " END_VAR n := n + 1; END_PROGRAM";
  };
  auto kept_in_place = [&](int bytes) {
    Plant plant(source(0), slack);
    plant.run(1);
    uint32_t before = plant.controller().image().instances[1].data;
    plant.change(source(bytes));
    plant.run(1);
    EXPECT_EQ(plant.get("Main.n"), "2");
    return plant.controller().image().instances[1].data == before;
  };
  EXPECT_TRUE(kept_in_place(16));
  EXPECT_FALSE(kept_in_place(17));
  Plant plant(source(0), slack);
  plant::Compiled next = plant::compile(source(100000));
  linker::Options options;
  options.slack = slack;
  options.base = &plant.controller().image();
  auto refused = linker::link(next.program, next.objects, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kOutOfMemory);
}

TEST(Instances, D1_only_the_edited_pou_changes) {
  auto source = [](const char* step) {
    return "FUNCTION_BLOCK Edited VAR n : INT; END_VAR n := n + " + std::string(step) +
           "; END_FUNCTION_BLOCK FUNCTION_BLOCK Other VAR n : INT; END_VAR n := n + 2; "
           "END_FUNCTION_BLOCK PROGRAM Main VAR a : Edited; b : Other; END_VAR a(); b(); "
           "END_PROGRAM";
  };
  Plant plant(source("1"));
  plant.run(1);
  std::map<std::string, base::Digest> before;
  for (const ir::LinkedPou& pou : plant.controller().image().pous) before[pou.name] = pou.identity;
  plant.change(source("10"));
  for (const ir::LinkedPou& pou : plant.controller().image().pous) {
    EXPECT_EQ(before[pou.name] == pou.identity, pou.name != "Edited") << pou.name;
  }
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "11");
  EXPECT_EQ(plant.get("Main.b.n"), "4");
  plant.undo();  // D3
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "12");
}

TEST(Instances, program_and_task_added_and_removed) {
  const char* const kOne = "PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM";
  const char* const kTwo =
      "PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM "
      "PROGRAM Second VAR n : INT := 5; END_VAR n := n + 1; END_PROGRAM";
  Plant plant(kOne);
  plant.run(3);
  plant.change(kTwo, true);
  plant.run(2);
  EXPECT_EQ(plant.get("Main.n"), "5");
  EXPECT_EQ(plant.get("Second.n"), "7");
  plant.accept();
  plant.change(kOne, true);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.n"), "6");
  plant.undo();
  plant.run(1);
  EXPECT_EQ(plant.get("Second.n"), "8");  // as it was when it was dropped
}

}  // namespace
}  // namespace online_change
