// Charts across a change (case 38, docs/adr/0009-sfc.md): a chart whose active step goes must have
// another one to go on at, there and back, and undo gives a step back as active only where the
// chart still is where the switch found it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

class Charts {
 public:
  // None of them has another step than before.
  Charts() = default;
  // `old_image` has the new version's names.
  Charts(const ir::Image& old_image, const ir::Image& new_image);

  // A step that is active, goes, and leaves its chart without any active step; "" when there is
  // none. `memory` is the old version's.
  std::string deserted(const uint8_t* memory) const;
  // At the switch, before it: which steps are active.
  void note(const uint8_t* memory);
  // Before undo, in the new version's memory: why a chart could not go on in the old version; ""
  // when all can. A step that only the new version has is active and no other, or a step of one of
  // several branches was dropped while it was active, and the chart is not where it was then.
  std::string lost_on_the_way_back(const uint8_t* memory) const;
  // Behind undo, in the old version's memory: a step that came back active is left where another
  // step of its chart has been entered meanwhile.
  void settle(uint8_t* memory) const;

 private:
  struct Step {
    uint32_t at = 0;      // in the old version's memory; X is its first byte
    uint32_t new_at = 0;  // in the new one's, of a step that stays or is new
    uint32_t size = 0;
    bool goes = false;
    bool taken = false;  // by a step with a rule
    bool active = false;
    std::string path;
  };
  struct Chart {
    std::vector<Step> steps;
    std::vector<Step> added;
  };
  void add(const ir::Image& old_image, const ir::Image& new_image, uint32_t old_id,
           uint32_t new_id);
  static void add_new_steps(const ir::Image& old_image, ir::TypeId old_type,
                            const ir::Image& new_image, uint32_t new_id, Chart& chart);

  std::vector<Chart> charts_;  // those of which a step goes or is added
};

}  // namespace online_change
