// NextFrame says whose arguments and results lie in the next frame, at each point of the code of a
// POU: those of the call that comes next, and of the one that was last (V12 says that they are
// clear).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "ir/bytecode/image.h"

namespace linker {

// A call that has arguments in the frame.
struct CallOf {
  bool native = false;
  uint32_t number = 0;  // of the POU, or of the native function
  friend bool operator==(const CallOf&, const CallOf&) = default;
};

class NextFrame {
 public:
  explicit NextFrame(std::span<const ir::Unit> code);

  // The walk over the code: before the unit's fields are looked at, and after.
  void enter(uint32_t unit);
  void leave(uint32_t unit);

  // The call of what is written to `offset` of the next frame by this unit.
  std::optional<CallOf> write(uint32_t offset);
  // The call of what is read there: an argument that was put there before, or a result.
  std::optional<CallOf> read(uint32_t offset) const;
  // The call of a pointer to there that this unit makes in frame slot `slot`: what is done with it
  // says.
  std::optional<CallOf> point(uint32_t offset, uint16_t slot);

 private:
  std::optional<CallOf> next_call() const;
  bool is_filled(uint16_t slot) const;

  std::span<const ir::Unit> code_;
  uint32_t at_ = 0;
  bool reached_ = true;       // from the unit before
  uint32_t switch_left_ = 0;  // jumps of the last switch that are still to come
  std::optional<CallOf> last_;
  std::unordered_set<uint32_t> put_;                              // since the last call
  std::unordered_map<uint32_t, std::optional<CallOf>> arriving_;  // by unit: after jumps to it
};

}  // namespace linker
