#include "ir/lower/tables.h"

#include "base/bytes.h"

namespace ir::codegen {
namespace {

std::string key_of(char table, base::ByteWriter& writer) {
  const base::Bytes& bytes = writer.bytes();
  return table + std::string(bytes.begin(), bytes.end());
}

void add(base::ByteWriter& writer, Region region) {
  writer.u32(region.type.index);
  writer.u8(region.dim);
}

}  // namespace

template <class T>
uint32_t Tables::intern(std::string key, std::vector<T>& table, T value) {
  const auto [entry, added] =
      numbers_.try_emplace(std::move(key), static_cast<uint32_t>(table.size()));
  if (added) table.push_back(std::move(value));
  return entry->second;
}

uint32_t Tables::place(const ObjectPlace& place) {
  base::ByteWriter key;
  key.u8(static_cast<uint8_t>(place.root));
  key.u32(place.slot);
  add(key, place.region);
  add(key, place.result);
  for (const Step& step : place.steps) {
    key.u8(static_cast<uint8_t>(step.kind));
    key.u32(step.index);
    key.i64(step.constant_index);
  }
  return intern(key_of('p', key), object_.places, place);
}

uint32_t Tables::scalar(Class cls, uint64_t bits) {
  ObjectConstant constant;
  constant.cls = cls;
  for (uint32_t i = 0; i < class_size(cls); ++i) {
    constant.bytes.push_back(static_cast<uint8_t>(bits >> (8 * i)));
  }
  base::ByteWriter key;
  key.u8(static_cast<uint8_t>(cls));
  key.raw(constant.bytes);
  return intern(key_of('c', key), object_.constants, std::move(constant));
}

uint32_t Tables::initial_value(TypeId type, ConstId value) {
  base::ByteWriter key;
  key.u32(type.index);
  key.u32(value.index);
  ObjectConstant constant;
  constant.type = type;
  constant.value = value;
  return intern(key_of('i', key), object_.constants, std::move(constant));
}

uint32_t Tables::region(Region region) {
  base::ByteWriter key;
  add(key, region);
  return intern(key_of('r', key), object_.regions, region);
}

uint32_t Tables::bound(TypeId array, uint8_t dim, const std::string& name) {
  base::ByteWriter key;
  key.u32(array.index);
  key.u8(dim);
  key.text(name);
  return intern(key_of('b', key), object_.bounds, Bound{array, dim, name});
}

uint32_t Tables::range(int64_t low, int64_t high, const std::string& name) {
  base::ByteWriter key;
  key.i64(low);
  key.i64(high);
  key.text(name);
  return intern(key_of('g', key), object_.ranges, Range{low, high, name});
}

uint32_t Tables::callee(const std::string& name) {
  base::ByteWriter key;
  key.text(fold_name(name));
  return intern(key_of('f', key), object_.callees, name);
}

uint32_t Tables::argument_slot(uint32_t callee, uint32_t param, Class cls, bool aggregate,
                               Region region) {
  base::ByteWriter key;
  key.u32(callee);
  key.u32(param);
  Slot slot;
  slot.kind = SlotKind::kArg;
  slot.callee = callee;
  slot.param = param;
  slot.cls = cls;
  slot.aggregate = aggregate;
  slot.region = region;
  return intern(key_of('a', key), object_.slots, std::move(slot));
}

uint32_t Tables::native_slot(uint32_t number, Class cls) {
  base::ByteWriter key;
  key.u32(number);
  key.u8(static_cast<uint8_t>(cls));
  Slot slot;
  slot.kind = SlotKind::kNativeArg;
  slot.param = number;
  slot.cls = cls;
  return intern(key_of('n', key), object_.slots, std::move(slot));
}

}  // namespace ir::codegen
