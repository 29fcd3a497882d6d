// The block function of SHA-256: in portable C++, and with the instructions that most x86
// processors have for it. Both give the same state; sha256_blocks() takes the faster one that
// this processor can run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/hash.h"

namespace base {

using Sha256State = std::array<uint32_t, 8>;

alignas(16) extern const uint32_t kSha256Round[64];

void sha256_blocks(Sha256State& state, const uint8_t* data, size_t blocks);
void sha256_blocks_portable(Sha256State& state, const uint8_t* data, size_t blocks);
// False, and nothing done, when this processor has no such instructions.
bool sha256_blocks_x86(Sha256State& state, const uint8_t* data, size_t blocks);

// The digest of both, one after the other.
Digest sha256(ByteSpan first, ByteSpan second);

// States on the way through long bytes, one after each kStep of them: the sum of others that begin
// alike goes on from there.
struct Sha256Trail {
  static constexpr size_t kStep = 64 << 10;  // whole blocks
  std::vector<Sha256State> states;
};
// `known` is the trail of bytes of which the first `same` are those of `bytes` too (0: of none).
// `trail`, another one, becomes the trail of `bytes`.
Digest sha256(ByteSpan bytes, const Sha256Trail& known, size_t same, Sha256Trail& trail);

}  // namespace base
