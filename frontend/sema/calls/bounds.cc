// LOWER_BOUND and UPPER_BOUND: known when compiling, since each call of a function with
// ARRAY[*] has its own instance.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/sema.h"

namespace frontend {

Note Calls::infer_bound(const Expr& expr, bool upper) {
  if (!bound_of(expr, upper)) return {};
  Note note;
  note.type = sema_.program.types.elementary(ir::Kind::kDint);
  note.constant = true;
  return note;
}

std::optional<int64_t> Calls::bound_of(const Expr& expr, bool upper) {
  const char* name = upper ? "UPPER_BOUND" : "LOWER_BOUND";
  bool complete = expr.list.count == 2 && sema_.tree.args[expr.list.first].value.valid() &&
                  sema_.tree.args[expr.list.first + 1].value.valid();
  if (!complete) {
    error(DiagnosticCode::kWrongArgumentCount, expr.span,
          std::string(name) + " takes an array and the number of a dimension");
    return std::nullopt;
  }
  ExprId array = sema_.tree.args[expr.list.first].value;
  ir::TypeId type = infer(array).type;
  if (!type.valid()) return std::nullopt;
  if (sema_.program.types[type].kind != ir::Kind::kArray) {
    error(DiagnosticCode::kNotArray, sema_.tree[array].span,
          "`" + sema_.report.type_text(type) + "` is not an array");
    return std::nullopt;
  }
  ExprId number = sema_.tree.args[expr.list.first + 1].value;
  auto dimension = ask<Constants>().fold_integer(number);
  if (!dimension) return std::nullopt;
  const std::vector<ir::Dimension>& dims = sema_.program.types[type].dims;
  if (*dimension < 1 || *dimension > static_cast<int64_t>(dims.size())) {
    error(DiagnosticCode::kIndexOutOfBounds, sema_.tree[number].span,
          "`" + sema_.report.type_text(type) + "` has " + std::to_string(dims.size()) +
              " dimensions");
    return std::nullopt;
  }
  const ir::Dimension& found = dims[static_cast<size_t>(*dimension) - 1];
  return upper ? found.high : found.low;
}

}  // namespace frontend
