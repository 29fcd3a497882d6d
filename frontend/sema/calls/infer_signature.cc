// Standard functions whose operands have the types that their signature names.
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/sema.h"

namespace frontend {

Note StandardCalls::infer_by_signature(const stdlib::FunctionRow& row,
                                       const std::vector<ExprId>& args) {
  for (uint32_t i = 0; i < args.size(); ++i) {
    const Note& note = infer(args[i]);
    if (takes(stdlib::operand_type(row, i), note)) continue;
    error(DiagnosticCode::kWrongArgument, sema_.tree[args[i]].span,
          "argument " + std::to_string(i + 1) + " of " + std::string(row.name) + " is `" +
              sema_.report.type_text(note.type) + "`",
          "it takes " + std::string(row.signature));
    return {};
  }
  Note result;
  result.type = sema_.program.types.elementary(*kind_of_name(stdlib::result_type(row)));
  result.can_trap = row.rule != stdlib::FunctionRule::kTimeSum &&
                    row.rule != stdlib::FunctionRule::kTimeDifference;
  return result;
}

bool StandardCalls::takes(std::string_view wanted, const Note& argument) const {
  Traits traits = traits_of(sema_.program.types, argument.type);
  bool strict = sema_.options.dialect == Dialect::kIec && argument.flex == Flex::kNone;
  if (wanted == "ANY_NUM") return traits.number() || (traits.bits && !strict);
  if (wanted == "ANY_INT") return traits.integer || (traits.bits && !strict);
  ir::TypeId type = sema_.program.types.elementary(*kind_of_name(wanted));
  return implicit_fit(sema_.program.types, argument.type, type, sema_.options.dialect) !=
         Fit::kNone;
}

}  // namespace frontend
