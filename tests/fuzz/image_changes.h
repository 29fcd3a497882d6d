// Changes to an image that its form allows and its meaning often not: what targets make of it is
// encoded again, so that all hashes are right.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace fuzz {

struct Change {
  uint8_t what;
  uint16_t where;
  uint16_t value;
  uint8_t how;
};

// Sets, flips a bit of, or moves a number.
template <class T>
void alter(T& number, const Change& change) {
  auto wide = static_cast<uint64_t>(number);
  switch (change.how % 4) {
    case 0:
      wide = change.value;
      break;
    case 1:
      wide ^= uint64_t{1} << (change.value % 64);
      break;
    case 2:
      wide += change.value % 9;
      break;
    default:
      wide -= change.value % 9;
      break;
  }
  number = static_cast<T>(wide);
}

// Null: the list is empty.
template <class T>
T* pick(std::vector<T>& list, uint32_t where) {
  return list.empty() ? nullptr : &list[where % list.size()];
}

template <class T>
T* pick(base::SharedVector<T>& list, uint32_t where) {
  return list.empty() ? nullptr : &list[where % list.size()];
}

void apply(ir::Image& image, const Change& change);

}  // namespace fuzz
