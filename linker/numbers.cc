#include "linker/numbers.h"

#include "linker/offsets.h"
#include "linker/tables.h"

namespace linker {

using ir::Base;
using ir::Field;
using ir::FieldKind;

uint64_t Numbers::slot_offset(uint32_t number) const {
  const ir::Slot& slot = object_.slots[number];
  if (slot.kind == ir::SlotKind::kNativeArg) return uint64_t{frame_.size} + 8 * slot.param;
  if (slot.kind != ir::SlotKind::kArg) return frame_.offsets[number];
  const uint32_t callee = pou_number(slot.callee);
  return frame_.size + context_.parameter_offsets[callee][slot.param];
}

uint32_t Numbers::pou_number(uint32_t callee) const {
  return context_.pou_numbers.at(ir::fold_name(object_.callees[callee]));
}

uint64_t Numbers::offset_of_place(uint32_t number) const {
  const ir::ObjectPlace& place = object_.places[number];
  uint64_t offset = place_offset(place, object_, context_.program, context_.image.layouts);
  if (place.root == ir::PlaceRoot::kSlot) offset += slot_offset(place.slot);
  if (place.root == ir::PlaceRoot::kGlobal) offset += context_.image.instances[0].data;
  return offset;
}

uint64_t Numbers::near_offset(Base base, uint32_t number) const {
  if (base == Base::kConst) return context_.pool.offset(object_, number);
  if (base != Base::kFrame) return offset_of_place(number);
  const auto slots = static_cast<uint32_t>(object_.slots.size());
  return number < slots ? slot_offset(number) : offset_of_place(number - slots);
}

uint32_t Numbers::wide_offset(Base base, uint32_t number) const {
  return static_cast<uint32_t>(base == Base::kConst ? context_.pool.offset(object_, number)
                                                    : offset_of_place(number));
}

uint32_t Numbers::bound_number(uint32_t number) const {
  const ir::Bound& bound = object_.bounds[number];
  return context_.table_numbers.at(bound_key(bound.array, bound.dim, bound.name));
}

uint32_t Numbers::range_number(uint32_t number) const {
  return context_.table_numbers.at(range_key(object_.ranges[number]));
}

// Of an instance: what its variables take.
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
      return bound_number(number);
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
