// Code of a POU as the interpreter runs it: handler numbers in the op fields, what types say in the
// place of their numbers, and fused handlers and truth tables where the options want them.
#pragma once

#include <span>
#include <vector>

#include "ir/bytecode/image.h"
#include "vm/exec/tier.h"

namespace vm {

// Types whose values hold ID or in-out slots; instance types themselves included.
std::vector<bool> types_with_slots(const ir::Image& image);

// Decodes one image, which is verified and borrowed.
class Decoder {
 public:
  // Do its BOOLs stay clean (ir/bytecode/bools.h)?
  Decoder(const ir::Image& image, bool clean_bools, const TierOptions& tier);
  // Does the code of a POU follow from its units, the types and whose methods there are? Truth
  // tables rely on more.
  bool goes_by_units() const { return !fuses_ || !has_tables_; }
  // Verified units of `pou`, of that image. What follows them in `decoded` is theirs, too.
  void run(const ir::LinkedPou& pou, std::span<const ir::Unit> units,
           std::vector<ir::Unit>& decoded) const;
  // Decodes so that each instruction has a handler of its own.
  void run_unfused(std::span<const ir::Unit> units, std::vector<ir::Unit>& decoded) const;

 private:
  const ir::Image& image_;
  std::vector<bool> has_slots_;  // by type
  bool fuses_;
  uint64_t seed_;
  bool has_tables_;
  uint32_t logic_line_;
};

}  // namespace vm
