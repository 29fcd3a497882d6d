// A plan, of which some values become others than those of the initial data and of the rules of
// A14: what an edit took away or converted, for a change that takes it out (values_back.h).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ir/bytecode/symbols.h"
#include "online_change/plan/plan.h"

namespace online_change {

class PlanEdit {
 public:
  // Borrows all three. Cost: each value of the plan.
  PlanEdit(Plan& plan, const ir::Image& running, const ir::Image& next);

  // What is initialised at `to` gets this value.
  void initialise(uint32_t to, std::span<const uint8_t> value);
  // `path`, which is `here`, gets the bytes at `value`, if `now` is still what was `made`; else it
  // is converted or kept, as the plan said.
  void convert(const ir::Symbol& now, const std::string& path, const ir::Symbol& here,
               std::span<const uint8_t> made, const uint8_t* value);
  // Makes the steps and the rows. Returns how many values there were.
  uint64_t finish();

 private:
  struct Place {  // one value of a step
    uint32_t to = 0;
    uint32_t size = 0;
    uint32_t step = 0;
    uint32_t index = 0;
  };
  struct Cut {  // out of a step that copies
    uint32_t step = 0;
    uint64_t at = 0;  // in the step's values laid end to end
    UpdateStep made;
  };
  const Place* writes(uint32_t to, uint32_t size) const;
  void count_row(uint32_t fate);
  uint32_t own_row(ir::TypeId old_type, ir::TypeId new_type, const std::string& path);
  void cut(const UpdateStep& step, std::span<const Cut> cuts, std::vector<UpdateStep>& out) const;
  void cut_steps();
  void tell_rows();
  void drop_empty_rows();

  Plan& plan_;
  const ir::Image& running_;
  const ir::Image& next_;
  std::vector<Place> places_;  // sorted
  std::vector<Cut> cuts_;
  std::vector<UpdateStep> added_;
  std::map<uint32_t, uint64_t> values_of_row_;  // that were there before
  std::map<std::string, uint32_t> own_rows_;    // by the types of their variables
  uint64_t count_ = 0;
};

}  // namespace online_change
