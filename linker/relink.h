// A link that can be done again for a few POUs: everything but their code, their constants and the
// tables that code shares is as it was, and what comes out is what link() makes of all objects.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/held.h"
#include "linker/link.h"
#include "linker/pool.h"

namespace linker {

// What a link leaves behind for the next one. Refers to the objects and to the base.
struct LinkState {
  ir::Image image;
  ConstantPool pool;
  std::vector<const ir::Object*> objects;                 // by POU number
  std::unordered_map<std::string, uint32_t> pou_numbers;  // as in LinkContext
  std::vector<std::vector<uint64_t>> parameter_offsets;
  std::unordered_map<std::string, uint32_t> table_numbers;
  ir::PouNames names;
  HeldNames held;
  bool own_types = true;  // the image's type numbers are those of the program
};

base::Result<LinkState> link_state(const ir::Program& program,
                                   const std::vector<ir::Object>& objects, const Options& options);

// A POU with another object than at the last link.
struct EditedPou {
  uint32_t number = 0;
  ir::Object before;
};
// Constants of the program that only their code names, and that may be others now: [first, end).
struct EditedConstants {
  uint32_t first = 0;
  uint32_t end = 0;
};
// False: link everything; the state is of no use any more.
bool relink(LinkState& state, const ir::Program& program, std::vector<EditedPou>& pous,
            std::span<const EditedConstants> constants, const Options& options);

}  // namespace linker
