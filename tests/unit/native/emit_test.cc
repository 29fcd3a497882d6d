// Functions of the machine that this runs on, called as the interpreter calls them.
#include <gtest/gtest.h>

#include "vm/exec/context.h"
#include "vm/native/arm64/emitter.h"
#include "vm/native/code_memory.h"
#include "vm/native/host.h"
#include "vm/native/x64/emitter.h"

namespace vm::native {
namespace {

constexpr uint32_t kSmall = 100;
constexpr uint32_t kLarge = 200'000;  // more than the short branches of AArch64 reach

// Leaves at unit i when the frame begins with the number i, and returns when it is `count` or more.
Function leaves_where_the_frame_says(uint32_t count) {
  Function f;
  f.blocks.resize(1);
  Node load;
  load.op = Op::kLoad;
  load.width = 4;
  load.result = 0;
  f.values.push_back({false, 4, false, 0, 0, 0});
  f.nodes.push_back(load);
  for (uint32_t i = 0; i < count; ++i) {
    Node leave;
    leave.op = Op::kExitIf;
    leave.width = 4;
    leave.in[0] = 0;
    leave.in[1] = static_cast<Val>(f.values.size());
    leave.exit = i;
    f.values.push_back({false, 4, true, i, kNone, 0});
    f.nodes.push_back(leave);
    f.exits.emplace_back().unit = i;
  }
  for (uint32_t n = 0; n < f.nodes.size(); ++n) f.blocks[0].nodes.push_back(n);
  f.blocks[0].end.exit = count;
  f.exits.emplace_back().unit = count;
  return f;
}

template <class Assembler, class Emitter, class Shared, class HostTarget>
uint32_t emit(const Function& f, Assembler& a, Shared& shared) {
  const HostTarget target;
  const base::Result<Allocated> places = allocate(f, target, {});
  EXPECT_TRUE(places.ok());
  const SideUnits side;
  const PouCode pou{&f, &*places, &side, nullptr, 7};
  const Entries entries = Emitter(pou, shared, a).run();
  a.patch();
  return entries.begin;
}

class Native {
 public:
  explicit Native(uint32_t count) {
    shared_ = host::emit_shared(a_);
    begin_ = emit<host::Assembler, host::Emitter, host::Shared, host::HostTarget>(
        leaves_where_the_frame_says(count), a_, shared_);
    code_ = CodeMemory::make(a_.code());
  }
  // The unit where it left; kNone: it returned.
  uint32_t operator()(uint32_t number) {
    using Enter = uint64_t (*)(const void*, uint8_t*, uint8_t*, uint8_t*, Context*);
    const uint8_t* const enter = code_->data() + a_.offset_of(shared_.enter);
    Context context;
    context.call = &record_;
    context.fuel = 42;
    uint8_t frame[16] = {};
    std::memcpy(frame, &number, sizeof number);
    const uint64_t left = reinterpret_cast<Enter>(reinterpret_cast<uintptr_t>(enter))(
        code_->data() + begin_, frame, nullptr, nullptr, &context);
    EXPECT_EQ(context.fuel, 42u);
    if (left == 0) return kNone;
    EXPECT_EQ(context.pou, 7u);
    EXPECT_EQ(context.frame, frame);
    return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(context.pc) / sizeof(ir::Unit));
  }

 private:
  host::Assembler a_;
  host::Shared shared_{};
  uint32_t begin_ = 0;
  std::shared_ptr<const CodeMemory> code_;
  CallRecord record_{};
};

TEST(Emit, ExitsLeaveAtTheirUnit) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  Native run(kSmall);
  for (uint32_t i = 0; i < kSmall; ++i) EXPECT_EQ(run(i), i);
  EXPECT_EQ(run(kSmall), kNone);
}

TEST(Emit, BranchesReachHoweverLargeTheFunctionIs) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  Native run(kLarge);
  for (const uint32_t i : {0u, 1u, 4095u, 4096u, 65536u, 131'071u, kLarge - 1})
    EXPECT_EQ(run(i), i);
  EXPECT_EQ(run(kLarge), kNone);
}

// Both back ends compile everywhere; what is short stays short.
TEST(Emit, OnlyLargeFunctionsHaveLongBranches) {
  const auto bytes = [](uint32_t count) {
    arm64::Assembler a;
    arm64::Shared shared = arm64::emit_shared(a);
    const size_t before = a.code().size();
    emit<arm64::Assembler, arm64::Emitter, arm64::Shared, arm64::Arm64Target>(
        leaves_where_the_frame_says(count), a, shared);
    return (a.code().size() - before) / count;
  };
  EXPECT_LT(bytes(4000), 20u);
  EXPECT_GT(bytes(kLarge), 30u);
}

}  // namespace
}  // namespace vm::native
