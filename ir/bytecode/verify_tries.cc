// TRY and END_TRY: every unit has its open tries, whichever way was taken, and none is open at a
// return.
#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/verify_code.h"

namespace ir::verification {

// The handler is forwards, so that code goes back by LOOP and calls only: those take fuel.
bool CodeVerifier::check_try(uint32_t next) {
  if (!jump(next, false)) return false;
  const uint32_t handler = merge_at(next + u_.bc());
  arrivals_[handler].results = {};
  const uint32_t depth = scopes_[scope_].depth + 1;
  if (depth > base::kMaxTryDepth) {
    return fail(Refusal::kStackUnbounded, std::to_string(depth) + " tries inside each other");
  }
  const auto [known, added] =
      scope_numbers_.try_emplace({scope_, handler}, static_cast<uint32_t>(scopes_.size()));
  if (added) scopes_.push_back({scope_, handler, depth});
  scope_ = known->second;
  return true;
}

bool CodeVerifier::check_end_try() {
  if (scope_ == 0) return fail(Refusal::kBadJump, "no try is open");
  scope_ = scopes_[scope_].parent;
  return true;
}

// A trap may come right after the write, and then a handler finds this addr in the slot.
bool CodeVerifier::outlives_traps(uint32_t slot, const Pointer& pointer) {
  for (uint32_t scope = scope_; scope != 0; scope = scopes_[scope].parent) {
    const uint32_t handler = scopes_[scope].handler;
    const std::vector<uint16_t>& slots = pou_.merges[handler].slots;
    const auto found = std::lower_bound(slots.begin(), slots.end(), slot);
    if (found == slots.end() || *found != slot) continue;
    const auto number = static_cast<size_t>(found - slots.begin());
    const size_t arrival = arrivals_[handler].slots + number;
    if (pointer.outgoing == 0 && (!pointer.read_only || arrives_read_only_[arrival])) continue;
    return fail(Refusal::kBadTyping, "the slot at " + std::to_string(pou_.slots[slot].offset) +
                                         " gets what its handler cannot use");
  }
  return true;
}

}  // namespace ir::verification
