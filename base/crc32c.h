// CRC-32C (Castagnoli): finds every burst of up to 32 wrong bits, and so every flipped bit and
// almost every torn sector. For damage, not for forgers; those meet SHA-256 (hash.h).
#pragma once

#include <cstdint>

#include "base/bytes.h"

namespace base {

// By what x86 processors with SSE 4.2 have for it, else by tables; both give the same.
uint32_t crc32c(ByteSpan bytes);
uint32_t crc32c_portable(ByteSpan bytes);

}  // namespace base
