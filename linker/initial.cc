#include "linker/initial.h"

#include <algorithm>
#include <cstring>

namespace linker {
namespace {

using ir::ConstId;
using ir::Kind;
using ir::Type;
using ir::TypeId;

constexpr uint32_t kMaxDepth = 1001;

void write_scalar(uint64_t bits, std::span<uint8_t> out) {
  for (size_t i = 0; i < out.size(); ++i) out[i] = static_cast<uint8_t>(bits >> (8 * i));
}

// Truncated to the capacity; what follows stays zero.
void write_string(const std::string& text, size_t unit_bytes, std::span<uint8_t> out) {
  size_t bytes = std::min(text.size(), out.size() - unit_bytes);
  bytes -= bytes % unit_bytes;
  std::memcpy(out.data(), text.data(), bytes);
}

}  // namespace

bool InitialValues::find_default(TypeId id) {
  if (defaults_[id.index] != Default::kUnknown) return defaults_[id.index] == Default::kZero;
  const Type& type = types_[id];
  bool zero = !type.init.valid();
  defaults_[id.index] = Default::kOther;  // in a circle, which is no type
  const bool has_base =
      type.kind == Kind::kArray || type.kind == Kind::kEnum || type.kind == Kind::kSubrange;
  if (zero && has_base) zero = find_default(type.base);
  if (ir::is_structure(type.kind)) {
    zero = zero && std::all_of(type.members.begin(), type.members.end(), [&](const auto& member) {
             return !member.init.valid() && find_default(member.type);
           });
  }
  if (types_.is_instance(id)) zero = true;
  defaults_[id.index] = zero ? Default::kZero : Default::kOther;
  return zero;
}

void InitialValues::write_value(TypeId type, ConstId value, std::span<uint8_t> out) const {
  write(type, value, out, 0);
}

void InitialValues::write_area(TypeId type, ConstId value, std::span<uint8_t> out) const {
  write_members(type, value, out, 0);
}

// The last mention of an element counts.
ConstId InitialValues::listed(ConstId value, uint64_t index) const {
  ConstId found;
  if (!value.valid()) return found;
  for (const ir::ConstElement& element : constants_[value].elements) {
    if (index >= element.first && index - element.first < element.count) found = element.value;
  }
  return found;
}

ConstId InitialValues::member_value(TypeId type, ConstId value, size_t number) const {
  if (const ConstId own = listed(value, number); own.valid()) return own;
  if (const ConstId own = listed(types_[type].init, number); own.valid()) return own;
  return types_[type].members[number].init;
}

ConstId InitialValues::element_value(TypeId type, ConstId value, uint64_t flat) const {
  const ConstId own = listed(value, flat);
  return own.valid() ? own : listed(types_[type].init, flat);
}

void InitialValues::write(TypeId id, ConstId value, std::span<uint8_t> out, uint32_t depth) const {
  if (!value.valid() && defaults_[id.index] == Default::kZero) return;
  const Type& type = types_[id];
  if (depth > kMaxDepth || types_.is_instance(id)) return;
  if (ir::is_structure(type.kind)) return write_members(id, value, out, depth);
  if (type.kind == Kind::kArray) return write_array(id, value, out, depth);
  if (!value.valid()) value = type.init;
  if (!value.valid() && (type.kind == Kind::kEnum || type.kind == Kind::kSubrange)) {
    return write(type.base, value, out, depth + 1);
  }
  if (!value.valid()) return;
  if (type.kind == Kind::kString) return write_string(constants_[value].text, 1, out);
  if (type.kind == Kind::kWstring) return write_string(constants_[value].text, 2, out);
  write_scalar(constants_[value].bits, out);
}

void InitialValues::write_members(TypeId id, ConstId value, std::span<uint8_t> out,
                                  uint32_t depth) const {
  const Type& type = types_[id];
  if (types_.overlaps(id)) return write_overlapping(id, value, out, depth);
  for (size_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    if (member.section == ir::Section::kInOut) continue;
    write(member.type, member_value(id, value, i),
          out.subspan(layouts_[id].member_offsets[i], layouts_[member.type].size), depth + 1);
  }
}

void InitialValues::write_overlapping(TypeId id, ConstId value, std::span<uint8_t> out,
                                      uint32_t depth) const {
  for (const ir::MemberInit& init : ir::overlap_inits(types_, constants_, id, value)) {
    const TypeId type = types_[id].members[init.member].type;
    const std::span<uint8_t> part =
        out.subspan(layouts_[id].member_offsets[init.member], layouts_[type].size);
    std::fill(part.begin(), part.end(), uint8_t{0});
    write(type, init.value, part, depth + 1);
  }
}

void InitialValues::write_array(TypeId id, ConstId value, std::span<uint8_t> out,
                                uint32_t depth) const {
  const TypeId element = types_[id].base;
  const size_t size = layouts_[element].size;
  if (size == 0 || types_.is_instance(element)) return;
  const size_t count = out.size() / size;
  std::vector<uint8_t> default_bytes(size, 0);
  write(element, ConstId(), default_bytes, depth + 1);
  const bool all_zero = std::all_of(default_bytes.begin(), default_bytes.end(),
                                    [](uint8_t byte) { return byte == 0; });
  for (size_t i = 0; i < count && !all_zero; ++i) {
    std::memcpy(out.data() + i * size, default_bytes.data(), size);
  }
  for (const ConstId list : {types_[id].init, value}) {
    if (!list.valid()) continue;
    for (const ir::ConstElement& part : constants_[list].elements) {
      for (uint64_t i = part.first; i < uint64_t{part.first} + part.count && i < count; ++i) {
        const std::span<uint8_t> slot = out.subspan(i * size, size);
        std::fill(slot.begin(), slot.end(), uint8_t{0});
        write(element, part.value, slot, depth + 1);
      }
    }
  }
}

}  // namespace linker
