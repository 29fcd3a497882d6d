// One object -> linked code: table indices become offsets, numbers and indices of
// the image's tables. Operands that 16 bits do not reach get loads and stores
// through scratch slots around their instruction; jumps, merges and lines follow.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/frame.h"
#include "linker/pool.h"

namespace linker {

// What relocation needs of the whole program, and the tables that it fills.
struct LinkContext {
  const ir::Program& program;
  ir::Image& image;  // types, layouts, instances are set; bounds and ranges are added to
  const ConstantPool& pool;
  std::unordered_map<std::string, uint32_t> pou_numbers;    // by folded name
  std::vector<const ir::Object*> objects;                   // by POU number
  std::vector<std::vector<uint64_t>> parameter_offsets;     // by POU number, then slot
  std::unordered_map<std::string, uint32_t> table_numbers;  // of bounds and ranges
};

struct LinkedCode {
  ir::LinkedPou pou;  // without first_unit and identity
  std::vector<ir::Unit> code;
};

base::Result<LinkedCode> relocate(LinkContext& context, const ir::Object& object);

}  // namespace linker
