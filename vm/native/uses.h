// When values are used: positions count up through the blocks in their order.
#pragma once

#include <span>
#include <vector>

#include "vm/native/allocate.h"

namespace vm::native {

class Uses {
 public:
  Uses(const Function& function, const Target& target);

  uint32_t begin_of(Block block) const { return begins_[block]; }  // its parameters
  uint32_t end_of(Block block) const { return ends_[block]; }      // its last instruction
  uint32_t loop_end(uint32_t loop) const { return ends_[function_.loops[loop].last]; }
  // The next use at or after the position that advance() has reached; kNone: none.
  uint32_t next(Val v) const {
    const uint32_t at = cursor_[v];
    return at < first_[v + 1] ? uses_[at] : kNone;
  }
  // Uses up to `position` are over.
  void advance(Val v, uint32_t position) {
    uint32_t& at = cursor_[v];
    while (at < first_[v + 1] && uses_[at] <= position) ++at;
  }
  // Values that something after the block's beginning uses, whichever way leads there; sorted.
  // Constants and the block's own parameters are none of them.
  std::span<const Val> live_in(Block block) const {
    return {live_.data() + first_live_[block], live_.data() + first_live_[block + 1]};
  }
  const std::vector<Val>& constants() const { return constants_; }  // that want a register

 private:
  struct Use {
    Val v = kNone;
    uint32_t at = 0;
    Block block = 0;
  };
  std::vector<Use> all_uses(const Target& target) const;
  void find_live(const std::vector<Use>& all, const std::vector<uint32_t>& defined);

  const Function& function_;
  std::vector<uint32_t> begins_, ends_;
  std::vector<uint32_t> first_, uses_, cursor_;
  std::vector<Val> constants_;
  std::vector<uint32_t> first_live_;  // by block, in `live_`
  std::vector<Val> live_;
};

}  // namespace vm::native
