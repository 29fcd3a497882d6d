// What stc may take: counted for every block, given back with it, and refused by name. Each test is
// a process of its own, since the budget holds for one and ends it.
#include "tools/stc/memory_budget.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <new>

#ifdef STC_SMALL_BLOCKS

namespace stc {
namespace {

using testing::ExitedWithCode;

constexpr size_t kBlock = size_t{256} << 20;  // of addresses: nobody writes there

[[noreturn]] void take_blocks(int count, int to_keep) {
  for (int i = 0; i < count; ++i) {
    void* block = ::operator new(kBlock);
    if (i >= to_keep) ::operator delete(block);
  }
  ::_exit(0);
}

TEST(MemoryBudget, MoreThanItIsRefusedByName) {
  const auto nine = [] {
    limit_memory();
    take_blocks(9, 9);
  };
  EXPECT_EXIT(nine(), ExitedWithCode(7), "R0118: .*more than 2048 MiB for 0 bytes of input");
}

TEST(MemoryBudget, WhatIsGivenBackCountsNoMore) {
  const auto one_by_one = [] {
    limit_memory();
    take_blocks(40, 5);  // what comes when half of the budget is taken goes back to the system
  };
  EXPECT_EXIT(one_by_one(), ExitedWithCode(0), "");
}

TEST(MemoryBudget, ItGrowsWithTheInput) {
  const auto of_64_mib = [](int blocks) {
    limit_memory();
    expect_input(uint64_t{64} << 20);
    expect_input(1);  // the largest one counts
    take_blocks(blocks, blocks);
  };
  EXPECT_EXIT(of_64_mib(9), ExitedWithCode(0), "");
  EXPECT_EXIT(of_64_mib(11), ExitedWithCode(7), "more than 2560 MiB for 67108864 bytes of input");
}

TEST(MemoryBudget, WhatTheMachineRefusesIsSaidToBeThat) {
  const auto on_a_small_machine = [] {
    limit_memory();
    const rlimit least{1 << 20, 1 << 20};
    ::setrlimit(RLIMIT_AS, &least);
    take_blocks(9, 9);
  };
  EXPECT_EXIT(on_a_small_machine(), ExitedWithCode(7), "the machine gives no more than");
}

}  // namespace
}  // namespace stc

#endif
