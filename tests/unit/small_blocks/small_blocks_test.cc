// The heap of stc, which this program is linked with (but for sanitizers, which have their own).
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <random>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"

namespace {

struct Block {
  unsigned char* bytes;
  size_t size;
  unsigned char mark;
};

Block make(size_t size, unsigned char mark) {
  auto* bytes = static_cast<unsigned char*>(::operator new(size));
  std::memset(bytes, mark, size);
  return {bytes, size, mark};
}

bool is_whole(const Block& block) {
  for (size_t i = 0; i < block.size; ++i) {
    if (block.bytes[i] != block.mark) return false;
  }
  return true;
}

// Whatever is live at the same time overlaps nowhere, on the border of every size.
TEST(SmallBlocks, BlocksOfEverySizeAreAlignedAndApart) {
  std::vector<Block> live;
  for (size_t size = 0; size < 40'000; size += size < 1100 ? 1 : 127) {
    live.push_back(make(size, static_cast<unsigned char>(size)));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(live.back().bytes) % 16, 0u) << size;
  }
  for (const Block& block : live) {
    EXPECT_TRUE(is_whole(block)) << block.size;
    ::operator delete(block.bytes, block.size);
  }
}

TEST(SmallBlocks, WhatIsFreedIsTakenAgain) {
  size_t taken_again = 0;
  for (size_t size = 1; size <= 1024; ++size) {
    void* first = ::operator new(size);
    ::operator delete(first);
    void* second = ::operator new(size);
    taken_again += first == second;
    ::operator delete(second);
  }
  EXPECT_GE(taken_again, 1000u);
  ::operator delete(nullptr);
}

// Made on some threads, freed on others, which end in between.
TEST(SmallBlocks, BlocksGoFromThreadToThread) {
  std::vector<Block> live(64'000);
  for (int round = 0; round < 6; ++round) {
    base::for_each_index(live.size(), 4, 100, [&](size_t i) {
      std::minstd_rand random(static_cast<unsigned>(i + 1) * 77 + static_cast<unsigned>(round));
      if (live[i].bytes != nullptr) {
        base::check(is_whole(live[i]), "nobody else wrote into the block");
        ::operator delete(live[i].bytes);
      }
      live[i] = make(random() % 700, static_cast<unsigned char>(random()));
    });
  }
  for (const Block& block : live) {
    EXPECT_TRUE(is_whole(block));
    ::operator delete(block.bytes);
  }
}

TEST(SmallBlocks, MemoryThatRunsOutIsStillAnException) {
  bool ran_out = false;
  try {
    ::operator delete(::operator new(SIZE_MAX / 4));
  } catch (const std::bad_alloc&) {
    ran_out = true;
  }
  EXPECT_TRUE(ran_out);
}

}  // namespace
