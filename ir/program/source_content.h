// What the text of a POU says, whatever its layout (docs/adr/0035-contents-of-pous.md).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"

namespace ir {

struct SourceContent {
  base::Digest identity{};      // E-02; 0: the compiler has made the POU
  std::vector<uint32_t> words;  // word_hash() of each name in it, sorted, none twice
};

// `folded` is a name without qualification, in the one case of all names. Others may have the same.
inline uint32_t word_hash(std::string_view folded) {
  return static_cast<uint32_t>(base::hash64(base::as_bytes(folded)));
}

}  // namespace ir
