// Instructions that count what a run reaches (frontend/coverage.h), for the body of one POU. It
// writes through the builder, and nothing where the build has no coverage.
#pragma once

#include <string>

#include "frontend/coverage.h"
#include "frontend/lower/builder.h"
#include "frontend/parse/tree.h"

namespace frontend {

struct PouInfo;

class Counting {
 public:
  Counting(Builder& build, const Tree& tree, const PouInfo& info)
      : build_(build), tree_(tree), info_(info) {}

  // From here on, where `coverage` (null: there is none) counts the POU.
  void begin(Coverage* coverage, const std::string& pou);
  bool on() const { return coverage_ != nullptr; }
  void count(SiteKind kind, base::SourcePos at, const std::string& name = {}, uint32_t side = 0);
  void statement(const Stmt& stmt);
  // A coil, or a BOOL that a network writes: with power and without.
  void power(ir::ValueId power, ExprId target, base::SourcePos at);
  // Goes on at `yes` or `no`, and counts both.
  void decide(ir::ValueId condition, ir::BlockId yes, ir::BlockId no, base::SourcePos at,
              const char* what);

 private:
  Builder& build_;
  const Tree& tree_;
  const PouInfo& info_;
  Coverage* coverage_ = nullptr;
  const network::Network* rung_ = nullptr;  // the last that was counted
};

}  // namespace frontend
