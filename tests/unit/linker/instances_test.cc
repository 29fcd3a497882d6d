// A9, A10: instance IDs.
#include "tests/unit/linker/linked.h"

namespace linker {
namespace {

std::string worked_case(std::string_view fbdef2, std::string_view prog1) {
  return "program P\ntype FBDef3 = function_block\n  member local x : INT\n"
         "type FBDef2 = function_block\n" +
         std::string(fbdef2) +
         "type FBDef1 = function_block\n  member local inst1 : FBDef3\n"
         "  member local inst2 : FBDef3\n"
         "type Prog1 = program\n" +
         std::string(prog1) +
         "type Prog2 = program\n  member local inst1 : FBDef3\n"
         "type G = globals\nglobals G\ntask T period 1000000 priority 0\n"
         "instance Prog1 : Prog1 task 0\ninstance Prog2 : Prog2 task 0\n" +
         empty_pou("function_block", "FBDef3") + empty_pou("function_block", "FBDef2") +
         empty_pou("function_block", "FBDef1") + empty_pou("program", "Prog1") +
         empty_pou("program", "Prog2");
}

constexpr std::string_view kOneChild = "  member local inst1 : FBDef3\n";
constexpr std::string_view kTwoChildren =
    "  member local inst1 : FBDef3\n  member local inst2 : FBDef3\n";
constexpr std::string_view kThree =
    "  member local inst1 : FBDef1\n  member local inst2 : FBDef2\n"
    "  member local inst3 : FBDef2\n";
constexpr std::string_view kTwo = "  member local inst1 : FBDef1\n  member local inst3 : FBDef2\n";

std::vector<std::string> paths(const ir::Image& image) {
  std::vector<std::string> out;
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    out.push_back(image.instances[id].live ? image.instance_path(id) : "-");
  }
  return out;
}

using Paths = std::vector<std::string>;

// A10 to the letter.
TEST(InstanceIds, A10WorkedCase) {
  const ir::Image first = linked(worked_case(kOneChild, kThree));
  EXPECT_EQ(paths(first), (Paths{"Prog1", "Prog2", "Prog1.inst1", "Prog1.inst1.inst1",
                                 "Prog1.inst1.inst2", "Prog1.inst2", "Prog1.inst2.inst1",
                                 "Prog1.inst3", "Prog1.inst3.inst1", "Prog2.inst1"}));
  const ir::Image second = relinked(first, worked_case(kTwoChildren, kTwo));
  EXPECT_EQ(paths(second),
            (Paths{"Prog1", "Prog2", "Prog1.inst1", "Prog1.inst1.inst1", "Prog1.inst1.inst2", "-",
                   "-", "Prog1.inst3", "Prog1.inst3.inst1", "Prog2.inst1", "Prog1.inst3.inst2"}));
  for (uint32_t id : {1u, 2u, 3u, 4u, 5u, 9u, 10u}) {
    EXPECT_EQ(second.instances[id].data, first.instances[id].data) << id;
  }
}

// kMaxInstances counts the globals, too.
TEST(InstanceIds, LimitAndOneAboveIt) {
  EXPECT_EQ(Options().max_instances, base::kMaxInstances);
  const std::string text = worked_case(kOneChild, kThree);
  const ir::Image image = linked(text);
  Options options;
  options.max_instances = static_cast<uint32_t>(image.instances.size());
  EXPECT_TRUE(try_link(text, options).ok());
  --options.max_instances;
  base::Result<ir::Image> refused = try_link(text, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTooMany);
}

// IDs that only this change frees count as well: undo needs them.
TEST(InstanceIds, LimitOfIdsAfterAChange) {
  const ir::Image first = linked(worked_case(kOneChild, kThree));
  const std::string text = worked_case(kTwoChildren, kTwo);
  Options options;
  options.base = &first;
  options.max_instances = static_cast<uint32_t>(first.instances.size());
  base::Result<ir::Image> refused = try_link(text, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTooMany);
  ++options.max_instances;
  EXPECT_TRUE(try_link(text, options).ok());
}

// A9: a dead instance's ID can be used again, from the next change on; its
// generation tells an old reference from a new one.
TEST(InstanceIds, A9ReusesDeadIdsLowestFirstOneChangeLater) {
  const ir::Image first = linked(worked_case(kOneChild, kThree));
  const ir::Image second = relinked(first, worked_case(kTwoChildren, kTwo));
  const ir::Image third = relinked(second, worked_case(kTwoChildren, kThree));
  EXPECT_EQ(id_of(third, "Prog1.inst2"), 6u);
  EXPECT_EQ(id_of(third, "Prog1.inst2.inst1"), 7u);
  EXPECT_EQ(id_of(third, "Prog1.inst2.inst2"), 12u);
  EXPECT_EQ(third.instances[6].generation, 1u);
  EXPECT_EQ(third.instances[12].generation, 0u);
  EXPECT_EQ(third.instances[11].generation, 0u);
}

TEST(InstanceIds, A9ReplacedTypeIsANewInstance) {
  const ir::Image first = linked(worked_case(kOneChild, kThree));
  const ir::Image second =
      relinked(first, worked_case(kOneChild,
                                  "  member local inst1 : FBDef1\n  member local inst2 : FBDef3\n"
                                  "  member local inst3 : FBDef2\n"));
  EXPECT_EQ(id_of(second, "Prog1.inst2"), 11u);
  EXPECT_FALSE(second.instances[6].live);
  EXPECT_FALSE(second.instances[7].live);
}

TEST(InstanceIds, CountsArraysAndStructuresElementByElement) {
  const ir::Image image = linked(
      simple("  member global g : F\n", "  member local many : %29\n  member local f : F\n",
             "type F = function_block\n  member local x : INT\n"
             "type %26 = array F [1..2]\ntype S = struct\n  member local fbs : %26\n"
             "  member local one : F\ntype %28 = array S [0..0]\ntype %29 = array S [5..6]\n",
             empty_pou("function_block", "F")));
  EXPECT_EQ(paths(image), (Paths{"Main", "Main.many[5].fbs[1]", "Main.many[5].fbs[2]",
                                 "Main.many[5].one", "Main.many[6].fbs[1]", "Main.many[6].fbs[2]",
                                 "Main.many[6].one", "Main.f", "g"}));
}

TEST(InstanceIds, RefusesAFunctionBlockThatContainsItself) {
  const ir::Program program = *ir::parse_program(
      simple("", "  member local f : F\n", "type F = function_block\n  member local again : F\n",
             empty_pou("function_block", "F")));
  const base::Result<ir::Image> image = link(program, objects_of(program), {});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kRecursion);
}

}  // namespace
}  // namespace linker
