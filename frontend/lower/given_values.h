// Values that a declaration gives a new instance, `a : FB := (x := 99)`. By the standard they are
// there when FB_Init runs. With CODESYS and TwinCAT FB_Init finds those of the block, and these are
// written after it. The data of an image have 99 on all ways, so code of those dialects takes it
// back before FB_Init and writes it again. Retained variables are left out: what was kept for them
// would be lost at a warm start. So are references, which FB_Init may follow.
#pragma once

#include <vector>

#include "frontend/lower/body_phase.h"

namespace frontend {

class GivenValues : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  // Do they come after FB_Init, by the dialect?
  bool come_late() const { return sema_.options.dialect != Dialect::kIec; }
  // What `given` lists gets the value that it has in every instance of the block.
  void take_back(const ir::Place& at, ir::TypeId type, ir::ConstId given);
  void write(const ir::Place& at, ir::TypeId type, ir::ConstId given);

  // An instance without start code of its own may have some with it inside, to which `given` gives
  // values as well. Takes those of the new ones back, and remembers for write_inner() which they
  // are.
  void find_inner(const ir::Place& at, ir::TypeId type, ir::ConstId given);
  void write_inner();

 private:
  struct Inner {
    ir::Place at;
    ir::TypeId type;
    ir::ConstId given;
    ir::Place fresh;  // BOOL, or an array of it: it was new before its FB_Init ran
  };
  void set(const ir::Place& at, ir::TypeId type, ir::ConstId listed, ir::ConstId values);
  void set_member(const ir::Place& at, const ir::Member& member, ir::ConstId listed,
                  ir::ConstId values);
  void remember(const ir::Place& at, const PouInfo& block, ir::TypeId type, ir::ConstId given);
  void remember_each(const ir::Place& at, const PouInfo& element, ir::TypeId array,
                     ir::ConstId given);
  ir::Place flag_of(const Inner& array, const ir::Place& element) const;

  std::vector<Inner> inner_;
};

}  // namespace frontend
