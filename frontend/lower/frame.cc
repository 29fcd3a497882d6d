// Variables of the frame, and temporaries that are members: they begin anew at each call.
#include "frontend/lower/frame.h"
#include "frontend/lower/assignments.h"
#include "frontend/lower/start_code.h"

namespace frontend {

// Everything that the caller does not write starts anew at each call.
void Frame::initialise_locals() {
  for (uint32_t i = 0; i < info_.locals.size(); ++i) {
    const Variable& variable = resolve(info_.locals[i]);
    bool written_by_caller =
        variable.section == VarSection::kInput || variable.section == VarSection::kInOut;
    if (!written_by_caller && variable.type.valid()) initialise(local_place(i), variable);
  }
  if (!info_.shares_temporaries) return;
  for (VarId id : info_.variables) {
    const Variable& variable = resolve(id);
    bool temporary = variable.section == VarSection::kTemp && variable.type.valid();
    if (temporary) initialise(member_variable_place(variable), variable);
  }
}

void Frame::initialise(const ir::Place& where, const Variable& variable) {
  set_line(variable.name.span);
  if (variable.runtime_init) {
    Target target;
    target.place = where;
    target.type = variable.type;
    if (types().is_scalar(variable.type)) {
      build_.store(where, scalar(variable.type), value(variable.decl->init, variable.type));
    } else {
      ask<Assignments>().assign_aggregate(target, variable.decl->init);
    }
    return;
  }
  if (!types().is_scalar(variable.type)) {
    build_.init(where, variable.init);
    ask<StartCode>().bind_references(where, variable.type, variable.init);
    return;
  }
  ir::ConstId init = variable.init.valid() ? variable.init : types()[variable.type].init;
  uint64_t bits = init.valid() ? sema_.program.constants[init].bits : 0;
  ir::Scalar machine = scalar(variable.type);
  build_.store(where, machine, build_.constant(machine, bits));
}

}  // namespace frontend
