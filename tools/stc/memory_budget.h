// How much memory stc may take: kMaxBuildBytes, or kMaxBuildBytesPerByte for each byte that it has
// read, whichever is more (base/tool_limits.def). A short source can describe what no machine has
// room for: one that needs more is refused by name before the machine runs out of memory. Where the
// machine gives less than that (`ulimit -v`), the message says so. A container that has less does
// not refuse memory, it kills the process. In the first two cases the process ends at once, with
// exit code 7 and whatever it has on disk as it was: memory runs out in the middle of any step and
// on any thread, and nothing that is half done is worth keeping.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stc {

// From now on, memory is limited, and running out of it is a message. At the start of the process.
void limit_memory();
// Sources of `bytes` in all, or an image of that size, were read: the largest ones count.
void expect_input(uint64_t bytes);

// For whoever gives out memory (small_blocks.cc).
// May `bytes` more be taken? Counts them when they may.
bool take_memory(size_t bytes) noexcept;
// Counts bytes that are taken already.
void count_memory(size_t bytes) noexcept;
void give_memory(size_t bytes) noexcept;
// Would more than half of the budget be taken, with `bytes` more?
bool is_memory_scarce(size_t bytes) noexcept;

}  // namespace stc
