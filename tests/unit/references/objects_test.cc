// Objects (ir.h): the programs of tests/unit/program/objects_test.cc and more, by the interpreter
// and by the evaluator.
#include "tests/unit/program/objects_sample.h"
#include "tests/unit/references/rig.h"

namespace references {
namespace {

std::string objects(std::string_view globals, std::string_view body, std::string_view more = "") {
  return ir::object_program(globals, body, ir::kObjectOverrides, more);
}

// Scans once; `values` are "path=value" pairs.
void expect(const std::string& text, const std::string& trap,
            std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
  Rig rig(text);
  EXPECT_EQ(rig.scan(), trap);
  for (const auto& [path, value] : values) EXPECT_EQ(rig.value(path), value) << path;
}

TEST(Objects, CallsBasesOverridesAndActions) {
  expect(objects("  member global seen : DINT\n", R"(b0:
    v0 = const i32 2
    store i32 self.leaf!.step, v0
    call_instance self.leaf
    store i32 arg('Base.twice').x, v0
    call_method 'Base.twice', self.leaf
    v1 = load i32 arg('Base.twice').r
    store i32 global.seen, v1
    store i32 arg('Base.add').x, v0
    call_method 'Base.add', self.base
    call_method 'Main.Reset'
    return
)",
                 R"(pou method 'Main.Reset' self Main
  b0:
    v0 = const i32 3
    store i32 self.middle!.total, v0
    return
)"),
         "",
         {{"seen", "40"},
          {"Main.leaf.total", "43"},
          {"Main.leaf.extra", "7"},
          {"Main.base.total", "2"},
          {"Main.middle.total", "3"}});
}

// In a method too `self` is the whole instance, also in an element chosen at run time.
TEST(Objects, MethodsRunOnElementsOfArrays) {
  expect(objects("  member global n : DINT\n", R"(b0:
    v0 = const i32 1
    jump b1(v0)
  b1(v1:i32):
    store i32 arg('Base.twice').x, v1
    call_method 'Base.twice', self.leaves[v1]
    v2 = load i32 arg('Base.twice').r
    v3 = load i32 global.n
    v4 = add i32 v2, v3
    store i32 global.n, v4
    v5 = const i32 1
    v6 = add i32 v1, v5
    v7 = const i32 3
    v8 = le i32 v6, v7
    branch v8, b1(v6), b2
  b2:
    return
)"),
         "", {{"n", "120"}, {"Main.leaves[1].total", "20"}, {"Main.leaves[3].total", "60"}});
}

constexpr std::string_view kReferences =
    "  member global seen : DINT\n"
    "  member global ref : ULINT\n"
    "  member global leaf : BOOL\n"
    "  member global adder : BOOL\n"
    "  member global other : BOOL\n"
    "  member global null : BOOL\n";
constexpr std::string_view kGiveReference = R"(pou method 'Leaf.me' self Leaf
  local return r : ULINT
  b0:
    v0 = this u64
    store u64 local.r, v0
    return
)";

TEST(Objects, ReferencesAreTestedAndCalled) {
  expect(objects(kReferences, R"(b0:
    call_method 'Leaf.me', self.leaves[2]
    v0 = load u64 arg('Leaf.me').r
    store u64 global.ref, v0
    v1 = is_type bool v0, Leaf
    store bool global.leaf, v1
    v2 = is_type bool v0, Adder
    store bool global.adder, v2
    v3 = is_type bool v0, Other
    store bool global.other, v3
    v4 = const u64 0
    v5 = is_type bool v4, Leaf
    store bool global.null, v5
    call_reference v0, Base
    v6 = const i32 4
    store i32 arg('Adder.add').x, v6
    call_virtual 'Adder.add', v0
    v7 = load i32 arg('Adder.add').r
    store i32 global.seen, v7
    store i32 arg('Base.add').x, v6
    call_method 'Base.add', v0
    return
)",
                 kGiveReference),
         "",
         {{"leaf", "TRUE"},
          {"adder", "TRUE"},
          {"other", "FALSE"},
          {"null", "FALSE"},
          {"seen", "40"},
          {"Main.leaves[2].total", "45"}});
}

// What the base has is where the base has it: places, in-outs to it and calls through a handle.
TEST(Objects, AHandleOfADerivedInstanceServesAsOneOfItsBase) {
  expect(objects("  member global seen : DINT\n", R"(b0:
    v0 = handle u64 self.leaf
    v1 = const i32 500
    store i32 target(v0 : Base)!.total, v1
    call_instance target(v0 : Base)
    store i32 arg('Base.add').x, v1
    call_method 'Base.add', target(v0 : Base)
    v2 = load i32 target(v0 : Middle)!.total
    store i32 global.seen, v2
    return
)"),
         "", {{"seen", "1001"}, {"Main.leaf.total", "1001"}, {"Main.leaf.extra", "7"}});
}

TEST(Objects, ReferencesToNothingTrap) {
  for (const char* call :
       {"call_reference v0, Base", "store i32 arg('Base.add').x, v1\n call_virtual 'Base.add', v0",
        "store i32 arg('Base.add').x, v1\n call_method 'Base.add', v0"}) {
    for (const char* reference : {"0", "4294967296", "8589934593", "429496729600"}) {
      expect(objects(kReferences, "b0:\n v0 = const u64 " + std::string(reference) +
                                      "\n v1 = const i32 1\n " + call + "\n return\n"),
             "reference Main:0", {});
    }
  }
}

TEST(Objects, AMethodIsNotFoundInWhatIsOfAnotherType) {
  expect(objects(kReferences, R"(b0:
    v0 = handle u64 self.other
    v1 = const i32 1
    store i32 arg('Adder.add').x, v1
    call_virtual 'Adder.add', v0
    return
)"),
         "reference Main:0", {});
}

// A method that calls itself on other instances needs a depth, and gets it.
TEST(Objects, VirtualCallsCountInCirclesOfCalls) {
  const auto text = [](std::string_view depth) {
    return objects("  member global n : DINT\n",
                   "b0:\n v0 = handle u64 self.leaf\n v1 = const i32 5\n"
                   " store i32 arg('Base.down').x, v1\n call_virtual 'Base.down', v0\n return\n",
                   "pou method 'Base.down' self Base" + std::string(depth) +
                       "\n  local input x : DINT\n  b0:\n    v0 = load i32 global.n\n"
                       "    v1 = const i32 1\n    v2 = add i32 v0, v1\n    store i32 global.n, v2\n"
                       "    v3 = load i32 local.x\n    v4 = const i32 0\n    v5 = lt i32 v4, v3\n"
                       "    branch v5, b1, b2\n  b1:\n    v6 = this u64\n    v7 = sub i32 v3, v1\n"
                       "    store i32 arg('Base.down').x, v7\n    call_virtual 'Base.down', v6\n"
                       "    return\n  b2:\n    return\n");
  };
  const auto with_rows = [&](std::string_view depth) {
    ir::Program program = linker::parsed(text(depth));
    program.overrides = ir::find_overrides(program);
    return ir::print(program);
  };
  const base::Result<ir::Image> image = linker::try_link(with_rows(""));
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kRecursion);
  EXPECT_NE(image.error().text.find("Base.down -> Base.down"), std::string::npos);
  expect(with_rows(" recursion 6"), "", {{"n", "6"}});
  expect(with_rows(" recursion 5"), "stack Base.down:0", {{"n", "5"}});
}

}  // namespace
}  // namespace references
