// A restart of the evaluator's variables: back to initial values where they stand, because
// references and slots point to them.
#pragma once

#include <functional>
#include <vector>

#include "ir/program/eval_variable.h"
#include "ir/program/ir.h"

namespace ir {

class EvalRestart {
 public:
  EvalRestart(const Program& program, const Layouts& layouts, Variable& globals,
              std::vector<Variable>& instances)
      : program_(program), layouts_(layouts), globals_(globals), instances_(instances) {}

  // All instances that are made are to leave when start code runs (types/stamps.h); false when
  // there are none.
  bool mark_leaving();
  // `warm`: what is RETAIN keeps its value. Start code makes every instance anew.
  void reset(bool warm);

 private:
  using Visit = std::function<void(Variable&, const Member&)>;
  void for_each_member(Variable& owner, const Visit& visit);
  void reset_area(Variable& area, ConstId init, bool warm);

  const Program& program_;
  const Layouts& layouts_;
  Variable& globals_;
  std::vector<Variable>& instances_;
};

}  // namespace ir
