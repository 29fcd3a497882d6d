// Type numbers that stay: a type that the base has keeps its number there, a new one takes the
// first that is free, and so code that nobody edited names the same types (D2). A number without a
// type has a placeholder, which nothing is of.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace linker {

class TypeNumbers {
 public:
  // `base` may be null: numbers stay as they are in the program. Types meet by kind and text; those
  // that are alike (anonymous ones) in their order.
  TypeNumbers(const ir::TypeTable& types, const ir::Image* base);

  // The program's type that a type of the base is; invalid: gone.
  ir::TypeId of_base(ir::TypeId base) const { return of_base_[base.index]; }
  // Are the numbers those of the program?
  bool are_own() const;
  // From the program's numbers to those that stay, everywhere in the image.
  void apply(ir::Image& image) const;

 private:
  std::vector<uint32_t> number_of_;  // by the program's number
  std::vector<ir::TypeId> of_base_;
  uint32_t count_ = 0;  // placeholders included
};

}  // namespace linker
