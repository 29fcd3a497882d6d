// Phase: EN and ENO around a call (enable.cc). It reads arguments and writes the code that leaves
// the call out, or catches what traps in it.
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"

namespace frontend {

// EN and ENO of one call.
struct Enable {
  const Arg* en = nullptr;
  const Arg* eno = nullptr;
  std::optional<Target> target;  // of ENO
  ir::BlockId skip;              // where EN is FALSE
  ir::BlockId handler;           // of what traps in the call, when ENO is connected
  ir::BlockId done;
};

class EnableCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  std::optional<Enable> enable_of(const Expr& call, const Callee& callee);
  void open_enable(Enable& enable);
  // `type` is that of the result, invalid when there is none; `otherwise` its value without a call.
  void close_enable(Enable& enable, ir::ValueList result, ir::TypeId type, uint64_t otherwise = 0);
  uint64_t default_bits(ir::TypeId type) const;

 private:
  void store_eno(const Enable& enable, bool good);
};

}  // namespace frontend
