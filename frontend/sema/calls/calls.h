// Phase: calls. What is called, which argument is for which parameter, and what comes back
// (infer_call.cc, enable.cc, typed_functions.cc, bounds.cc, infer_reference.cc). Reads declarations
// and expressions; what the library offers is collected when it is called.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Calls : public Phase {
 public:
  using Phase::Phase;

  Callee callee(const Expr& call);
  bool takes_typed(const Callee& callee, const std::vector<ExprId>& args);
  Note infer_call(const Expr& expr);
  // enable.cc
  std::vector<const Arg*> plain_arguments(const Expr& call, const PouInfo* callee) const;
  // Is this the implicit EN or ENO of the callee (null: a standard function)?
  bool is_enable(const Arg& arg, const PouInfo* callee) const;
  void mark_enabled(const Expr& call, Note& note) const;
  ExprId conversion_argument(const Expr& call) const;  // invalid when there is not just one
  bool check_dimension(int64_t given, size_t dims, ir::TypeId array, ExprId number);
  std::optional<int64_t> bound_of(const Expr& expr, bool upper);
  // A type, or the type of a variable, as argument of SIZEOF.
  ir::TypeId type_of_argument(ExprId argument);

 private:
  Callee named_callee(const Expr& call, const Expr& head);
  Callee typed_callee(std::string_view name) const;  // typed_functions.cc
  // bounds.cc
  Note infer_bound(const Expr& expr, bool upper);
  Note infer_reference_call(const Expr& expr, ReferenceCall call);
};

}  // namespace frontend
