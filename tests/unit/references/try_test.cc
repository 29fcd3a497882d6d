// Caught traps (ir.h) by the interpreter and by the evaluator.
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

constexpr std::string_view kTryGlobals =
    "  member global n : DINT\n  member global kind : UDINT\n"
    "  member global zero : DINT\n  member global d : DINT\n";

TEST(Try, HandlerSeesEveryStoreBeforeTheTrap) {
  expect(objects(kTryGlobals, R"(b0:
    try b1, b3
  b1 handler b3:
    v0 = const i32 5
    store i32 global.n, v0
    v1 = load i32 global.zero
    v2 = div i32 v0, v1
    store i32 global.n, v2
    jump b2
  b2 handler b3:
    end_try b4
  b3:
    v3 = trap_kind u32
    store u32 global.kind, v3
    jump b4
  b4:
    return
)"),
         "", {{"n", "5"}, {"kind", "0"}});
}

// A local that is written in the try, and a value computed before it, reach the handler.
TEST(Try, LocalsAndValuesReachTheHandler) {
  expect(objects(kTryGlobals, R"(  local temp i : DINT
  local temp k : DINT
  b0:
    v0 = load i32 global.zero
    v1 = const i32 7
    v2 = add i32 v0, v1
    v9 = const i32 1
    store i32 local.i, v9
    store i32 local.k, v9
    try b1, b2
  b1 handler b2:
    v3 = const i32 20
    store i32 local.i, v3
    v4 = mul i32 v3, v3
    v5 = div i32 v4, v0
    store i32 local.k, v5
    end_try b3
  b2:
    v6 = load i32 local.i
    v7 = add i32 v6, v2
    store i32 global.n, v7
    v8 = load i32 local.k
    store i32 global.d, v8
    jump b3
  b3:
    return
)"),
         "", {{"n", "27"}, {"d", "1"}});
}

constexpr std::string_view kDeep = R"(pou function Deep
  local input x : DINT
  local return r : DINT
  b0:
    init local.r
    v0 = load i32 local.x
    store i32 global.n, v0
    trap assert
)";

TEST(Try, NestedTriesAndTrapsOfCallees) {
  expect(objects(kTryGlobals, R"(b0:
    try b1, b5
  b1 handler b5:
    try b2, b3
  b2 handler b3:
    v0 = const i32 9
    store i32 arg(Deep).x, v0
    call Deep
    end_try b4
  b3 handler b5:
    v1 = trap_kind u32
    store u32 global.kind, v1
    trap index
  b4 handler b5:
    end_try b6
  b5:
    v2 = trap_kind u32
    v3 = load u32 global.kind
    v4 = const u32 100
    v5 = mul u32 v3, v4
    v6 = add u32 v5, v2
    store u32 global.kind, v6
    jump b6
  b6:
    return
)",
                 kDeep),
         "", {{"n", "9"}, {"kind", "1101"}});
}

// After a trap two instances deep, `self` and the own instance are what they were.
TEST(Try, TheFrameAndTheInstanceComeBack) {
  expect(objects("  member global n : DINT\n  member global same : BOOL\n", R"(b0:
    call_method 'Base.safe', self.leaf
    return
)",
                 R"(pou method 'Base.bad' self Base
  b0:
    v0 = const i32 11
    store i32 self.total, v0
    trap conversion
pou method 'Base.safe' self Base
  local temp before : ULINT
  b0:
    v0 = this u64
    store u64 local.before, v0
    try b1, b2
  b1 handler b2:
    call_method 'Base.bad', target(v0 : Base)
    end_try b3
  b2:
    v1 = this u64
    v2 = load u64 local.before
    v3 = eq u64 v1, v2
    store bool global.same, v3
    v4 = load i32 self.total
    v5 = const i32 100
    v6 = add i32 v4, v5
    store i32 self.total, v6
    jump b3
  b3:
    return
)"),
         "", {{"same", "TRUE"}, {"Main.leaf.total", "111"}});
}

// What a POU between had exposed is gone; what the POU of the try has exposed is not.
TEST(Try, ExposedLocalsGoWithTheirPous) {
  expect(objects("  member global ref : ULINT\n  member global n : DINT\n",
                 R"(  local temp mine : DINT
  b0:
    v0 = const i32 1
    store i32 local.mine, v0
    v1 = handle u64 local.mine
    try b1, b2
  b1 handler b2:
    call Expose
    end_try b3
  b2:
    v2 = const i32 5
    store i32 target(v1 : DINT), v2
    v3 = load i32 local.mine
    store i32 global.n, v3
    v4 = load u64 global.ref
    v5 = load i32 target(v4 : DINT)
    store i32 global.n, v5
    jump b3
  b3:
    return
)",
                 R"(pou function Expose
  local temp x : DINT
  b0:
    init local.x
    v0 = handle u64 local.x
    store u64 global.ref, v0
    trap assert
)"),
         "reference Main:0", {{"n", "5"}});
}

// In a loop: each turn traps, and goes on; a try that lies around a loop is left once.
TEST(Try, LoopsWithTries) {
  expect(objects(kTryGlobals, R"(  local temp i : DINT
  b0:
    v0 = const i32 0
    store i32 local.i, v0
    jump b1
  b1:
    try b2, b3
  b2 handler b3:
    v1 = load i32 local.i
    v2 = const i32 1
    v3 = add i32 v1, v2
    store i32 local.i, v3
    v4 = const i32 2
    v5 = mod i32 v3, v4
    v6 = div i32 v3, v5
    end_try b4
  b3:
    v7 = load i32 global.n
    v8 = const i32 1
    v9 = add i32 v7, v8
    store i32 global.n, v9
    jump b4
  b4:
    v10 = load i32 local.i
    v11 = const i32 10
    v12 = lt i32 v10, v11
    branch v12, b1, b5
  b5:
    try b6, b8
  b6 handler b8:
    v13 = load i32 global.d
    v14 = const i32 1
    v15 = add i32 v13, v14
    store i32 global.d, v15
    v16 = const i32 4
    v17 = lt i32 v15, v16
    branch v17, b6, b7
  b7 handler b8:
    end_try b8
  b8:
    return
)"),
         "", {{"n", "5"}, {"d", "4"}});
}

// What a call before the loop returned is gone where the handler begins.
TEST(Try, AHandlerInALoopLeavesNoResults) {
  expect(
      objects(kTryGlobals, R"(b0:
    call One
    jump b1
  b1:
    try b2, b3
  b2 handler b3:
    v0 = load i32 global.zero
    v1 = div i32 v0, v0
    end_try b3
  b3:
    v2 = load i32 global.n
    v3 = const i32 1
    v4 = add i32 v2, v3
    store i32 global.n, v4
    v5 = const i32 3
    v6 = lt i32 v4, v5
    branch v6, b1, b4
  b4:
    return
)",
              "pou function One\n  local return r : DINT\n  b0:\n    init local.r\n    return\n"),
      "", {{"n", "3"}});
}

// The handler lies before its try, because a loop leads back to it.
TEST(Try, RetryLoops) {
  expect(objects(kTryGlobals, R"(b0:
    jump b1
  b1:
    v0 = load i32 global.n
    v1 = const i32 1
    v2 = add i32 v0, v1
    store i32 global.n, v2
    try b2, b1
  b2 handler b1:
    v3 = const i32 3
    v4 = sub i32 v2, v3
    v5 = const i32 2
    v6 = add i32 v4, v5
    v7 = mod i32 v6, v5
    v8 = div i32 v5, v7
    end_try b3
  b3:
    return
)"),
         "", {{"n", "2"}});
}

TEST(Try, StackTrapsAreNeverCaught) {
  expect(objects(kTryGlobals, R"(b0:
    try b1, b2
  b1 handler b2:
    v0 = const i32 3
    store i32 arg(Down).n, v0
    call Down
    end_try b3
  b2:
    jump b3
  b3:
    return
)",
                 R"(pou function Down recursion 2
  local input n : DINT
  b0:
    v0 = load i32 local.n
    store i32 arg(Down).n, v0
    call Down
    return
)"),
         "stack Down:0", {});
}

TEST(Try, FuelIsNeverCaught) {
  const std::string text = objects(kTryGlobals, R"(b0:
    try b1, b2
  b1 handler b2:
    jump b1
  b2:
    v0 = const i32 1
    store i32 global.n, v0
    return
)");
  const ir::Image image = linker::linked(text);
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  const auto generation = vm::Generation::build(*ir::verify(ir::encode(image)), 0, memory.data());
  vm::Execution execution(image.call_depth);
  execution.start(*generation, memory.data(), image.program_ids()[0], ir::kStackBegin, 0);
  EXPECT_EQ(execution.run(1000), vm::Exit::kSuspended);
  EXPECT_EQ(execution.interrupted(ir::TrapKind::kFuel).kind, ir::TrapKind::kFuel);
}

}  // namespace
}  // namespace references
