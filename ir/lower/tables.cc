#include "ir/lower/tables.h"

#include <cstring>

namespace ir::codegen {
namespace {

// Writes the parts of an entry, so that equal entries and no others have the same key.
class Key {
 public:
  Key(std::string& out, char table) : out_(out) { out_.assign(1, table); }
  template <class T>
  Key& add(T v) {
    static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    out_.append(bytes, sizeof v);
    return *this;
  }
  Key& add(const Region& region) { return add(region.type.index).add(region.dim); }
  Key& text(const std::string& v) {  // the last part
    out_ += v;
    return *this;
  }

 private:
  std::string& out_;
};

}  // namespace

// `make` gives the entry whose key was written, if it is a new one.
template <class T, class Make>
uint32_t Tables::intern(std::vector<T>& table, const Make& make) {
  const uint32_t next = static_cast<uint32_t>(table.size());
  const uint32_t number = numbers_.add(key_, next);
  if (number == next) table.push_back(make());
  return number;
}

uint32_t Tables::place(const ObjectPlace& place) {
  Key key(key_, 'p');
  key.add(place.root).add(place.slot).add(place.region).add(place.result);
  for (const Step& step : place.steps) {
    key.add(step.kind).add(step.index).add(step.constant_index);
  }
  return intern(object_.places, [&] { return place; });
}

uint32_t Tables::scalar(Class cls, uint64_t bits) {
  const uint32_t size = class_size(cls);
  const uint64_t mask = size < 8 ? (uint64_t{1} << (8 * size)) - 1 : ~uint64_t{0};
  Key(key_, 'c').add(cls).add(bits & mask);
  return intern(object_.constants, [&] {
    ObjectConstant constant;
    constant.cls = cls;
    for (uint32_t i = 0; i < size; ++i) {
      constant.bytes.push_back(static_cast<uint8_t>(bits >> (8 * i)));
    }
    return constant;
  });
}

uint32_t Tables::initial_value(TypeId type, ConstId value) {
  Key(key_, 'i').add(type.index).add(value.index);
  return intern(object_.constants, [&] {
    ObjectConstant constant;
    constant.type = type;
    constant.value = value;
    return constant;
  });
}

uint32_t Tables::region(Region region) {
  Key(key_, 'r').add(region);
  return intern(object_.regions, [&] { return region; });
}

uint32_t Tables::bound(TypeId array, uint8_t dim, const std::string& name) {
  Key(key_, 'b').add(array.index).add(dim).text(name);
  return intern(object_.bounds, [&] { return Bound{array, dim, name}; });
}

uint32_t Tables::range(int64_t low, int64_t high, const std::string& name) {
  Key(key_, 'g').add(low).add(high).text(name);
  return intern(object_.ranges, [&] { return Range{low, high, name}; });
}

uint32_t Tables::callee(const std::string& name) {
  Key(key_, 'f').text(fold_name(name));
  return intern(object_.callees, [&] { return name; });
}

uint32_t Tables::argument_slot(uint32_t callee, uint32_t param, Class cls, bool aggregate,
                               Region region) {
  Key(key_, 'a').add(callee).add(param);
  return intern(object_.slots, [&] {
    Slot slot;
    slot.kind = SlotKind::kArg;
    slot.callee = callee;
    slot.param = param;
    slot.cls = cls;
    slot.aggregate = aggregate;
    slot.region = region;
    return slot;
  });
}

uint32_t Tables::native_slot(uint32_t number, Class cls) {
  Key(key_, 'n').add(number).add(cls);
  return intern(object_.slots, [&] {
    Slot slot;
    slot.kind = SlotKind::kNativeArg;
    slot.param = number;
    slot.cls = cls;
    return slot;
  });
}

}  // namespace ir::codegen
