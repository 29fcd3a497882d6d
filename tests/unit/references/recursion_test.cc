// Circles of calls that a POU with a recursion depth allows.
#include "base/limits.h"
#include "tests/unit/references/rig.h"

namespace references {
namespace {

// Sum of n, n-1, ..., 0.
std::string summing(const std::string& depth, const std::string& start) {
  return main_with("  member local r : DINT\n",
                   "  b0:\n    v0 = const i32 " + start +
                       " @3\n    store i32 arg(Sum).n, v0 @3\n    call Sum @3\n"
                       "    v1 = load i32 arg(Sum).Sum @3\n    store i32 self.r, v1 @3\n"
                       "    return @4\n",
                   "pou function Sum" + depth +
                       "\n  local input n : DINT\n  local return Sum : DINT\n  b0:\n"
                       "    init local.Sum\n    v0 = load i32 local.n\n    v1 = const i32 1\n"
                       "    v2 = lt i32 v0, v1\n    branch v2, b1, b2\n  b1:\n    return\n  b2:\n"
                       "    v3 = load i32 local.n\n    v4 = const i32 1\n    v5 = sub i32 v3, v4\n"
                       "    store i32 arg(Sum).n, v5 @12\n    call Sum @12\n"
                       "    v6 = load i32 arg(Sum).Sum\n    v7 = load i32 local.n\n"
                       "    v8 = add i32 v6, v7\n    store i32 local.Sum, v8\n    return\n");
}

TEST(Recursion, GoesAsDeepAsDeclared) {
  Rig rig(summing(" recursion 11", "10"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "55");
}

TEST(Recursion, OneDeeperTraps) {
  Rig rig(summing(" recursion 11", "11"));
  EXPECT_EQ(rig.scan(), "stack Sum:12");
  EXPECT_EQ(rig.value("Main.r"), "0");
}

TEST(Recursion, TheStackIsSizedForIt) {
  const ir::Image shallow = linker::linked(summing(" recursion 1", "0"));
  const ir::Image deep = linker::linked(summing(" recursion 100", "0"));
  EXPECT_GE(deep.call_depth, 100u);
  EXPECT_GT(deep.stack_bytes, 50 * (shallow.stack_bytes / 2));
}

TEST(Recursion, WithoutADepthItIsRefused) {
  const base::Result<ir::Image> image = linker::try_link(summing("", "1"));
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kRecursion);
}

TEST(Recursion, ADepthBeyondTheLimitIsRefused) {
  const base::Result<ir::Program> program = ir::parse_program(summing(" recursion 257", "1"));
  ASSERT_TRUE(program.ok());
  EXPECT_FALSE(ir::verify(*program).ok());
}

// A calls B calls A; only A says how deep. Odd(n) / Even(n).
TEST(Recursion, OneDeclaredPouBoundsTheWholeCircle) {
  const auto pou = [](const std::string& name, const std::string& other, const std::string& depth,
                      const std::string& at_zero) {
    return "pou function " + name + depth + "\n  local input n : INT\n  local return r : BOOL\n" +
           "  b0:\n    v0 = load i16 local.n\n    v1 = const i16 0\n    v2 = eq i16 v0, v1\n"
           "    branch v2, b1, b2\n  b1:\n    v3 = const bool " +
           at_zero + "\n    store bool local.r, v3\n    return\n  b2:\n    v4 = const i16 1\n" +
           "    v5 = sub i16 v0, v4\n    store i16 arg(" + other + ").n, v5\n    call " + other +
           "\n    v6 = load bool arg(" + other + ").r\n    store bool local.r, v6\n    return\n";
  };
  const std::string pous =
      pou("Even", "Odd", " recursion 6", "TRUE") + pou("Odd", "Even", "", "FALSE");
  const auto calling = [&](int n) {
    return main_with("  member local r : BOOL\n",
                     "  b0:\n    v0 = const i16 " + std::to_string(n) +
                         " @3\n    store i16 arg(Even).n, v0 @3\n    call Even @3\n"
                         "    v1 = load bool arg(Even).r @3\n    store bool self.r, v1 @3\n"
                         "    return @4\n",
                     pous);
  };
  Rig ten(calling(10));
  EXPECT_EQ(ten.scan(), "");
  EXPECT_EQ(ten.value("Main.r"), "TRUE");
  Rig eleven(calling(11));
  EXPECT_EQ(eleven.scan(), "");
  Rig twelve(calling(12));
  EXPECT_EQ(twelve.scan(), "stack Odd:0");
}

// kMaxExposures locals of active POUs at once: 250 activations with five each are too many.
TEST(Recursion, MoreExposedLocalsThanTheLimitTrap) {
  std::string locals;
  std::string handles;
  for (int i = 0; i < 5; ++i) {
    const std::string name = "a" + std::to_string(i);
    locals += "  local temp " + name + " : INT\n";
    handles += "    init local." + name + "\n    v" + std::to_string(10 + i) +
               " = handle u64 local." + name + " @7\n";
  }
  const auto program = [&](int n) {
    return main_with("  member local x : INT\n",
                     "  b0:\n    v0 = const i16 " + std::to_string(n) +
                         "\n    store i16 arg(F).n, v0\n    call F\n    return\n",
                     "pou function F recursion 250\n  local input n : INT\n" + locals + "  b0:\n" +
                         handles +
                         "    v0 = load i16 local.n\n    v1 = const i16 1\n    v2 = le i16 v0, v1\n"
                         "    branch v2, b1, b2\n  b1:\n    return\n  b2:\n"
                         "    v3 = sub i16 v0, v1\n    store i16 arg(F).n, v3\n    call F\n"
                         "    return\n");
  };
  Rig most(program(static_cast<int>(base::kMaxExposures / 5)));
  EXPECT_EQ(most.scan(), "");
  Rig more(program(static_cast<int>(base::kMaxExposures / 5 + 1)));
  EXPECT_EQ(more.scan(), "stack F:7");
}

// Every activation exposes its own local; each is found by its own handle only.
TEST(Recursion, EveryActivationHasItsOwnExposedLocals) {
  Rig rig(main_with(
      "  member local r : DINT\n",
      "  b0:\n    v0 = const i32 5\n    store i32 arg(F).n, v0\n    v1 = const u64 0\n"
      "    store u64 arg(F).up, v1\n    call F\n    v2 = load i32 arg(F).F\n"
      "    store i32 self.r, v2\n    return\n",
      "pou function F recursion 8\n  local input n : DINT\n  local input up : PInt\n"
      "  local return F : DINT\n  local temp own : DINT\n  b0:\n    v0 = load i32 local.n\n"
      "    store i32 local.own, v0\n    v1 = load u64 local.up\n    v2 = const u64 0\n"
      "    v3 = eq u64 v1, v2\n    branch v3, b2, b1\n  b1:\n"
      "    v4 = load i32 target(v1 : DINT)\n    v5 = const i32 10\n    v6 = mul i32 v4, v5\n"
      "    store i32 target(v1 : DINT), v6\n    jump b2\n  b2:\n    v7 = load i32 local.n\n"
      "    v8 = const i32 0\n    v9 = eq i32 v7, v8\n    branch v9, b3, b4\n  b3:\n"
      "    v10 = load i32 local.own\n    store i32 local.F, v10\n    return\n  b4:\n"
      "    v11 = handle u64 local.own\n    v12 = const i32 1\n    v13 = sub i32 v7, v12\n"
      "    store i32 arg(F).n, v13\n    store u64 arg(F).up, v11\n    call F\n"
      "    v14 = load i32 arg(F).F\n    v15 = load i32 local.own\n    v16 = add i32 v14, v15\n"
      "    store i32 local.F, v16\n    return\n"));
  for (int i = 0; i < 2; ++i) EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "150");
}

}  // namespace
}  // namespace references
