#include "linker/offsets.h"

namespace linker {

using ir::Region;
using ir::Type;

uint64_t stride_of(const ir::TypeTable& types, const ir::Layouts& layouts, ir::TypeId array,
                   uint8_t dim) {
  const Type& type = types[array];
  uint64_t stride = layouts[type.base].size;
  for (size_t d = dim + size_t{1}; d < type.dims.size(); ++d) stride *= type.dims[d].count();
  return stride;
}

static Region root_region(const ir::ObjectPlace& place, const ir::Object& object,
                          const ir::Program& program) {
  switch (place.root) {
    case ir::PlaceRoot::kSelf:
      return {object.self, 0};
    case ir::PlaceRoot::kGlobal:
      return {program.globals, 0};
    case ir::PlaceRoot::kSlot:
      return object.slots[place.slot].region;
    case ir::PlaceRoot::kRegion:
    case ir::PlaceRoot::kFixed:
      return place.region;
  }
  return place.region;
}

uint64_t place_offset(const ir::ObjectPlace& place, const ir::Object& object,
                      const ir::Program& program, const ir::Layouts& layouts) {
  if (place.root == ir::PlaceRoot::kFixed) return place.slot;
  const ir::TypeTable& types = program.types;
  Region at = root_region(place, object, program);
  uint64_t offset = 0;
  for (const ir::Step& step : place.steps) {
    const Type& type = types[at.type];
    if (step.kind == ir::StepKind::kMember) {
      offset += layouts[at.type].member_offsets[step.index];
      at = {type.members[step.index].type, 0};
      continue;
    }
    offset += static_cast<uint64_t>(step.constant_index - type.dims[at.dim].low) *
              stride_of(types, layouts, at.type, at.dim);
    // Function block elements stay a region of their array: their slot, not their area.
    ++at.dim;
    if (at.dim == type.dims.size() && !types.is_instance(type.base)) at = {type.base, 0};
  }
  return offset;
}

}  // namespace linker
