// One object -> linked code: table indices become offsets, numbers and indices of
// the image's tables. Operands that 16 bits do not reach get loads and stores
// through scratch slots around their instruction; jumps, merges and lines follow.
#pragma once

#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/numbers.h"

namespace linker {

struct LinkedCode {
  ir::LinkedPou pou;  // without first_unit and identity
  std::vector<ir::Unit> code;
};

base::Result<LinkedCode> relocate(const LinkContext& context, const ir::Object& object);

}  // namespace linker
