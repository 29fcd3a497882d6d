// Phase: what can be assigned (target.cc). It asks whether code may write there (write_checks.h),
// and writes the code that loads and stores.
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"

namespace frontend {

class Targets : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  std::optional<Target> target(ExprId expr);
  void store(const Target& target, ir::ValueId value);
  ir::ValueId load(const Target& target);

 private:
  ir::Scalar base_scalar(const Target& target) const;
  ir::ValueId load_base(const Target& target);
  void store_base(const Target& target, ir::ValueId value);
};

}  // namespace frontend
