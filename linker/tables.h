// The tables of bounds and ranges that all code shares: equal entries once. Those that the base has
// keep their numbers, new ones take the first that are free, so that an edit with new ones changes
// the code of no other POU (D2).
#pragma once

#include "linker/numbers.h"
#include "linker/type_numbers.h"

namespace linker {

// The key of an entry in LinkContext::table_numbers.
std::string bound_key(ir::TypeId array, uint8_t dim, const std::string& name);
std::string range_key(const ir::Range& range);

// Fills the image's tables and LinkContext::table_numbers for all objects. `base` may be null.
void fill_tables(LinkContext& context, const ir::Image* base, const TypeNumbers& types);

}  // namespace linker
