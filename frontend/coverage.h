// What a build for coverage counts: a counter for each place of the sources that tests should
// reach (docs/UNIT-TESTS.md). Lowering adds the places while it makes code, in front of every pass
// of the optimiser, so none gets lost; code counts into one hidden global array. Without a Coverage
// in CompileOptions there is no such array, and no instruction more.
//
// The caller owns it; it serves one compilation, and lives as long as that.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/source.h"
#include "ir/program/ir.h"

namespace frontend {

struct Tree;

// The hidden global: ARRAY OF UDINT, one element for each site.
inline constexpr const char* kCoverageCounters = "__COVERAGE";

enum class SiteKind : uint8_t {
  kPou,         // its body was called
  kStatement,   // of ST and IL, also in actions of charts
  kBranch,      // one side of a decision; those of one follow each other
  kRung,        // of ladder; of a function block diagram: a network
  kStep,        // was active
  kTransition,  // fired
};
inline constexpr uint32_t kSiteKinds = 6;

struct Site {
  SiteKind kind = SiteKind::kStatement;
  uint32_t file = 0;  // of the SourceMap that was compiled
  uint32_t line = 0;
  uint32_t decision = 0;  // kBranch: its number, from 0
  std::string name;       // of the POU, step or transition; of a side: "IF: TRUE"
};

class Coverage {
 public:
  // --- for the front end
  // Adds the global; files with a TEST are not counted, nor are those from `library_file` on.
  void begin(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
             ir::Program& program);
  bool counts(base::SourcePos at) const;
  // Where the counter is of what begins at `at`; what is lowered twice has one. `side` of a
  // decision, from 0.
  ir::Place counter(SiteKind kind, base::SourcePos at, uint32_t side, const std::string& name);
  // After all bodies: the global gets its size.
  void finish(ir::Program& program) const;

  // --- for who reads the counters: in their order
  const std::vector<Site>& sites() const { return sites_; }

 private:
  const base::SourceMap* sources_ = nullptr;
  uint32_t library_file_ = 0;
  std::unordered_set<uint32_t> test_files_;
  std::unordered_map<uint64_t, uint32_t> numbers_;    // by place, kind and side
  std::unordered_map<uint32_t, uint32_t> decisions_;  // by offset
  std::vector<Site> sites_;
  ir::Place global_;
  ir::TypeId number_;
};

}  // namespace frontend
