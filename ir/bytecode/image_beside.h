// An image beside another version of the same program that is known decoded and encoded: what the
// two have in common is shared (base/shared.h) and not made anew. The answers are those of decode()
// and encode() alone: tables are shared where their bytes are the same, and bytes are taken where
// the tables are one.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "base/sha256.h"
#include "ir/bytecode/image.h"

namespace ir {

// Where tables that can be shared lie in an encoded image, in bytes from the beginning of their
// section; and states of its checksum.
struct ImagePlaces {
  struct Pou {
    uint32_t slots = 0;  // each ends where the next one begins
    uint32_t merges = 0;
    uint32_t lines = 0;
    uint32_t end = 0;
  };
  struct Table {
    uint32_t begin = 0;
    uint32_t end = 0;
  };
  std::vector<Pou> pous;
  Table bounds;
  Table ranges;
  Table instances;
  base::Sha256Trail trail;
};

// Borrowed; all of the same image. `bytes` is what encode() made of it, or what it was decoded of.
struct KnownImage {
  const Image& image;
  base::ByteSpan bytes;
  const ImagePlaces& places;
};

struct DecodedImage {
  Image image;
  ImagePlaces places;
};
struct WrittenImage {
  base::Bytes bytes;
  ImagePlaces places;
};

// `known`: null where there is none. `sources`: encode_sources(); empty where none travel along.
base::Result<DecodedImage> decode(base::ByteSpan bytes, const KnownImage* known);
WrittenImage encode(const Image& image, const KnownImage* known, base::ByteSpan sources = {});

}  // namespace ir
