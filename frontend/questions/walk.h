// Goes through all code and declarations of a project once, in the order of the tree: statements,
// charts, types, configurations. Says of each expression whether it is written.
#pragma once

#include "frontend/parse/tree.h"
#include "frontend/sema/model.h"

namespace frontend::questions {

class Walker {
 public:
  explicit Walker(const Tree& tree) : tree_(tree) {}
  virtual ~Walker() = default;

 protected:
  // Each expression, before those that it consists of.
  virtual void visit(const Expr&, ExprId, bool /*written*/) {}
  virtual void visit(const Spec&, SpecId) {}

  void statements(Range32 list);
  void chart(const Chart& chart);
  void expression(ExprId id, bool written = false);
  void spec(SpecId id);

  const Tree& tree_;

 private:
  void statement(const Stmt& stmt);
  void arguments(Range32 list);
  void expressions(Range32 list);
};

}  // namespace frontend::questions
