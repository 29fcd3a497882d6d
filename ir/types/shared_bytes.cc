#include "ir/types/shared_bytes.h"

namespace ir {

std::string shared_name(DirectArea area, uint32_t first_byte, uint32_t last_byte) {
  const char letter = area == DirectArea::kOutput ? 'Q' : area == DirectArea::kInput ? 'I' : 'M';
  return std::string("%") + letter + "B" + std::to_string(first_byte) + ".." +
         std::to_string(last_byte);
}

bool is_shared(const TypeTable& types, const Member& global) {
  return global.name.starts_with('%') && types.overlaps(global.type);
}

std::optional<SharedMember> find_shared(const TypeTable& types, TypeId globals,
                                        std::string_view name) {
  const std::vector<Member>& all = types[globals].members;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!is_shared(types, all[i])) continue;
    const int32_t found = types.find_member(all[i].type, name);
    if (found >= 0) return SharedMember{i, static_cast<size_t>(found)};
  }
  return std::nullopt;
}

uint8_t bit_mask_of(const TypeTable& types, TypeId owner, const Member& member) {
  const bool bit = types.overlaps(owner) && is_shared_bit(member) &&
                   member.address.area == DirectArea::kNone &&
                   types[member.type].kind == Kind::kByte;
  return bit ? static_cast<uint8_t>(1u << member.address.bit_offset % 8) : uint8_t{0};
}

DirectAddress shared_address(const TypeTable& types, const Member& global, size_t member) {
  DirectAddress address = types[global.type].members[member].address;
  address.area = global.address.area;
  address.bit_offset += global.address.bit_offset;
  return address;
}

}  // namespace ir
