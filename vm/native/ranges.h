// Which numbers a value can be, as far as its making says, and what that relies on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "vm/native/lir.h"

namespace vm::native {

struct Range {
  int64_t low = INT64_MIN;
  int64_t high = INT64_MAX;
};
Range whole(uint8_t width);  // of a signed number
int64_t as_signed(uint64_t bits, uint8_t width);
// All bits of a number of `width` bytes.
constexpr uint64_t mask(uint8_t width) {
  return width == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * width)) - 1;
}

// What a counter must be where its loop begins, whoever wrote it.
struct Assumption {
  Block front = 0;
  Val counter = kNone;
  bool at_least = false;
  int64_t bound = 0;
  friend bool operator==(const Assumption&, const Assumption&) = default;
};

class Ranges {
 public:
  explicit Ranges(const Function& f);
  // What the answers since the last clear() rely on.
  const std::vector<Assumption>& used() const { return used_; }
  void clear();
  // A counter whose one end nothing says: the other end, where a guess begins.
  struct Open {
    Val counter = kNone;
    bool above = false;  // the upper end is open
    int64_t known = 0;
    friend bool operator==(const Open&, const Open&) = default;
  };
  // The one that the answer wanted; none: none, or several.
  std::optional<Open> open() const { return several_ ? std::nullopt : open_; }
  // From now on its open end is taken for `bound`, as an assumption. Without: it is open.
  void guess(std::optional<std::pair<Open, int64_t>> bound) { guess_ = bound; }
  // As a signed number of its width, where `at` is executed.
  Range of(Val v, Block at, uint32_t depth = 0);

 private:
  // Into a loop where an interrupted execution may go on: then memory says what it is, and another
  // task may have written there.
  bool crosses(Val v, Block at) const;
  Range sum(const Node& n, Block at, uint32_t depth);
  Range product(const Node& n, Block at, uint32_t depth);
  // A loop's counter: from what comes in, by steps of one direction, as long as the head goes on.
  Range parameter(Val v, Block at, uint32_t depth);
  // What is guessed becomes the end that is open. False: nothing is.
  bool close(const Open& open, int64_t& end);
  Range join(Block block, size_t index, uint32_t depth);
  // Values that come in through the block in front of a loop. An execution that goes on there has
  // the counter's own values, which the same bounds hold.
  Range before(Block front, Val arg, uint32_t depth);
  const Loop* loop_at(Block head) const;
  // The last number with which the head goes on: `number`, or that less than a variable from before
  // the loop.
  struct Limit {
    Val variable = kNone;
    int64_t number = 0;
  };
  std::optional<Limit> limit_of(const Loop& loop, Val v, bool upwards) const;
  const Function& f_;
  // Blocks that lead there, by which of their targets.
  std::span<const std::pair<Block, uint32_t>> ways_in(Block block) const {
    return {ways_in_.data() + first_way_[block], ways_in_.data() + first_way_[block + 1]};
  }
  std::vector<uint32_t> first_way_;  // by block, in `ways_in_`
  std::vector<std::pair<Block, uint32_t>> ways_in_;
  std::vector<Assumption> used_;
  std::vector<uint32_t> loop_at_;  // by head; kNone: no head
  uint32_t steps_ = 0;
  std::optional<Open> open_;
  bool several_ = false;
  std::optional<std::pair<Open, int64_t>> guess_;
};

}  // namespace vm::native
