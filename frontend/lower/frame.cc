// Variables of the frame, and temporaries that are members: they begin anew at each call.
#include "frontend/lower/frame.h"
#include "frontend/lower/assignments.h"
#include "frontend/lower/pool_code.h"
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
  for (VarId id : info_.call_instances) make_instance(id);
  if (!info_.shares_temporaries) return;
  for (VarId id : info_.variables) {
    const Variable& variable = resolve(id);
    bool temporary =
        variable.section == VarSection::kTemp && variable.type.valid() && !variable.each_call;
    if (temporary) initialise(member_variable_place(variable), variable);
  }
}

// FB_Exit does not run for it.
void Frame::make_instance(VarId id) {
  const Variable& variable = resolve(id);
  if (!variable.type.valid()) return;
  set_line(variable.name.span);
  ask<PoolCode>().reset(variable_place(id), variable.type, variable.init);
  ask<StartCode>().begin(id);
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
