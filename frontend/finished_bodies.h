// Gives the memory of bodies back while they are lowered: the expressions of the tree and what is
// known of them are half of what a build of a large project takes, and nobody reads those of a body
// once it has its instructions. So the instructions of later bodies live where the expressions of
// earlier ones were. For compilations that go through the tree once (compile.cc): the resident
// front end, tests and several resources keep the tree.
#pragma once

#include <unordered_map>
#include <vector>

#include "frontend/parse/tree.h"
#include "frontend/sema/sema.h"

namespace frontend {

class FinishedBodies {
 public:
  // When all declarations are known and no body is lowered yet. `tree` is the one that `sema`
  // reads.
  FinishedBodies(Sema& sema, Tree& tree);
  // That body is lowered.
  void finish(uint32_t pou);

 private:
  void number(const PouDecl& pou, uint32_t top);
  void give_back(const PouDecl& pou);

  Sema& sema_;
  Tree& tree_;
  std::unordered_map<const PouDecl*, uint32_t> top_of_;  // with members: index in Tree::pous
  std::vector<uint32_t> left_;  // by that: bodies that are not lowered, or kKept
  std::vector<uint32_t> open_;  // by chunk of bodies: POUs in it that are not finished
};

}  // namespace frontend
