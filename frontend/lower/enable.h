// EN and ENO of one call.
#pragma once

#include <optional>

#include "frontend/lower/target.h"

namespace frontend {

struct Enable {
  const Arg* en = nullptr;
  const Arg* eno = nullptr;
  std::optional<Target> target;  // of ENO
  ir::BlockId skip;              // where EN is FALSE
  ir::BlockId handler;           // of what traps in the call, when ENO is connected
  ir::BlockId done;
};

}  // namespace frontend
