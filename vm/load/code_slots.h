// Code that is ready to run, in two slots for each POU (D1): while one is run, the next version of
// the POU is written to the other; a POU whose code stays the same stays in its slot, and so do its
// callers, which find it by its number (Generation::pous). Slots have slack. A POU that outgrows
// its slot gets a larger one; when all slots together would exceed the limit, that is refused, and
// nothing that runs was touched (D5).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "ir/bytecode/code.h"

namespace vm {

// What a slot was written with, by the first bytes of two digests: people tell versions apart by
// fewer (base::short_hex).
struct SlotLabel {
  using Start = std::array<uint8_t, 8>;
  Start unit{};     // identity of the POU (E1)
  Start version{};  // the image that it was written for
  static Start start_of(const base::Digest& digest);
  // Zeros after it.
  static base::Digest digest_of(const Start& start);
};

class CodeSlots {
 public:
  static constexpr uint64_t kSlackPercent = 25;
  static constexpr uint64_t kMostSlackPercent = 10'000;
  // A new slot has `slack_percent` more than its code needs, and room for a line or two.
  explicit CodeSlots(uint64_t limit_units, uint64_t slack_percent = kSlackPercent)
      : limit_units_(limit_units), slack_percent_(slack_percent) {}

  // The code of POU `number`, at a place where it stays until place() is called for that POU twice
  // more with other code. `running` is what runs of it, or null: never written. kTooLarge names
  // `name` and the amounts.
  base::Result<const ir::Unit*> place(uint32_t number, const std::string& name,
                                      std::span<const ir::Unit> code, const ir::Unit* running,
                                      const SlotLabel& label);
  // Frees the slots of POUs from `count` on.
  void keep_first(uint32_t count);

  // The table as D8 shows it, of a POU whose code is at `running`: which of its two slots that is,
  // and what the other one was written with. By the thread that places code.
  struct View {
    uint8_t slot = 0;
    std::optional<SlotLabel> other;  // nullopt: never written
  };
  View view(uint32_t number, const ir::Unit* running) const;

  uint64_t total_units() const { return total_units_; }  // of all slots
  uint64_t written() const { return written_; }          // slots, since the beginning

 private:
  struct Slot {
    std::unique_ptr<ir::Unit[]> units;
    uint32_t capacity = 0;
    uint32_t used = 0;
    SlotLabel label;
  };
  struct Pair {
    Slot slots[2];
  };
  base::Status make_room(Slot& slot, const std::string& name, uint64_t size);

  std::vector<Pair> pairs_;  // by POU number
  uint64_t limit_units_;
  uint64_t slack_percent_;
  uint64_t total_units_ = 0;
  uint64_t written_ = 0;
};

}  // namespace vm
