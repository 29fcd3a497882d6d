// LOWER_BOUND and UPPER_BOUND: known when compiling, since each call of a function with
// ARRAY[*] has its own instance. The dimension may be a variable.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/sema.h"

namespace frontend {

// Which dimension is meant is known when the code runs.
static bool has_open_dimension(const Phase& phase, const Expr& expr) {
  const Sema& sema = phase.sema();
  if (expr.list.count != 2) return false;
  const ExprId array = sema.tree.args[expr.list.first].value;
  const ExprId number = sema.tree.args[expr.list.first + 1].value;
  if (!array.valid() || !number.valid()) return false;
  const ir::TypeId type = phase.infer(array).type;
  const Note& dimension = phase.infer(number);
  const Traits traits = traits_of(sema.program.types, dimension.type);
  if (sema.declared.open_array(type) != nullptr) return traits.integer || traits.bits;
  return type.valid() && sema.program.types[type].kind == ir::Kind::kArray &&
         dimension.known < Known::kByCall && (traits.integer || traits.bits);
}

Note Calls::infer_bound(const Expr& expr, bool upper) {
  if (has_open_dimension(*this, expr)) {
    const ExprId number = sema_.tree.args[expr.list.first + 1].value;
    const Note& dimension = infer(number);
    const ir::TypeId array = infer(sema_.tree.args[expr.list.first].value).type;
    if (const OpenArray* open = sema_.declared.open_array(array);
        open != nullptr && dimension.known >= Known::kByCall) {
      const auto which = ask<Constants>().fold_integer(number);
      if (!which || !check_dimension(*which, open->dims, array, number)) return {};
    }
    Note note;
    note.type = sema_.program.types.elementary(ir::Kind::kDint);
    note.calls = dimension.calls;
    note.can_trap = true;
    return note;
  }
  if (!bound_of(expr, upper)) return {};
  Note note;
  note.type = sema_.program.types.elementary(ir::Kind::kDint);
  note.constant = true;
  return note;
}

bool Calls::check_dimension(int64_t given, size_t dims, ir::TypeId array, ExprId number) {
  if (given >= 1 && given <= static_cast<int64_t>(dims)) return true;
  error(DiagnosticCode::kIndexOutOfBounds, sema_.tree[number].span,
        "`" + sema_.report.type_text(array) + "` has " + std::to_string(dims) + " dimensions");
  return false;
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
  if (!check_dimension(*dimension, dims.size(), type, number)) return std::nullopt;
  const ir::Dimension& found = dims[static_cast<size_t>(*dimension) - 1];
  return upper ? found.high : found.low;
}

}  // namespace frontend
