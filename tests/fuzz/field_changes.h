// A change to one field of an image, whichever it is: all fields are as likely as each other, however
// many records a table has (image_walk.h). What comes of it is encoded again, so that all hashes are
// right.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/fuzz/image_walk.h"

namespace fuzz {

// The fields and lists that an image has, in stored order.
struct ImageField {
  FieldPlace place;
  uint32_t section = 0;
  uint32_t count = 0;  // how often; 0: it was only seen to be there
};
std::vector<ImageField> fields_of(ir::Image image);

struct FieldChange {
  static constexpr size_t kBytes = 8;
  // Of kBytes that come from outside; the number says the how manieth of a script they are.
  FieldChange(const uint8_t* bytes, uint64_t number);
  FieldChange(uint16_t f, uint16_t w, uint16_t v, uint16_t h)
      : field(f), which(w), value(v), how(h) {}
  uint16_t field;  // of fields_of()
  uint16_t which;  // of so many
  uint16_t value;
  uint16_t how;
};

// `fields`: of this image, or of one that it was made of.
void apply(ir::Image& image, const std::vector<ImageField>& fields, const FieldChange& change);

}  // namespace fuzz
