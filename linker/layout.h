// The stable layout database: offsets for every type of a new version, given the
// layouts of the running one. A member with the same name (without case) and the same type keeps
// its offset (A1, A4); deleted members become holes; changed and added ones go first fit into holes
// that were free before, then after, and into holes that this very change frees only when nothing
// else is left inside the capacity (so that their initial value can be written before the switch,
// A19). The members of a structure that is new lie in the order of their declaration, each aligned.
// Areas get slack when they are first laid out and keep their capacity while the contents fit
// (A5 iii, A8). What extends a block has the members of its base where the base has them, and its
// own ones after the base's capacity, so that the base can grow in its slack
// (docs/adr/0006-objects.md). A structure inside a union has nothing but its declaration to go by:
// the union's other members see its bytes.
#pragma once

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/types/layout.h"

namespace linker {

// Slack sizes of a project (A6), from stc.toml.
struct Slack {
  uint32_t globals_percent = 25;
  uint32_t globals_bytes = 256;  // at least
  uint32_t instance_percent = 25;
  uint32_t instance_bytes = 16;
  uint32_t program_percent = 25;
  uint32_t program_bytes = 64;
  uint32_t free_bytes = 64 * 1024;  // free area after all others
  uint32_t free_percent = 25;       // of the areas, if more
};

// `base` may be null: a first version. Equal types are recognised by name and
// content across the two tables.
base::Result<ir::Layouts> lay_out(const ir::TypeTable& types, const Slack& slack,
                                  const ir::Image* base);

}  // namespace linker
