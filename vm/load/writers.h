// Which instructions may write given variables: what a version of a POU leaves out while they are
// forced (forced_code.h), and what stands against that. One pass over all code of an image.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "ir/bytecode/image.h"
#include "vm/load/write_targets.h"

namespace vm {

struct Writer {
  enum class How : uint8_t {
    kOnly,     // what it writes lies inside of the variable, whoever executes it
    kShared,   // the same, when it is executed for one of several instances
    kPart,     // it writes more than the variable, or it cannot be left out
    kIndexed,  // where it writes is known at run time only
    kText,     // a native function writes its result there
    kAddress,  // through a VAR_IN_OUT or a reference that may lead there
  };
  uint32_t variable = 0;  // index
  uint32_t pou = 0;       // number in the image
  uint32_t unit = 0;      // of that POU
  How how = How::kOnly;
};

// Writers with kAddress are named in so many POUs.
inline constexpr size_t kMostAddressPous = 100;
// Sorted by variable, POU and unit.
// `running`: those POUs alone write, by number; others may have given addresses before. Null: all.
std::vector<Writer> find_writers(const ir::Image& image, std::span<const Variable> variables,
                                 const std::vector<bool>* running = nullptr);

// What code of some POUs does that decides who writes the variables.
struct WriteEffects {
  // Of a variable; each more can only mean more writers.
  enum : uint8_t { kWrites = 1, kPasses = 2, kReferences = 4 };
  std::vector<uint8_t> of_variables;
  // Stores and further uses of addresses from outside: which, of what, from where on, how many
  // bytes.
  std::set<std::array<uint64_t, 5>> of_addresses;
  bool calculates = false;  // addresses of any variable

  // Does code that does all this write whatever code with these effects writes?
  bool include(const WriteEffects& others) const;
};
WriteEffects write_effects(const ir::Image& image, std::span<const Variable> variables,
                           std::span<const uint32_t> pous);

}  // namespace vm
