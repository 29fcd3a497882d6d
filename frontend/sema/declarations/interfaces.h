// Phase: what POUs look like from outside. Resolves all declarations in their order, and makes
// members, locals and parameters of the program of them (interface.cc, called_programs.cc).
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Interfaces : public Phase {
 public:
  using Phase::Phase;

  void resolve_declarations();
  ir::Member member_of(const Variable& variable, ir::Section section);
  // interface.cc
  void resolve_interface(uint32_t pou);
  void finish_programs();  // after all bodies
  // --- declarations (collection.cc, interface.cc, configuration.cc)
  void check_underlines();  // underlines.cc

 private:
  void resolve_globals();
  void warn_never_runs(const PouInfo& info);
};

}  // namespace frontend
