// Can bytes of the old version, as they lie, serve as a value of a new type?
// The checker's own rule, independent of the planner's differ.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "online_change/diff/areas.h"

namespace online_change {

enum class Fit : uint8_t {
  kNo,
  kYes,
  kYesButSlots,  // when the instance IDs inside are the same
};

class TypeFit {
 public:
  TypeFit(const Areas& old_areas, const ir::Image& new_image)
      : areas_(old_areas), old_(old_areas.image()), new_(new_image) {}

  // A value (or in-out slot) of new type `node.type` taken from old offset `from`.
  Fit value_at(uint32_t from, Node node);
  // A whole area taken from old offset `from`.
  Fit area_at(uint32_t from, ir::TypeId type);

 private:
  using Pair = std::pair<ir::TypeId, ir::TypeId>;
  Fit values(ir::TypeId old_type, ir::TypeId new_type);
  Fit compare_values(ir::TypeId old_type, ir::TypeId new_type);
  Fit members(ir::TypeId old_type, ir::TypeId new_type);
  Fit elements(ir::TypeId old_type, uint64_t skipped, ir::TypeId new_type);

  const Areas& areas_;
  const ir::Image& old_;
  const ir::Image& new_;
  std::map<Pair, Fit> values_;
  std::map<Pair, Fit> members_;
  uint32_t depth_ = 0;
};

}  // namespace online_change
