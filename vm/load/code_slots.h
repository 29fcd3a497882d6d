// Code that is ready to run, in two slots for each POU (D1): while one is run, the next version of
// the POU is written to the other; a POU whose code stays the same stays in its slot, and so do its
// callers, which find it by its number (Generation::pous). Slots have slack. A POU that outgrows
// its slot gets a larger one; when all slots together would exceed the limit, that is refused, and
// nothing that runs was touched (D5).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/code.h"

namespace vm {

class CodeSlots {
 public:
  explicit CodeSlots(uint64_t limit_units) : limit_units_(limit_units) {}

  // The code of POU `number`, at a place where it stays until place() is called for that POU twice
  // more with other code. `running` is what runs of it, or null: never written. kTooLarge names
  // `name` and the amounts.
  base::Result<const ir::Unit*> place(uint32_t number, const std::string& name,
                                      std::span<const ir::Unit> code, const ir::Unit* running);
  // Frees the slots of POUs from `count` on.
  void keep_first(uint32_t count);

  uint64_t total_units() const { return total_units_; }  // of all slots
  uint64_t written() const { return written_; }          // slots, since the beginning

 private:
  struct Slot {
    std::unique_ptr<ir::Unit[]> units;
    uint32_t capacity = 0;
    uint32_t used = 0;
  };
  struct Pair {
    Slot slots[2];
  };
  base::Status make_room(Slot& slot, const std::string& name, uint64_t size);

  std::vector<Pair> pairs_;  // by POU number
  uint64_t limit_units_;
  uint64_t total_units_ = 0;
  uint64_t written_ = 0;
};

}  // namespace vm
