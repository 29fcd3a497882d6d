// Sizes of drawn elements in the units of a document, which are pixels for most editors, and where
// their pins are.
#pragma once

#include <cstddef>

#include "adapters/xml/document.h"

namespace plcopen {

using xml::Node;

struct Extent {
  int width = 0;
  int height = 0;
};

inline constexpr int kLetter = 8;        // width
inline constexpr int kPinDistance = 20;  // of a block
inline constexpr int kFirstPin = 30;     // of a block, below its type
inline constexpr int kTextHeight = 30;
inline constexpr Extent kContactExtent = {21, 15};
inline constexpr Extent kRailExtent = {10, 40};

// Of a block with so many letters in its longest pins, in its type, and rows of pins.
Extent extent_of_box(int pin_letters, int type_letters, size_t rows);
Extent extent_of_text(int letters);  // a variable, a jump
int pin_of(Extent extent);           // where the first pin of what is no block is, from the top

// Sizes, pins and ways of wires of all bodies below `node`, where they are missing.
void put_geometry(Node node);

}  // namespace plcopen
