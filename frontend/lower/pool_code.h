// __NEW and __DELETE, and the methods __RESET and __LEAVE of what lies in pools
// (sema/objects/pools.h).
#pragma once

#include "frontend/lower/start_code.h"

namespace frontend {

class PoolCode : public BodyPhase {
 public:
  PoolCode(Lowering& body, const PouScope& scope) : BodyPhase(body, scope), start_(body, scope) {}

  // The first free element, as new, or NULL.
  ir::ValueId make(const Expr& call);
  // The element that `argument` points to is free again, and the pointer NULL.
  void destroy(const Expr& call);
  // All variables have their initial values, those of instances too.
  void reset(const ir::Place& at, ir::TypeId type, ir::ConstId init);
  void reset_method();  // all variables of the instance have their initial values
  void leave_method();  // FB_Exit of the instances in it
  // In __START: what is in use is visited there too.
  void visit_all();

 private:
  using PerElement = std::function<void(const ir::Place& element, const ir::Place& state)>;
  // Goes through the pool; `each` may leave by a jump.
  void search(const Pool& pool, const PerElement& each);
  ir::ValueId has_state(const ir::Place& state, uint64_t wanted);
  void set_state(const ir::Place& state, uint64_t value);
  ir::ValueId handle(const Pool& pool, const ir::Place& element);
  void free(const Pool& pool, const ir::Place& element, const ir::Place& state);
  void call_made(uint32_t method, const ir::Place& at);
  void reset_elements(const ir::Place& at, ir::TypeId type, ir::ConstId init);
  void leave(const ir::Place& at, ir::TypeId type);

  StartCode start_;
};

}  // namespace frontend
