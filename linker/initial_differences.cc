#include "linker/initial_differences.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "linker/initial.h"

namespace linker {
namespace {

using ir::ConstId;
using ir::Kind;
using ir::TypeId;

// A table with the values that it has got, so that none is added twice.
class KnownValues {
 public:
  explicit KnownValues(ir::ConstTable& table) : table_(table) {}

  ConstId add(ir::ConstValue value) {
    for (; known_.size() < table_.size();) {
      const ConstId id(static_cast<uint32_t>(known_.size()));
      known_.push_back(numbers_.try_emplace(key_of(table_[id]), id).first->second);
    }
    const auto found = numbers_.find(key_of(value));
    return found == numbers_.end() ? table_.add(std::move(value)) : found->second;
  }

 private:
  // Parts come before the whole, so equal ones have one number by then.
  std::string key_of(const ir::ConstValue& value) const {
    std::string key =
        std::to_string(value.bits) + "," + std::to_string(value.text.size()) + "," + value.text;
    for (const ir::ConstElement& element : value.elements) {
      const bool known = element.value.valid() && element.value.index < known_.size();
      const ConstId part = known ? known_[element.value.index] : element.value;
      key += "," + std::to_string(element.first) + "," + std::to_string(element.count) + "," +
             std::to_string(part.index);
    }
    return key;
  }

  ir::ConstTable& table_;
  std::vector<ConstId> known_;  // by number: the first one that is equal
  std::unordered_map<std::string, ConstId> numbers_;
};

class Differences {
 public:
  Differences(const ir::Image& image, ir::ConstTable& constants)
      : image_(image),
        constants_(constants),
        initial_(image.types, image.constants, image.layouts) {}

  // Invalid where `said`, what declarations on the way give, is all; else a value that takes its
  // place.
  ConstId of_area(uint32_t instance, ConstId said) {
    const ir::Instance& row = image_.instances[instance];
    base::Bytes have(image_.layouts[row.type].used, 0);
    ir::read_initial(image_, row.data, have);
    if (is_said_by_members(row.type, said, have)) return {};
    return of_members(row.type, have);
  }

 private:
  using Bytes = std::span<const uint8_t>;

  // Calls each(member, its bytes) for those that have initial values.
  template <class Each>
  void for_each_member(TypeId id, Bytes have, const Each& each) const {
    const ir::Type& type = image_.types[id];
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      const ir::Member& member = type.members[i];
      if (member.section == ir::Section::kInOut) continue;
      if (image_.types[member.type].kind == Kind::kProgram) continue;
      const uint32_t at = image_.layouts[id].member_offsets[i];
      each(i, have.subspan(at, image_.layouts[member.type].size));
    }
  }

  bool has_parts(TypeId id) const {
    return ir::is_structure(image_.types[id].kind) && !image_.types.overlaps(id);
  }

  bool is_said_by_members(TypeId id, ConstId said, Bytes have) const {
    bool same = true;
    for_each_member(id, have, [&](uint32_t i, Bytes part) {
      same = same &&
             is_said(image_.types[id].members[i].type, initial_.member_value(id, said, i), part);
    });
    return same;
  }

  bool is_said(TypeId id, ConstId said, Bytes have) const {
    const ir::Type& type = image_.types[id];
    if (image_.types.is_instance(id)) {
      const ir::Instance& row = image_.instances[id_in(have)];
      base::Bytes area(image_.layouts[row.type].used, 0);
      ir::read_initial(image_, row.data, area);
      return is_said_by_members(row.type, said, area);
    }
    if (has_parts(id)) return is_said_by_members(id, said, have);
    const bool parts =
        type.kind == Kind::kArray && (image_.types.is_instance(type.base) || has_parts(type.base));
    if (!parts) {
      base::Bytes expected(have.size(), 0);
      initial_.write_value(id, said, expected);
      return std::ranges::equal(have, expected);
    }
    const uint32_t size = image_.layouts[type.base].size;
    for (uint32_t i = 0; size != 0 && i < have.size() / size; ++i) {
      const ConstId part = initial_.element_value(id, said, i);
      if (!is_said(type.base, part, have.subspan(size_t{i} * size, size))) return false;
    }
    return true;
  }

  uint32_t id_in(Bytes slot) const {
    uint32_t id = 0;
    std::memcpy(&id, slot.data(), sizeof id);
    return id < image_.instances.size() ? id : 0;
  }

  // All that the type does not say: a value goes above everything that a declaration says.
  ConstId of_members(TypeId id, Bytes have) {
    ir::ConstValue value;
    for_each_member(id, have, [&](uint32_t i, Bytes part) {
      const ConstId own =
          of_value(image_.types[id].members[i].type, initial_.member_value(id, {}, i), part);
      if (own.valid()) value.elements.push_back({i, 1, own});
    });
    return constants_.add(std::move(value));
  }

  ConstId of_value(TypeId id, ConstId said, Bytes have) {
    if (image_.types.is_instance(id)) return of_area(id_in(have), said);
    if (is_said(id, said, have)) return {};
    if (has_parts(id)) return of_members(id, have);
    if (image_.types[id].kind == Kind::kArray) return of_elements(id, have);
    return constants_.add(of_bytes(id, have));
  }

  ConstId of_elements(TypeId id, Bytes have) {
    const TypeId element = image_.types[id].base;
    const uint32_t size = image_.layouts[element].size;
    ir::ConstValue value;
    for (uint32_t i = 0; size != 0 && i < have.size() / size; ++i) {
      const ConstId part = of_value(element, initial_.element_value(id, {}, i),
                                    have.subspan(size_t{i} * size, size));
      if (part.valid()) value.elements.push_back({i, 1, part});
    }
    return constants_.add(std::move(value));
  }

  // A scalar or a string; of a union the bytes of all members, one after the other.
  ir::ConstValue of_bytes(TypeId id, Bytes bytes) {
    const ir::Type& type = image_.types[id];
    ir::ConstValue value;
    if (type.kind == Kind::kString || type.kind == Kind::kWstring) {
      const size_t unit = type.kind == Kind::kString ? 1 : 2;
      size_t end = 0;
      while (end + unit <= bytes.size() && (bytes[end] != 0 || bytes[end + unit - 1] != 0)) {
        end += unit;
      }
      value.text.assign(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(end));
      return value;
    }
    if (image_.types.overlaps(id)) {
      for (uint32_t i = 0; i < type.members.size(); ++i) {
        const uint32_t at = image_.layouts[id].member_offsets[i];
        const uint32_t size = image_.layouts[type.members[i].type].size;
        const ConstId part = of_value(type.members[i].type, {}, bytes.subspan(at, size));
        if (part.valid()) value.elements.push_back({i, 1, part});
      }
      return value;
    }
    std::memcpy(&value.bits, bytes.data(), std::min(bytes.size(), sizeof value.bits));
    const ir::Scalar scalar = image_.types.scalar(id);
    if (ir::is_signed(scalar) && bytes.size() < sizeof value.bits) {
      const uint32_t shift = 64 - 8 * static_cast<uint32_t>(bytes.size());
      value.bits = static_cast<uint64_t>(static_cast<int64_t>(value.bits << shift) >> shift);
    }
    return value;
  }

  const ir::Image& image_;
  KnownValues constants_;
  InitialValues initial_;
};

}  // namespace

ConstId initial_difference(const ir::Image& image, ir::ConstTable& constants, uint32_t instance) {
  return Differences(image, constants).of_area(instance, {});
}

}  // namespace linker
