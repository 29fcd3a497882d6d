// Charts across a change (change cases 38 and 73, docs/adr/0009-sfc.md): the steps that are active
// must be ones at which the other version's chart can be too, there and back. Undo gives a step
// back as active only where the chart is then in such a state.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/bytecode/image.h"
#include "online_change/apply/chart_net.h"

namespace online_change {

// For versions with the same_data(): do their charts lead from the same steps to the same?
bool same_nets(const ir::Image& a, const ir::Image& b);

class Charts {
 public:
  // No chart has another step or transition than before.
  Charts() = default;
  // `old_image` has the new version's names.
  Charts(const ir::Image& old_image, const ir::Image& new_image);

  // Before the switch: why a chart could not go on in the new version, and the way out; "" when all
  // can. `memory` is the old version's.
  std::string stuck(const uint8_t* memory) const;
  // At the switch, before it: which steps are active.
  void note(const uint8_t* memory);
  // Before undo, in the new version's memory: why a chart could not go on in the old version; ""
  // when all can.
  std::string lost_on_the_way_back(const uint8_t* memory) const;
  // After undo, in the old version's memory: a step that came back active is left where its chart
  // cannot be at it.
  void settle(uint8_t* memory) const;

 private:
  struct Step {
    uint32_t member = 0;
    uint32_t at = 0;         // in the old version's memory; X is its first byte
    uint32_t new_at = 0;     // in the new one's, of a step that stays or is new
    uint32_t next = kNone;   // its member in the new version, or that of the step that takes over
    uint32_t size = 0;
    bool goes = false;
    bool active = false;  // at the switch
    std::string path;
  };
  struct Chart {
    std::vector<Step> steps;
    std::vector<Step> added;
    ChartNet before;
    ChartNet after;
    bool was_legal = false;  // at the switch
  };
  static constexpr uint32_t kNone = 0xffffffffu;

  void add(const ir::Image& old_image, const ir::Image& new_image, uint32_t old_id,
           uint32_t new_id);
  static void add_new_steps(const ir::Image& old_image, ir::TypeId old_type,
                            const ir::Image& new_image, uint32_t new_id, Chart& chart);
  static std::string stuck(const Chart& chart, const uint8_t* memory);
  static std::string lost(const Chart& chart, const uint8_t* memory);
  static bool comes_back(const Chart& chart, const std::vector<uint32_t>& staying);

  std::vector<Chart> charts_;  // those of which a step or a transition goes or is added
};

}  // namespace online_change
