// The heap of stc, which this program is linked with (but for sanitizers, which have their own).
#include <gtest/gtest.h>

#include <algorithm>
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
#ifndef STC_SMALL_BLOCKS
  GTEST_SKIP() << "under sanitizers the heap is theirs";
#endif
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

TEST(SmallBlocks, LargeBlocksAreApartWhileTheyLive) {
  base::for_each_index(4, 4, 1, [](size_t thread) {
    std::minstd_rand random(static_cast<unsigned>(thread) + 1);
    std::vector<Block> live(24);
    for (int step = 0; step < 600; ++step) {
      Block& block = live[random() % live.size()];
      if (block.bytes != nullptr) {
        base::check(is_whole(block), "nobody else wrote into the block");
        ::operator delete(block.bytes);
      }
      block = make(random() % (size_t{1} << (10 + random() % 11)),
                   static_cast<unsigned char>(random()));
    }
    for (const Block& block : live) {
      base::check(block.bytes == nullptr || is_whole(block), "nobody else wrote into the block");
      ::operator delete(block.bytes);
    }
  });
}

TEST(SmallBlocks, WhatLargeBlocksLeaveIsForAllSizes) {
#ifndef STC_SMALL_BLOCKS
  GTEST_SKIP() << "under sanitizers the heap is theirs";
#endif
  constexpr size_t kPart = size_t{400} << 20;  // of addresses; larger than what others left
  void* parts[3];
  for (void*& part : parts) part = ::operator new(kPart);
  const auto* begin = static_cast<unsigned char*>(*std::min_element(parts, parts + 3));
  for (const size_t part : {0, 2, 1}) ::operator delete(parts[part]);  // the last joins both
  // What is free in front of them may be joined, too.
  const auto overlaps = [&](const void* block, size_t size) {
    const auto* at = static_cast<const unsigned char*>(block);
    return at < begin + 3 * kPart && at + size > begin;
  };
  void* whole = ::operator new(kPart * 5 / 2);
  EXPECT_TRUE(overlaps(whole, kPart * 5 / 2));
  ::operator delete(whole);
  std::vector<void*> small;
  do {
    small.push_back(::operator new(15'000));
  } while (!overlaps(small.back(), 1) && small.size() < 20'000);
  EXPECT_TRUE(overlaps(small.back(), 1));
  for (void* block : small) ::operator delete(block);
}

TEST(SmallBlocks, MemoryThatRunsOutIsStillAnException) {
#ifdef STC_SANITIZED_HEAP
  GTEST_SKIP() << "a sanitizer ends the process when memory runs out";
#endif
  bool ran_out = false;
  try {
    ::operator delete(::operator new(SIZE_MAX / 4));
  } catch (const std::bad_alloc&) {
    ran_out = true;
  }
  EXPECT_TRUE(ran_out);
}

}  // namespace
