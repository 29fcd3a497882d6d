// Since when each unit runs in the slot that it is in, and by whom (D8). Which slot that is, and
// what lies in the other one, say the slots themselves (vm/load/code_slots.h); this remembers when
// they were exchanged. In memory: at a start all code is placed anew, in slot A.
//
// Nothing here needs a boundary: the thread of the channel alone changes which version runs.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/stvm/unit_message.h"
#include "vm/runtime/controller.h"

namespace stvm {

class UnitTable {
 public:
  struct Since {
    uint64_t cycle = 0;
    int64_t time_ns = 0;
    std::string who;
    std::string event;  // "started", "switched", "undone"
  };

  UnitTable(const vm::Controller& controller, Since started);
  // After a switch or an undo: units that are in the other slot now, or new.
  void note(Since now);
  // Rows from POU `first` on, as many as one message takes. `staged`, `before`: versions that were
  // prepared and may lie in slots; null: none.
  UnitPage page(uint64_t first, const ir::VerifiedImage* staged,
                const ir::VerifiedImage* before) const;

 private:
  // A POU that was exchanged since the start, and the version of what its other slot held then.
  struct Exchanged {
    std::shared_ptr<const Since> since;
    vm::SlotLabel::Start other{};
  };

  vm::CodeSlots::View view(uint32_t pou) const;
  UnitRow row(uint32_t pou, const ir::VerifiedImage* staged,
              const ir::VerifiedImage* before) const;
  static OtherSlot what_lies_there(const vm::SlotLabel& label, const Exchanged* exchanged,
                                   const ir::VerifiedImage* staged,
                                   const ir::VerifiedImage* before);

  const vm::Controller& controller_;
  std::shared_ptr<const Since> started_;
  std::vector<uint8_t> slots_;  // by POU, as of the last note()
  std::map<uint32_t, Exchanged> exchanged_;
};

}  // namespace stvm
