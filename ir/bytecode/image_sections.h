// The parts of an encoded image, without decoding it.
#pragma once

#include <cstdint>

#include "base/bytes.h"

namespace ir {

// In stored order.
enum class ImageSection : uint8_t {
  kProgram,
  kTypes,
  kConstants,
  kLayouts,
  kPous,
  kCode,
  kTables,
  kData,
  kDevices,
  kSources  // only where sources travel along (embedded_sources.h); no part of ir::Image
};
// How many of these sections an image has.
inline constexpr uint32_t kImageSectionCount = 9;
// The content of the section; empty when the image is cut off before its end.
base::ByteSpan section_of(base::ByteSpan encoded, ImageSection section);
// What digest() is the SHA-256 of in a sound image; empty when there is not even a header.
base::ByteSpan sealed_part(base::ByteSpan encoded);

}  // namespace ir
