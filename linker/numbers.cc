#include "linker/numbers.h"

#include "linker/offsets.h"
#include "linker/tables.h"

namespace linker {

using ir::Base;
using ir::Field;
using ir::FieldKind;

base::Digest known_identity(const ir::Object& object, const ir::Program& program,
                            const ir::PouNames& names) {
  if (object.known_as != base::Digest{}) return object.known_as;
  return ir::identity(object, program, names);
}

Numbers::Numbers(const LinkContext& context, const ir::Object& object, const FrameLayout& frame)
    : context_(context), object_(object), frame_(frame), constants_(context.pool.offsets(object)) {
  callees_.reserve(object.callees.size());
  for (const std::string& callee : object.callees) {
    callees_.push_back(context.pou_numbers.at(ir::fold_name(callee)));
  }
  places_.reserve(object.places.size());
  for (const ir::ObjectPlace& place : object.places) places_.push_back(find_place(place));
  bounds_.reserve(object.bounds.size());
  for (const ir::Bound& row : object.bounds) {
    bounds_.push_back(context.table_numbers.at(bound_key(row.array, row.dim, row.name)));
  }
  ranges_.reserve(object.ranges.size());
  for (const ir::Range& row : object.ranges) {
    ranges_.push_back(context.table_numbers.at(range_key(row)));
  }
}

uint64_t Numbers::slot_offset(uint32_t number) const {
  const ir::Slot& slot = object_.slots[number];
  if (slot.kind == ir::SlotKind::kNativeArg) return uint64_t{frame_.size} + 8 * slot.param;
  if (slot.kind != ir::SlotKind::kArg) return frame_.offsets[number];
  return frame_.size + context_.parameter_offsets[pou_number(slot.callee)][slot.param];
}

uint64_t Numbers::find_place(const ir::ObjectPlace& place) const {
  uint64_t offset = place_offset(place, object_, context_.program, context_.image.layouts);
  if (place.root == ir::PlaceRoot::kSlot) offset += slot_offset(place.slot);
  if (place.root == ir::PlaceRoot::kGlobal) offset += context_.image.instances.all()[0].data;
  return offset;
}

uint64_t Numbers::near_offset(Base base, uint32_t number) const {
  if (base == Base::kConst) return constants_[number];
  if (base != Base::kFrame) return offset_of_place(number);
  const auto slots = static_cast<uint32_t>(object_.slots.size());
  return number < slots ? slot_offset(number) : offset_of_place(number - slots);
}

uint32_t Numbers::wide_offset(Base base, uint32_t number) const {
  return static_cast<uint32_t>(base == Base::kConst ? constants_[number] : offset_of_place(number));
}

// For an instance: what its variables take.
uint32_t Numbers::size_of(ir::TypeId type) const {
  const ir::TypeLayout& layout = context_.image.layouts[type];
  return context_.program.types.is_instance(type) ? layout.used : layout.size;
}

uint32_t Numbers::extension_field(const Field& field, uint32_t number, Base base) const {
  switch (field.kind) {
    case FieldKind::kPlace32:
      return wide_offset(base, number);
    case FieldKind::kOffset32:
      return static_cast<uint32_t>(offset_of_place(number));
    case FieldKind::kBounds:
      return bounds_[number];
    case FieldKind::kType:
      return ir::region_field(object_.regions[number]);
    case FieldKind::kCode:
      return pou_number(number);
    case FieldKind::kSize:
      return size_of(object_.regions[number].type);
    default:
      return number;
  }
}

}  // namespace linker
