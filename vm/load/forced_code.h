// The code of a generation for as long as some of its variables are forced: versions of the POUs
// that write them, in which those stores are no operations, so that every reader finds the forced
// value all through a scan (docs/adr/0026-forced-versions.md). Made off the control thread; it
// takes the place of the generation's own code between two scans, by one store.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vm/load/generation.h"
#include "vm/load/writers.h"

namespace vm {

class ForcedCode {
  struct Key {};

 public:
  explicit ForcedCode(Key) {}
  // `own`: the code of the image. Null when there is nothing to say: no variable, or nobody writes
  // one of them.
  static std::shared_ptr<const ForcedCode> make(const ir::VerifiedImage& image,
                                                const CodeTable& own,
                                                std::span<const Variable> variables,
                                                const TierOptions& tier);

  // What executions run.
  const CodeTable& table() const { return table_; }
  // Why stores to the variable of that index stay, so that its force holds at the boundaries of
  // cycles only; "": it holds everywhere.
  const std::string& reason(size_t variable) const { return reasons_[variable]; }
  // How many POUs have a version.
  size_t versions() const { return code_.size(); }

 private:
  CodeTable table_;
  std::vector<std::vector<ir::Unit>> code_;  // decoded
  std::vector<std::string> reasons_;
};

// What does nothing and passes wherever `store`, which is without a trap and writes no frame, does.
ir::Unit without_store(const ir::Unit& store);

}  // namespace vm
