// Content identity. Digest is SHA-256: images, packages and POUs are named by
// it on controllers and on the wire (E1), so it must resist a forger. hash64 is
// for tables in memory only and is never stored.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/bytes.h"

namespace base {

using Digest = std::array<uint8_t, 32>;

Digest sha256(ByteSpan bytes);
std::string to_hex(const Digest& digest);                 // 64 characters
std::string short_hex(const Digest& digest);              // first 12: what people read
bool digest_from_hex(std::string_view hex, Digest& out);  // exactly 64 characters

uint64_t hash64(ByteSpan bytes, uint64_t seed = 0);

}  // namespace base
