// One scalar or string as it lies in data memory, and as another type has it by A14.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ir/bytecode/image.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {

bool is_string(const ir::Image& image, ir::TypeId type);
// Bytes of a character.
uint32_t unit_of(const ir::Image& image, ir::TypeId type);
// As in ConstValue: sign-extended, REAL as its 32 bits.
uint64_t load(const ir::Image& image, ir::TypeId type, const uint8_t* at);

// As people read it.
std::string stored_text(const ir::Image& image, ir::TypeId type, const uint8_t* at);

// Fills `out`, but where the value has no counterpart (Converted::initialise).
Converted convert_stored(const ir::Image& old_image, ir::TypeId old_type, const uint8_t* source,
                         const ir::Image& new_image, ir::TypeId new_type, std::span<uint8_t> out);

}  // namespace online_change
