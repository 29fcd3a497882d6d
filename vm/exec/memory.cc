#include "vm/exec/memory.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace vm {
namespace {

#ifdef STC_EMULATED
// qemu has a row for each page that is reserved, and writes all of them each time. Enough for all
// that tests have; whoever needs more ends by a signal.
constexpr size_t kBytes = size_t{1} << 28;
constexpr size_t kGuard = size_t{1} << 26;
#else
constexpr size_t kBytes = size_t{1} << 32;
// After the last offset: the longest value (kMaxTypeBytes) and any displacement.
constexpr size_t kGuard = size_t{3} << 30;
#endif

}  // namespace

base::Result<Memory> Memory::reserve() {
  void* range =
      mmap(nullptr, kBytes + kGuard, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range == MAP_FAILED || mprotect(range, kBytes, PROT_READ | PROT_WRITE) != 0) {
    const int reason = errno;
    if (range != MAP_FAILED) munmap(range, kBytes + kGuard);
    return base::Error{base::Refusal::kTooLarge,
                       std::string("cannot reserve 7 GiB of address space for data memory: ") +
                           std::strerror(reason) +
                           "; raise `ulimit -v` and `ulimit -d`, and leave vm.overcommit_memory "
                           "at 0 or 1: memory is used only where the program has data"};
  }
  return Memory(static_cast<uint8_t*>(range));
}

Memory::Memory(Memory&& other) noexcept : base_(std::exchange(other.base_, nullptr)) {}

Memory& Memory::operator=(Memory&& other) noexcept {
  std::swap(base_, other.base_);
  return *this;
}

Memory::~Memory() {
  if (base_ != nullptr) munmap(base_, kBytes + kGuard);
}

std::span<const uint8_t> Memory::view() const { return {base_, kBytes}; }

}  // namespace vm
