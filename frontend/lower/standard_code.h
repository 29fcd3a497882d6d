// Phase: calls of standard functions (standard.cc, standard_bits.cc, standard_string.cc,
// standard_time.cc), typed by the rules of stdlib/registry.h. It reads facts and types, and writes
// instructions and calls of natives.
#pragma once

#include <vector>

#include "frontend/lower/body_phase.h"
#include "stdlib/registry.h"

namespace frontend {

class StandardCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  ir::ValueId emit_standard(const Expr& expr, const Callee& callee, ir::TypeId own);
  ir::Place string_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                            ir::TypeId type);
  ir::Place extreme_string(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                           ir::TypeId type);
  ir::Place choose(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                   ir::TypeId type);
  void split(const Expr& call, const stdlib::FunctionRow& row);

 private:
  ir::ValueId real_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                            ir::TypeId own);
  ir::ValueId fold_operator(const std::vector<ExprId>& args, BinaryOp op, ir::TypeId own);
  ir::ValueId shift(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                    ir::TypeId own);
  ir::ValueId extreme(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                      ir::TypeId own);
  ir::ValueId multiplex(const std::vector<ExprId>& args, ir::TypeId own);
  ir::ValueId compare_chain(const std::vector<ExprId>& args, BinaryOp op, ir::TypeId common);
  ir::ValueId string_number(const std::vector<ExprId>& args, const stdlib::FunctionRow& row);
  ir::Place concat(const std::vector<ExprId>& args, ir::TypeId type, bool wide);
  ir::ValueId time_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row);
  ir::ValueId moment(const std::vector<ExprId>& args, const stdlib::FunctionRow& row);
  ir::ValueId day_of_week(ExprId moment);
  ir::ValueId byte_order(ExprId argument, const stdlib::FunctionRow& row, ir::TypeId own);
  ir::ValueId is_valid(ExprId argument, const stdlib::FunctionRow& row);
};

}  // namespace frontend
