// EN and ENO among the arguments of a call.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"

namespace frontend {

// Is it EN or ENO of a callee without parameters of these names; null: a standard function.
bool Calls::is_enable(const Arg& arg, const PouInfo* callee) const {
  bool named = ir::same_name(arg.name.text, "EN") || ir::same_name(arg.name.text, "ENO");
  return named &&
         (callee == nullptr || !ask<Objects>().find_parameter(*callee, arg.name.text).valid());
}

std::vector<const Arg*> Calls::plain_arguments(const Expr& call, const PouInfo* callee) const {
  std::vector<const Arg*> plain;
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = sema_.tree.args[call.list.first + i];
    if (!is_enable(arg, callee)) plain.push_back(&arg);
  }
  return plain;
}

ExprId Calls::conversion_argument(const Expr& call) const {
  std::vector<const Arg*> plain = plain_arguments(call, nullptr);
  return plain.size() == 1 ? plain[0]->value : ExprId();
}

// ENO is written, and EN may call: such a call is no pure value.
void Calls::mark_enabled(const Expr& call, Note& note) const {
  if (plain_arguments(call, nullptr).size() == call.list.count) return;
  note.calls = true;
  note.known = Known::kNo;
}

}  // namespace frontend
