#include "vm/exec/memory.h"

#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/limits.h"

namespace vm {
namespace {

constexpr size_t kRangeBytes = size_t{1} << 32;

#ifdef STC_EMULATED

// qemu writes a row for each page that is mapped or unmapped. So only what tests
// have something in is mapped: the bottom, and what lies from kMaxDataBytes on. Whoever needs more
// ends by a signal. Ranges lie low in the space of `qemu -R`.
constexpr size_t kBottom = size_t{1} << 28;
constexpr size_t kTop = kRangeBytes - base::kMaxDataBytes;

constexpr uint32_t kRanges = 13;
std::atomic<uint32_t> used_ranges{0};  // a bit for each

bool map_at(uint8_t* at, size_t bytes) {
  return mmap(at, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == at;
}

uint8_t* map_range() {
  for (uint32_t i = 0; i < kRanges; ++i) {
    const uint32_t bit = 1u << i;
    if ((used_ranges.fetch_or(bit) & bit) != 0) continue;
    auto* base = reinterpret_cast<uint8_t*>((i + 1) * kRangeBytes);
    if (map_at(base, kBottom) && map_at(base + base::kMaxDataBytes, kTop)) return base;
  }
  errno = ENOMEM;
  return nullptr;
}

void unmap_range(uint8_t* base) {
  munmap(base, kBottom);
  munmap(base + base::kMaxDataBytes, kTop);
  used_ranges.fetch_and(~(1u << (reinterpret_cast<uintptr_t>(base) / kRangeBytes - 1)));
}

#else

// After the last offset: the longest value (kMaxTypeBytes) and any displacement.
constexpr size_t kGuard = size_t{3} << 30;

uint8_t* map_range() {
  void* range = mmap(nullptr, kRangeBytes + kGuard, PROT_NONE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range == MAP_FAILED) return nullptr;
  if (mprotect(range, kRangeBytes, PROT_READ | PROT_WRITE) == 0)
    return static_cast<uint8_t*>(range);
  const int reason = errno;
  munmap(range, kRangeBytes + kGuard);
  errno = reason;
  return nullptr;
}

void unmap_range(uint8_t* base) { munmap(base, kRangeBytes + kGuard); }

#endif

}  // namespace

base::Result<Memory> Memory::reserve() {
  if (uint8_t* range = map_range()) return Memory(range);
  return base::Error{base::Refusal::kTooLarge,
                     std::string("cannot reserve 7 GiB of address space for data memory: ") +
                         std::strerror(errno) +
                         "; raise `ulimit -v` and `ulimit -d`, and leave vm.overcommit_memory "
                         "at 0 or 1: memory is used only where the program has data"};
}

Memory::Memory(Memory&& other) noexcept : base_(std::exchange(other.base_, nullptr)) {}

Memory& Memory::operator=(Memory&& other) noexcept {
  std::swap(base_, other.base_);
  return *this;
}

Memory::~Memory() {
  if (base_ != nullptr) unmap_range(base_);
}

std::span<const uint8_t> Memory::view() const { return {base_, kRangeBytes}; }

}  // namespace vm
