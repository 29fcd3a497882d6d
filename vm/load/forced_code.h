// The code of a generation for as long as some of its variables are forced: versions of the POUs
// that write them, so that every reader finds the forced value all through a scan
// (docs/adr/0026-forced-versions.md). A store that can only lead to a forced variable is no
// operation in a version, and machine code is made of it. After any other store that may write
// one, that gets its value again; such a version is interpreted. Made off the control thread; it
// takes the place of the generation's own code between two scans, by one store.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/pou_version.h"
#include "vm/exec/store_aside.h"
#include "vm/load/generation.h"
#include "vm/load/writers.h"

namespace vm {

// More POUs than these are not interpreted for one variable.
inline constexpr size_t kMostRestoringPous = 32;

struct ForcedVariable {
  Variable place;
  base::Bytes value;
  uint8_t mask = 0;  // ir::Symbol::bit_mask: what writes the byte writes other bits, too
};

// ir::verify_versions(), or what a test has instead.
using VerifyVersions = std::function<std::vector<base::Status>(const ir::VerifiedImage&,
                                                               std::span<const ir::PouVersion>)>;

class ForcedCode {
  struct Key {};

 public:
  explicit ForcedCode(Key) {}
  // `own`: the code of the image. Null when there is nothing to say: no variable, or nobody writes
  // one of them.
  static std::shared_ptr<const ForcedCode> make(const ir::VerifiedImage& image,
                                                const CodeTable& own,
                                                std::span<const ForcedVariable> variables,
                                                const TierOptions& tier,
                                                const VerifyVersions& verify = ir::verify_versions);

  // What executions run.
  const CodeTable& table() const { return table_; }
  // Why the stores to the variable of that index stay, so that its force holds at the boundaries of
  // cycles only; "": it holds everywhere.
  const std::string& reason(size_t variable) const { return reasons_[variable]; }
  // How many POUs have a version.
  size_t versions() const { return code_.size(); }

 private:
  struct Version {
    std::vector<ir::Unit> units;                          // as in an image
    std::map<uint32_t, std::vector<uint32_t>> restoring;  // by unit: the variables
  };
  using Versions = std::map<uint32_t, Version>;  // by POU

  static std::vector<ir::PouVersion> rows_of(const Versions& versions);
  void describe(const ir::Image& image, const std::vector<Writer>& writers);
  Versions versions_of(const ir::Image& image, const std::vector<Writer>& writers) const;
  bool refuse_versions(const std::vector<ir::PouVersion>& versions,
                       const std::vector<base::Status>& answers,
                       const std::vector<Writer>& writers);
  void put_aside(const Version& version, std::vector<ir::Unit>& decoded);

  CodeTable table_;
  std::vector<std::vector<ir::Unit>> code_;  // decoded
  std::deque<StoreAside> asides_;
  std::vector<ForcedVariable> variables_;
  std::vector<std::string> reasons_;
};

// What does nothing and passes wherever `store`, which is without a trap and writes no frame, does.
ir::Unit without_store(const ir::Unit& store);

}  // namespace vm
