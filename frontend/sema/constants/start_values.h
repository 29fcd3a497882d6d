// References that no constant can initialise: `p : POINTER TO INT := ADR(x)`. Their initial value
// is an unbound handle (ir/types/handle.h) that stands for the expression; start code, or the POU
// for its own variables, puts the reference there where it still finds this handle. So a reference
// is bound once, also when a change adds it, and a change keeps what the program made of it.
// The handle is made of names and text: the same expression has the same one in every version.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "frontend/sema/model.h"

namespace frontend {

class Sema;

class StartValues {
 public:
  explicit StartValues(Sema& sema) : sema_(sema) {}

  // The initial value that stands for `expr`, in the scope.
  ir::ConstId add(const PouScope& scope, ExprId expr);
  bool empty() const { return expressions_.empty(); }
  // Invalid: the handle is none of these.
  ExprId find(uint64_t handle) const;
  // Does a variable of this type with this initial value (invalid: the default) hold one? Of an
  // instance, only what `init` gives: what its block gives is a matter of the block.
  bool inside(ir::TypeId type, ir::ConstId init);

 private:
  std::string scope_name(const PouScope& scope) const;
  bool look_inside(ir::TypeId type, ir::ConstId init);

  struct Expression {
    ExprId expr;
    std::string text;
  };
  Sema& sema_;
  std::unordered_map<uint64_t, Expression> expressions_;
  std::map<std::pair<ir::TypeId, ir::ConstId>, bool> inside_;
};

}  // namespace frontend
