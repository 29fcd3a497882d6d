// Bytes made smaller: pieces that were there before are named by their distance. Whether packed
// bytes are sound, and how many they become, is known without unpacking them: no memory, and time
// that is linear in what is packed. So nobody is surprised by few bytes that become very many.
//
// Stored form: pieces to the end, each {u8 token, bytes, a copy}. The upper four bits of a token
// say how many bytes follow, the lower four how long the copy is: 0 none, else 3 more. A 15 is
// followed by a number that is added. After the length: how far back the copy begins. A piece
// makes at least one byte. Numbers have seven bits a byte, the lowest first.
#pragma once

#include <cstdint>
#include <optional>

#include "base/bytes.h"

namespace base {

inline constexpr uint32_t kInToken = 15;  // a number follows

// Equal bytes always become equal bytes. The result has at most a byte more for each 2^21 that
// repeat nothing, and a few.
Bytes pack(ByteSpan bytes);
// How many bytes unpack() makes; nullopt when it is damaged, or would make more than `limit`.
std::optional<uint64_t> unpacked_size(ByteSpan packed, uint64_t limit);
// Nullopt as above.
std::optional<Bytes> unpack(ByteSpan packed, uint64_t limit);

}  // namespace base
