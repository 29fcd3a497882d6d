// Functions of the machine that this runs on, called as the interpreter calls them.
#include <gtest/gtest.h>

#include "vm/exec/context.h"
#include "vm/native/arm64/emitter.h"
#include "vm/native/code_memory.h"
#include "vm/native/host.h"
#include "vm/native/jump_tables.h"
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

// The same by a tree of comparisons with the number of `width` bytes; each way also passes 1000 + i
// on, which its exit stores at frame[8].
Function forks_where_the_frame_says(uint32_t count, uint8_t width) {
  Function f;
  f.blocks.resize(2 * count + 1);
  Node load;
  load.op = Op::kLoad;
  load.width = width;
  load.result = 0;
  f.values.push_back({false, width, false, 0, 0, 0});
  f.nodes.push_back(load);
  f.blocks[0].nodes.push_back(0);
  const auto constant = [&](uint64_t bits, uint8_t bytes) {
    f.values.push_back({false, bytes, true, bits, kNone, 0});
    return static_cast<Val>(f.values.size() - 1);
  };
  for (uint32_t i = 0; i <= count; ++i) {
    BasicBlock& way = f.blocks[count + i];
    const auto passed = static_cast<Val>(f.values.size());
    f.values.push_back({false, 4, false, 0, kNone, count + i});
    way.params.push_back(passed);
    way.end.kind = EndKind::kExit;
    way.end.exit = i;
    f.exits.emplace_back().unit = i;
    f.exits.back().slots.push_back({8, 4, passed});
  }
  Block next = 0;
  const auto grow = [&](const auto& self, uint32_t first, uint32_t last) -> Block {
    if (last == first) return count + first;
    const Block fork = next++;
    const uint32_t middle = first + (last - first + 1) / 2;
    const Block ways[] = {self(self, first, middle - 1), self(self, middle, last)};
    End& end = f.blocks[fork].end;
    end.kind = EndKind::kBranch;
    end.cond = Cond::kLtU;
    end.width = width;
    end.in[0] = 0;
    end.in[1] = constant(middle, width);
    for (uint32_t i = 0; i < 2; ++i) {
      end.target[i] = ways[i];
      if (ways[i] >= count) end.args[i].push_back(constant(1000 + ways[i] - count, 4));
    }
    return fork;
  };
  grow(grow, 0, count);
  return f;
}

template <class Assembler, class Emitter, class HostTarget>
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
  explicit Native(uint32_t count) : Native(leaves_where_the_frame_says(count)) {}
  explicit Native(const Function& function) {
    shared_ = host::emit_shared(a_);
    begin_ =
        emit<host::Assembler, host::Emitter, host::HostTarget>(function, a_, shared_);
    code_ = CodeMemory::make(a_.code());
  }
  // The unit where it left; kNone: it returned.
  uint32_t operator()(uint64_t number, uint32_t* stored = nullptr) {
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
    if (stored != nullptr) std::memcpy(stored, frame + 8, sizeof *stored);
    if (left == 0) return kNone;
    EXPECT_EQ(context.pou, 7u);
    EXPECT_EQ(context.frame, frame);
    return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(context.pc) / sizeof(ir::Unit));
  }

 private:
  host::Assembler a_;
  Shared shared_{};
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

TEST(Emit, ManyWaysAreOneJumpThroughATable) {
  constexpr uint32_t kWays = 200;
  for (const uint8_t width : {1, 2, 4, 8}) {
    const Function f = forks_where_the_frame_says(kWays, width);
    const auto places = allocate(f, host::HostTarget(), {});
    ASSERT_TRUE(places.ok());
    const auto table = JumpTables(f, *places, 0).at(0);
    ASSERT_TRUE(table.has_value());
    EXPECT_EQ(table->ways.size(), kWays);
    EXPECT_FALSE(JumpTables(f, *places, kWays + 2).at(0).has_value());
    if (!host::kIsAvailable) continue;
    Native run(f);
    const uint64_t most = ~uint64_t{0} >> (64 - 8 * width);
    for (uint64_t number = 0; number < 256; ++number) {
      const auto way = static_cast<uint32_t>(std::min<uint64_t>(number, kWays));
      uint32_t stored = 0;
      // What stands above the number is not asked.
      EXPECT_EQ(run(number | (uint64_t{0x1234567812345678} & ~most), &stored), way);
      EXPECT_EQ(stored, 1000 + way);
    }
    EXPECT_EQ(run(most), kWays);
    EXPECT_EQ(run(most / 2 + 1), std::min<uint64_t>(most / 2 + 1, kWays));
  }
}

// Both back ends compile everywhere; what is short stays short.
TEST(Emit, OnlyLargeFunctionsHaveLongBranches) {
  const auto bytes = [](uint32_t count) {
    arm64::Assembler a;
    Shared shared = arm64::emit_shared(a);
    const size_t before = a.code().size();
    emit<arm64::Assembler, arm64::Emitter, arm64::Arm64Target>(
        leaves_where_the_frame_says(count), a, shared);
    return (a.code().size() - before) / count;
  };
  EXPECT_LT(bytes(4000), 20u);
  EXPECT_GT(bytes(kLarge), 30u);
}

}  // namespace
}  // namespace vm::native
