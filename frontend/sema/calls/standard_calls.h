// Phase: calls of standard functions and conversions: their arguments and types by the rules of
// stdlib/registry.h (infer_standard.cc, infer_signature.cc, infer_conversion.cc,
// standard_arguments.cc). Reads expressions; writes messages only.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class StandardCalls : public Phase {
 public:
  using Phase::Phase;

  Note infer_standard(const Expr& expr, const Callee& callee);
  // In the order of the parameters; none when reported. Outputs not connected are invalid.
  std::vector<ExprId> standard_arguments(const Expr& call, const stdlib::FunctionRow& row);
  Note infer_conversion(const Expr& expr, const Conversion& conversion);
  std::optional<Conversion> conversion_to_enumeration(std::string_view name);
  // Does a conversion to a string give the names of this enumeration's literals?
  bool prints_names(ir::TypeId enumeration) const;

 private:
  Note infer_rule(const Expr& expr, const stdlib::FunctionRow& row,
                  const std::vector<ExprId>& args);
  bool standard_argument(const Arg& arg, const stdlib::FunctionRow& row, uint32_t number,
                         std::vector<ExprId>& ordered);
  ExprId cut_below(ExprId id);
  Note infer_by_signature(const stdlib::FunctionRow& row, const std::vector<ExprId>& args);
  bool takes(std::string_view wanted, const Note& argument) const;
  Note infer_string_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row);
  void check_cut_argument(ExprId argument, const Conversion& conversion, Note& made);
  bool check_conversion(const Expr& expr, const Conversion& conversion, ir::Kind from,
                        const Note& argument);
};

}  // namespace frontend
