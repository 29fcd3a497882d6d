// Objects -> image: layout, instance tree and IDs, areas, relocation, initial data,
// call graph and stack depth. With a base image, everything that lives on keeps
// its place: areas, instance IDs, POU numbers (A1, A5, A9).
#pragma once

#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/no_program.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"
#include "linker/layout.h"

namespace linker {

struct Options {
  Slack slack;
  const ir::Image* base = nullptr;                // the running version, or null
  bool move_all = false;                          // hard mode: give every instance a new area
  std::vector<ir::Device> devices = {};           // of stc.toml, checked (ir/bytecode/devices.h)
  std::vector<ir::SafeOutput> safe = {};          // Image::safe; the caller checks that they fit
  std::vector<ir::UnitMember> unit_members = {};  // Image::unit_members; names nobody has are kept
  uint32_t jobs = 1;                              // threads at most; the image is the same
  // Tests ask for less, so that the limits can be reached.
  uint32_t max_instances = base::kMaxInstances;
  uint32_t max_code_units = base::kMaxCodeUnits;
};

// The version that a link goes on from; null: none. To one that is no program the next version is a
// first one, so that it is the same image however it comes to a controller.
inline const ir::Image* base_of(const Options& options) {
  const bool first = options.base == nullptr || ir::is_no_program(*options.base);
  return first ? nullptr : options.base;
}

base::Result<ir::Image> link(const ir::Program& program, const std::vector<ir::Object>& objects,
                             const Options& options);

}  // namespace linker
