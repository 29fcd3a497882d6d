// LOWER_BOUND and UPPER_BOUND: known when compiling, since each call of a function with
// ARRAY[*] has its own instance.
#include "frontend/sema/sema.h"

namespace frontend {

Note Sema::infer_bound(const Expr& expr, bool upper) {
  if (!bound_of(expr, upper)) return {};
  Note note;
  note.type = program.types.elementary(ir::Kind::kDint);
  note.constant = true;
  return note;
}

std::optional<int64_t> Sema::bound_of(const Expr& expr, bool upper) {
  const char* name = upper ? "UPPER_BOUND" : "LOWER_BOUND";
  bool complete = expr.list.count == 2 && tree.args[expr.list.first].value.valid() &&
                  tree.args[expr.list.first + 1].value.valid();
  if (!complete) {
    error(DiagnosticCode::kWrongArgumentCount, expr.span,
          std::string(name) + " takes an array and the number of a dimension");
    return std::nullopt;
  }
  ExprId array = tree.args[expr.list.first].value;
  ir::TypeId type = infer(array).type;
  if (!type.valid()) return std::nullopt;
  if (program.types[type].kind != ir::Kind::kArray) {
    error(DiagnosticCode::kNotArray, tree[array].span,
          "`" + report.type_text(type) + "` is not an array");
    return std::nullopt;
  }
  ExprId number = tree.args[expr.list.first + 1].value;
  auto dimension = fold_integer(number);
  if (!dimension) return std::nullopt;
  const std::vector<ir::Dimension>& dims = program.types[type].dims;
  if (*dimension < 1 || *dimension > static_cast<int64_t>(dims.size())) {
    error(DiagnosticCode::kIndexOutOfBounds, tree[number].span,
          "`" + report.type_text(type) + "` has " + std::to_string(dims.size()) + " dimensions");
    return std::nullopt;
  }
  const ir::Dimension& found = dims[static_cast<size_t>(*dimension) - 1];
  return upper ? found.high : found.low;
}

}  // namespace frontend
