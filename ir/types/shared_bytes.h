// Variables at overlapping addresses (`w AT %MW4`, `b AT %MB8`) share bytes: they are the members
// of one hidden global, whose type is a structure with overlapping members. Its name is that of its
// first and last byte, "%MB8..11". No path has that name in it: `w` is the path of the member `w`,
// `Main.b` that of a variable of a program.
//
// A BOOL at a bit of such bytes (`x AT %MX8.3`) is a member of type BYTE with the bit in its
// address: bit_size 1, bit_offset 3 after the byte.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/types/types.h"

namespace ir {

std::string shared_name(DirectArea area, uint32_t first_byte, uint32_t last_byte);
// Is that member of the globals the hidden one?
bool is_shared(const TypeTable& types, const Member& global);

// Member `member` of the hidden global `global`.
struct SharedMember {
  size_t global = 0;
  size_t member = 0;
};
// The variable of that name among those of all hidden globals.
std::optional<SharedMember> find_shared(const TypeTable& types, TypeId globals,
                                        std::string_view name);

// The address of member `member` of hidden global `global`.
DirectAddress shared_address(const TypeTable& types, const Member& global, size_t member);
inline bool is_shared_bit(const Member& member) { return member.address.bit_size == 1; }
// In its byte; 0: the member is no such bit.
uint8_t bit_mask_of(const TypeTable& types, TypeId owner, const Member& member);

}  // namespace ir
