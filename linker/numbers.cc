#include "linker/numbers.h"

#include "linker/offsets.h"

namespace linker {

using ir::Base;
using ir::Field;
using ir::FieldKind;

template <class T>
uint32_t Numbers::intern(const base::ByteWriter& key, std::vector<T>& table, T value) {
  const base::Bytes& bytes = key.bytes();
  const auto [found, added] = context_.table_numbers.try_emplace(
      std::string(bytes.begin(), bytes.end()), static_cast<uint32_t>(table.size()));
  if (added) table.push_back(std::move(value));
  return found->second;
}

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

uint32_t Numbers::bound_number(uint32_t number) {
  const ir::Bound& bound = object_.bounds[number];
  const ir::Dimension& dim = context_.program.types[bound.array].dims[bound.dim];
  base::ByteWriter key;
  key.u8('b');
  key.u32(bound.array.index);
  key.u8(bound.dim);
  key.text(bound.name);
  const uint64_t stride =
      stride_of(context_.program.types, context_.image.layouts, bound.array, bound.dim);
  return intern(key, context_.image.bounds,
                ir::LinkedBound{dim.low,
                                dim.count(),
                                static_cast<uint32_t>(stride),
                                {bound.array, bound.dim},
                                bound.name});
}

uint32_t Numbers::range_number(uint32_t number) {
  const ir::Range& range = object_.ranges[number];
  base::ByteWriter key;
  key.u8('r');
  key.i64(range.low);
  key.i64(range.high);
  key.text(range.name);
  return intern(key, context_.image.ranges, range);
}

// Of an instance: what its variables take.
uint32_t Numbers::size_of(ir::TypeId type) const {
  const ir::TypeLayout& layout = context_.image.layouts[type];
  return context_.program.types.is_instance(type) ? layout.used : layout.size;
}

uint32_t Numbers::extension_field(const Field& field, uint32_t number, Base base) {
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
