// Digests as they are stored and sent: their bytes.
#pragma once

#include <algorithm>

#include "base/hash.h"

namespace base {

// All zero where `in` has failed.
inline Digest read_digest(ByteReader& in) {
  Digest digest{};
  const ByteSpan bytes = in.raw(digest.size());
  std::copy(bytes.begin(), bytes.end(), digest.begin());
  return digest;
}

}  // namespace base
