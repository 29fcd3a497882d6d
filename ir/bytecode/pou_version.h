// PouVersion: other code for a POU of an image, with the same length, with the POU's tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ir/bytecode/verify.h"

namespace ir {

struct PouVersion {
  uint32_t pou = 0;  // number
  std::span<const Unit> units;
  bool interpreted = false;  // machine code could not do what it does besides
};

// Would the image be as good with this code (rules V3 to V12, V19, V20)? An answer for each. It
// calls what the POU calls, else that is kBadCall.
std::vector<base::Status> verify_versions(const VerifiedImage& image,
                                          std::span<const PouVersion> versions);

}  // namespace ir
