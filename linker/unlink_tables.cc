#include "linker/unlink_tables.h"

#include "ir/bytecode/regions.h"

namespace linker {

using ir::Class;

Wanted UnlinkTables::slot_of(ir::Opcode op) const {
  using ir::Opcode;
  const bool in_out = op == Opcode::LD_REF || op == Opcode::LD_REF_AT || op == Opcode::ST_REF_AT;
  if (in_out) return {finder_.in_out_slot(), "o", {}, Wanted::kNoBytes, false};
  return {finder_.instance_slot(), "i", {}, Wanted::kNoBytes, false};
}

Wanted UnlinkTables::scalar(Class cls) const {
  return {finder_.scalar(cls),
          "s" + std::to_string(static_cast<uint32_t>(cls)),
          {},
          Wanted::kNoBytes,
          false};
}

Wanted UnlinkTables::region(ir::Region region) const {
  return {finder_.region(region),
          "r" + std::to_string(region.type.index) + "," + std::to_string(region.dim), region,
          ir::region_size(image_.types, image_.layouts, region), false};
}

Wanted UnlinkTables::string(Class cls, uint32_t capacity) const {
  const uint32_t unit = cls == Class::kS ? 1 : 2;
  return {finder_.string(cls, capacity),
          (cls == Class::kS ? "t" : "w") + std::to_string(capacity),
          {},
          (capacity + 1) * unit,
          false};
}

template <class T>
uint32_t UnlinkTables::intern(char table, std::initializer_list<uint32_t> parts,
                              std::vector<T>& entries, const T& entry) {
  std::string key(1, table);
  for (const uint32_t part : parts) key += "," + std::to_string(part);
  const uint32_t next = static_cast<uint32_t>(entries.size());
  const uint32_t number = numbers_.add(key, next);
  if (number == next) entries.push_back(entry);
  return number;
}

uint32_t UnlinkTables::find(ir::ObjectPlace& place, ir::Region root, uint32_t offset,
                            const Wanted& wanted) {
  std::string key = "p0" + wanted.key;
  for (const uint32_t part : {static_cast<uint32_t>(place.root), place.slot,
                              place.region.type.index, uint32_t{place.region.dim}, offset}) {
    key += "," + std::to_string(part);
  }
  const uint32_t next = static_cast<uint32_t>(object_.places.size());
  const uint32_t number = numbers_.add(key, next);
  if (number != next) return number;
  std::optional<FoundPlace> found = finder_.find(root, offset, wanted.test);
  if (!found) {
    fail("byte " + std::to_string(offset) + " of " + image_.types.text(root.type));
    found.emplace();
  }
  place.steps = std::move(found->steps);
  place.result = found->result;
  const bool whole =
      wanted.any && place.result.type.valid() && !image_.types.is_scalar(place.result.type);
  if (found->overlaid || whole) object_.fixed = true;
  object_.places.push_back(place);
  return number;
}

uint32_t UnlinkTables::fixed_place(uint32_t offset) {
  object_.fixed = true;
  ir::ObjectPlace place;
  place.root = ir::PlaceRoot::kFixed;
  place.slot = offset;
  return intern('f', {offset}, object_.places, place);
}

uint32_t UnlinkTables::constant(uint32_t offset, uint32_t size, Class cls) {
  if (size == Wanted::kNoBytes || uint64_t{offset} + size > image_.pool.size()) {
    fail("byte " + std::to_string(offset) + " of the constants");
    return 0;
  }
  ir::ObjectConstant constant;
  constant.cls = cls;
  const uint8_t* const bytes = image_.pool.data() + offset;
  for (uint32_t i = 0; i < size; ++i) constant.bytes.push_back(bytes[i]);
  return intern('c', {offset, size, static_cast<uint32_t>(cls)}, object_.constants, constant);
}

uint32_t UnlinkTables::laid_out_constant(uint32_t offset, const Wanted& wanted) {
  const ir::TypeId type = wanted.constant.type;
  if (type.valid() && !image_.types.is_scalar(type)) object_.fixed = true;
  return constant(offset, wanted.bytes, Class::kA);
}

uint32_t UnlinkTables::region_number(ir::Region region) {
  return intern('r', {region.type.index, region.dim}, object_.regions, region);
}

uint32_t UnlinkTables::size_number(uint32_t size) {
  object_.fixed = true;
  const std::optional<ir::TypeId> type = finder_.type_of_size(size);
  if (type) return region_number({*type, 0});
  fail("a type of " + std::to_string(size) + " bytes");
  return 0;
}

uint32_t UnlinkTables::bound(uint32_t number) {
  const ir::LinkedBound& row = image_.bounds[number];
  return intern('b', {number}, object_.bounds, ir::Bound{row.from.type, row.from.dim, row.name});
}
uint32_t UnlinkTables::range(uint32_t number) {
  return intern('g', {number}, object_.ranges, image_.ranges[number]);
}
uint32_t UnlinkTables::callee(uint32_t number) {
  if (image_.pous[number].name.empty()) fail("a POU without a name");
  return intern('k', {number}, object_.callees, image_.pous[number].name);
}

void UnlinkTables::fail(const std::string& what) {
  if (error_) return;
  error_ = base::Error{base::Refusal::kUndefinedSymbol,
                       "the code of `" + object_.name + "` names " + what +
                           ", and the image does not tell what that is"};
}

uint32_t UnlinkTables::slot_place(uint32_t slot, ir::Region result) {
  ir::ObjectPlace place;
  place.root = ir::PlaceRoot::kSlot;
  place.slot = slot;
  place.result = result;
  return intern('p', {1, slot, result.type.index}, object_.places, place);
}

uint32_t UnlinkTables::argument(const ir::Slot& slot) {
  const bool native = slot.kind == ir::SlotKind::kNativeArg;
  const uint32_t what = native ? static_cast<uint32_t>(slot.cls) : slot.callee;
  return intern(native ? 'n' : 'a', {what, slot.param}, object_.slots, slot);
}

}  // namespace linker
