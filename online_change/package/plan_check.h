// V17 for one plan, independent of how it was made: every byte that a step
// writes belongs to an area of the new version and takes a value of its type; every
// variable of the new version is written by exactly one step, or stays where the
// old version has a variable that can serve as it; what is converted, migrated or entered is
// such a variable. So nothing is reinterpreted, whatever the package says.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "online_change/diff/initial_data.h"
#include "online_change/package/step_values.h"
#include "online_change/package/type_fit.h"
#include "online_change/plan/plan.h"

namespace online_change {

class PlanCheck {
 public:
  // `code`: the image whose migrations the plan calls, one of the two.
  PlanCheck(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
            const ir::Image& code);
  base::Status run();

 private:
  using Target = StepValue;

  bool check_forms();
  bool check_form(const UpdateStep& step);
  bool check_targets();
  bool check_places(const UpdateStep& step);
  bool check_area(uint32_t id);
  bool check_elements(Node array, uint32_t depth);
  // Elements from `first` on, `most` at most, that one step converts from neighbours in an array.
  uint32_t converted_run(Node first, uint32_t most);
  bool check_node(Node node, uint32_t depth);
  bool check_calls();
  bool check_input(const MigrationInput& input, const ir::LinkedPou& pou, TypeFit& fit);
  const ir::FrameSlot* slot_of(const GivenValue& value) const;
  bool check_entered(Node node, const Target& target);
  bool check_migrated(Node node, const Target& target);
  bool check_written(Node node, const Target& target, uint32_t depth);
  bool check_gather(const UpdateStep& step, const GatheredBits& gathered);
  bool check_gathered(Node node, const Target& target, uint32_t depth);
  bool check_initial(Node node, const Target& target);
  bool is_initialised(uint32_t begin, uint32_t size, const Target& target) const;
  // The old bytes of a union in front, initial ones after them.
  bool check_grown_union(Node node);
  bool check_conversion(Node node, const Target& target, uint32_t depth);
  // `node` keeps bytes that the old version has at `from`.
  bool check_carried(Node node, uint32_t from, uint32_t depth);
  template <class Visit>
  bool for_each_part(Node node, Visit visit) const;
  bool has_parts(Node node) const;
  uint32_t size_of(Node node) const;
  uint32_t source_of(const Target& target) const;
  const Gather& parts_of(const Target& target) const;
  const UpdateStep& step_of(const Target& target) const { return plan_.steps[target.step]; }
  std::optional<Target> first_behind(uint32_t place) const { return values_->first_behind(place); }
  // Values that are not just copied were looked at where the variable is that they are made for.
  void reach(const Target& first, uint32_t count = 1);
  bool check_reached();
  bool fail(uint32_t at, const char* what);

  const Plan& plan_;
  const ir::Image& old_;
  const ir::Image& new_;
  const ir::Image& code_;
  Areas old_areas_;
  Areas new_areas_;
  InitialData old_data_;
  InitialData new_data_;
  TypeFit fit_;
  std::optional<StepValues> values_;  // disjoint after check_targets()
  // By step: so many values from the first on; those that were reached before one in front of them.
  std::vector<uint32_t> reached_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> reached_early_;
  uint32_t stamp_at_ = 0;  // of the instance that is looked at
  std::string why_;
};

}  // namespace online_change
