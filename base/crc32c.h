// CRC-32C (Castagnoli): finds every burst of up to 32 wrong bits, and so every flipped bit and
// almost every torn sector. For damage, not for forgers; those meet SHA-256 (hash.h).
#pragma once

#include <cstdint>

#include "base/bytes.h"

namespace base {

uint32_t crc32c(ByteSpan bytes);

}  // namespace base
