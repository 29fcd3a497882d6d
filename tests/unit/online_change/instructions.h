// Counts the instructions of a call, exactly and without the processor's counters: a child process
// makes the call, and its parent lets it go one instruction at a time (Linux). System calls count
// as one. The call's effects stay in the child. Slow: some 20,000 instructions in a second.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace plant {

// Nullopt: where one process may not trace another, or it ended before the call did.
std::optional<uint64_t> count_instructions(const std::function<void()>& call);

}  // namespace plant
