// Code of a POU as the interpreter runs it: handler numbers in the op fields, what types say in the
// place of their numbers, and fused handlers where the options want them.
#pragma once

#include <span>
#include <vector>

#include "ir/bytecode/image.h"
#include "vm/exec/tier.h"

namespace vm {

// Of one image, which is verified and borrowed.
class Decoder {
 public:
  Decoder(const ir::Image& image, const TierOptions& tier);
  // Verified units of a POU of that image.
  void run(std::span<const ir::Unit> units, std::vector<ir::Unit>& decoded) const;
  // The same, and each instruction has a handler of its own.
  void run_unfused(std::span<const ir::Unit> units, std::vector<ir::Unit>& decoded) const;

 private:
  const ir::Image& image_;
  std::vector<bool> has_slots_;  // by type
  bool fuses_;
  uint64_t seed_;
};

}  // namespace vm
