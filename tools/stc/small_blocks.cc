// operator new and delete of stc: a compiler makes and drops many small blocks. Each size has a
// list of free blocks, which a thread has for itself, and nothing is ever gathered or given back:
// that is a quarter less time for a build than with the C library's heap. Large blocks are runs of
// whole spans; what a phase frees of them, the next one takes, be it for large blocks or small
// ones. What is in between, and everything when the range of addresses cannot be had, comes from
// malloc. All of it counts towards the budget (memory_budget.h). Left out of builds with
// sanitizers, which want to see every block (CMakeLists.txt).
#include <malloc.h>
#include <sys/mman.h>

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "tools/stc/memory_budget.h"

namespace {

constexpr size_t kRange = size_t{16} << 30;  // of addresses; memory only where blocks are
constexpr size_t kSpan = 64 << 10;           // blocks of one size
constexpr size_t kFine = 1024;  // up to here a size every 16 bytes, then 4 per doubling
constexpr size_t kLargest = 16 << 10;
constexpr size_t kSizes = kFine / 16 + 1 + 4 * 4;
constexpr size_t kLeastRun = 128 << 10;  // larger blocks are runs of spans
constexpr size_t kReturned = 32 << 20;   // tools::keep_freed_memory

constexpr size_t number_of(size_t size) {
  if (size <= kFine) return (size + 15) / 16;
  const int shift = std::bit_width(size - 1) - 3;  // of a quarter of the power of two below
  return kFine / 16 + static_cast<size_t>(shift - 8) * 4 + ((size - 1) >> shift) - 3;
}
constexpr size_t size_of(size_t number) {
  if (number <= kFine / 16) return number == 0 ? 16 : number * 16;
  const size_t step = number - kFine / 16 - 1;
  return (5 + step % 4) << (8 + step / 4);
}
constexpr bool sizes_fit() {
  for (size_t size = 0; size <= kLargest; ++size) {
    const size_t number = number_of(size);
    if (number >= kSizes || size_of(number) < size) return false;
    if (size > 16 && size_of(number - 1) >= size) return false;
  }
  return number_of(kLargest) == kSizes - 1;
}
static_assert(sizes_fit());

struct FreeBlock {
  FreeBlock* next;
};

// What one thread has; when it ends, the next thread goes on with it.
struct Lists {
  std::array<FreeBlock*, kSizes> freed{};
  std::array<uintptr_t, kSizes> fresh{};  // the part of a span that was never used
  std::array<uintptr_t, kSizes> fresh_end{};
  Lists* next = nullptr;
};

// Marks the first and the last span of a run, instead of the number of a size.
constexpr uint8_t kFreeRun = 0xfe;
constexpr uint8_t kLargeBlock = 0xff;
static_assert(kSizes <= kFreeRun);

constexpr size_t kNoSpan = ~size_t{0};
constexpr size_t kSpans = kRange / kSpan;

struct Run {
  uint32_t length = 0;  // in spans; of free runs also at the last span
  // In free runs: neighbours in the list, a span plus 1; 0: none.
  uint32_t next = 0;
  uint32_t before = 0;
};

struct Range {
  std::mutex mutex;
  uintptr_t begin = 0;  // 0: not asked for yet; 1: it cannot be had
  size_t spans = 0;     // given out
  Lists* without_thread = nullptr;
};
constinit Range range;
constinit std::atomic<uintptr_t> range_begin{0};  // once there are blocks
constinit std::array<uint8_t, kSpans> numbers{};  // by span: of the size of its blocks
constinit std::array<Run, kSpans> runs{};         // by first span
constinit std::array<uint32_t, 20> free_runs{};   // by bit width of the length: a span plus 1
constinit thread_local Lists* lists = nullptr;

void* from_malloc(size_t size) {
  for (;;) {
    if (stc::take_memory(size)) {
      if (void* block = std::malloc(size == 0 ? 1 : size)) {
        const size_t usable = ::malloc_usable_size(block);  // what is given back
        if (usable > size) stc::count_memory(usable - size);
        return block;
      }
      stc::give_memory(size);
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) std::__throw_bad_alloc();
    handler();
  }
}

void to_malloc(void* block) {
  if (block != nullptr) stc::give_memory(::malloc_usable_size(block));
  std::free(block);
}

struct Leave {
  ~Leave() {
    const std::lock_guard lock(range.mutex);
    lists->next = range.without_thread;
    range.without_thread = lists;
    lists = nullptr;
  }
};

bool join() {
  {
    const std::lock_guard lock(range.mutex);
    lists = range.without_thread;
    if (lists != nullptr) range.without_thread = lists->next;
  }
  if (lists == nullptr) {
    void* memory = std::calloc(1, sizeof(Lists));
    if (memory == nullptr) return false;
    lists = ::new (memory) Lists;
  }
  static thread_local Leave leave;
  return true;
}

// --- runs of spans; the lock is held -----------------------------------------

void put_free(size_t span, size_t length) {
  numbers[span] = kFreeRun;
  numbers[span + length - 1] = kFreeRun;
  runs[span + length - 1].length = static_cast<uint32_t>(length);
  uint32_t& first = free_runs[static_cast<size_t>(std::bit_width(length))];
  runs[span] = {static_cast<uint32_t>(length), first, 0};
  if (first != 0) runs[first - 1].before = static_cast<uint32_t>(span + 1);
  first = static_cast<uint32_t>(span + 1);
}

void take_free(size_t span) {
  const Run& run = runs[span];
  const auto width = static_cast<size_t>(std::bit_width(run.length));
  (run.before != 0 ? runs[run.before - 1].next : free_runs[width]) = run.next;
  if (run.next != 0) runs[run.next - 1].before = run.before;
}

// A free run of at least this length.
size_t find_free(size_t length) {
  constexpr int kMost = 64;  // runs to look at
  int looked = 0;
  for (auto width = static_cast<size_t>(std::bit_width(length)); width < free_runs.size();
       ++width) {
    for (uint32_t at = free_runs[width]; at != 0 && looked < kMost; at = runs[at - 1].next) {
      if (runs[at - 1].length >= length) return at - 1;
      ++looked;
    }
    looked = 0;
  }
  return kNoSpan;
}

bool has_range() {
  if (range.begin == 0) {
    void* all = mmap(nullptr, kRange + kSpan, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    range.begin = 1;
    if (all == MAP_FAILED) return 0;
    range.begin = (reinterpret_cast<uintptr_t>(all) + kSpan - 1) / kSpan * kSpan;
    madvise(reinterpret_cast<void*>(range.begin), kRange, MADV_HUGEPAGE);  // fewer page faults
    range_begin.store(range.begin, std::memory_order_relaxed);
  }
  return range.begin != 1;
}

// The first span; kNoSpan when there is no such run.
size_t take_run(size_t length) {
  if (!has_range()) return kNoSpan;
  if (const size_t span = find_free(length); span != kNoSpan) {
    const size_t found = runs[span].length;
    take_free(span);
    if (found > length) put_free(span + length, found - length);
    return span;
  }
  if (kSpans - range.spans < length || !stc::take_memory(length * kSpan)) return kNoSpan;
  range.spans += length;
  return range.spans - length;
}

// Joins its neighbours that are free.
void give_run(size_t span) {
  size_t length = runs[span].length;
  if (span > 0 && numbers[span - 1] == kFreeRun) {
    const size_t before = runs[span - 1].length;
    span -= before;
    length += before;
    take_free(span);
  }
  if (const size_t next = span + length; next < range.spans && numbers[next] == kFreeRun) {
    length += runs[next].length;
    take_free(next);
  }
  put_free(span, length);
}

// --- blocks --------------------------------------------------------------------
// What is seldom stays out of line, so that the usual way saves no registers.

// A span for blocks of one size; 0 when there is none.
uintptr_t new_span(size_t number) {
  const std::lock_guard lock(range.mutex);
  const size_t span = take_run(1);
  if (span == kNoSpan) return 0;
  numbers[span] = static_cast<uint8_t>(number);
  return range.begin + span * kSpan;
}

[[gnu::noinline]] void* large_block(size_t size) {
  // What the C library maps for one block goes back to the system when it is freed.
  const bool returned = size >= kReturned && stc::is_memory_scarce(size);
  if (size >= kRange || returned) return from_malloc(size);
  const std::lock_guard lock(range.mutex);
  const size_t length = (size + kSpan - 1) / kSpan;
  const size_t span = take_run(length);
  if (span == kNoSpan) return from_malloc(size);
  numbers[span] = kLargeBlock;
  numbers[span + length - 1] = kLargeBlock;
  runs[span].length = static_cast<uint32_t>(length);
  return reinterpret_cast<void*>(range.begin + span * kSpan);
}

[[gnu::noinline]] void* fresh_block(size_t size, size_t number) {
  if (lists == nullptr && !join()) return from_malloc(size);
  if (FreeBlock* block = lists->freed[number]) {  // of a thread that ended
    lists->freed[number] = block->next;
    return block;
  }
  const size_t bytes = size_of(number);
  if (lists->fresh_end[number] - lists->fresh[number] < bytes) {
    const uintptr_t span = new_span(number);
    if (span == 0) return from_malloc(size);
    lists->fresh[number] = span;
    lists->fresh_end[number] = span + kSpan;
  }
  const uintptr_t block = lists->fresh[number];
  lists->fresh[number] += bytes;
  return reinterpret_cast<void*>(block);
}

// A large block, or the first thing that a thread frees.
[[gnu::noinline]] void seldom_freed(void* memory, size_t number) {
  if (number == kLargeBlock) {
    const std::lock_guard lock(range.mutex);
    return give_run((reinterpret_cast<uintptr_t>(memory) - range.begin) / kSpan);
  }
  if (join()) lists->freed[number] = ::new (memory) FreeBlock{lists->freed[number]};
}

}  // namespace

void* operator new(size_t size) {
  if (size > kLargest) return size > kLeastRun ? large_block(size) : from_malloc(size);
  const size_t number = number_of(size);
  if (lists == nullptr || lists->freed[number] == nullptr) return fresh_block(size, number);
  FreeBlock* block = lists->freed[number];
  lists->freed[number] = block->next;
  return block;
}

void operator delete(void* memory) noexcept {
  const uintptr_t begin = range_begin.load(std::memory_order_relaxed);
  const uintptr_t at = reinterpret_cast<uintptr_t>(memory) - begin;
  if (begin == 0 || at >= kRange) return to_malloc(memory);
  const size_t number = numbers[at / kSpan];
  if (number == kLargeBlock || lists == nullptr) return seldom_freed(memory, number);
  lists->freed[number] = ::new (memory) FreeBlock{lists->freed[number]};
}

void operator delete(void* memory, size_t) noexcept { operator delete(memory); }
