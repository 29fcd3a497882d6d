// Goes through all code and declarations of a project once, in the order of the tree: statements,
// charts, types, configurations. Says of each expression whether it is read or written.
#pragma once

#include "frontend/parse/tree.h"
#include "frontend/sema/model.h"

namespace frontend::questions {

enum class Use : uint8_t { kRead, kWritten, kBoth };

class Walker {
 public:
  explicit Walker(const Tree& tree) : tree_(tree) {}
  virtual ~Walker() = default;

 protected:
  // Each expression, before those that it consists of.
  virtual void visit(const Expr&, ExprId, Use) {}
  // Is x.a, x[i] or x.3 a part of the value of x? Not where x is a pointer, for example.
  virtual bool is_part(const Expr&) { return true; }
  // What a call does with what its argument of that number names.
  virtual Use use_by(const Expr& call, uint32_t argument);
  virtual void visit(const Spec&, SpecId) {}

  void statements(Range32 list);
  void chart(const Chart& chart);
  void expression(ExprId id, Use use = Use::kRead);
  void spec(SpecId id);

  const Tree& tree_;

 private:
  void statement(const Stmt& stmt);
  void arguments(const Expr& call);
  void arguments(Range32 list);
  void expressions(Range32 list);
};

}  // namespace frontend::questions
