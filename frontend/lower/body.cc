#include <algorithm>

#include "base/hash.h"
#include "frontend/lower/body.h"
#include "frontend/lower/chart.h"
#include "frontend/lower/mock_code.h"
#include "frontend/lower/pool_code.h"
#include "frontend/lower/start_code.h"
#include "frontend/lower/value_code.h"

namespace frontend {

void Body::run() {
  const PouDecl& decl = *info_.decl;
  base::SourceLocation head = sema_.sources.locate(decl.span.begin);
  body_.out.file = head.file;
  body_.out.line = head.line;
  body_.lines.begin(decl.span.begin, head.line);
  if (info_.made == MadeCode::kNone) body_.out.content = decl.content;
  build_.set_line(head.line);
  initialise_locals();
  connect_inputs();
  detect_edges();
  ask<MockCode>().mock_prologue();
  const bool written = info_.made == MadeCode::kNone && !info_.test && !info_.library;
  if (written) body_.counting.begin(sema_.options.coverage, body_.out.name);
  if (info_.test && decl.kind == PouKind::kProgram) ask<MockCode>().activate_mock_bodies();
  if (info_.setup != nullptr) statements(info_.setup->body);
  if (!info_.connections.empty()) body_.flow.exit = build_.new_block();
  if (info_.made == MadeCode::kStart) {
    ask<StartCode>().run();
  } else if (info_.made == MadeCode::kReset) {
    ask<PoolCode>().reset_method();
  } else if (info_.made == MadeCode::kLeave) {
    ask<PoolCode>().leave_method();
  } else if (decl.chart != kNoChart) {
    ChartBody(body_, scope_, tree_.charts[decl.chart]).run();
  } else if (info_.teardown != nullptr) {
    try_finally([&] { statements(decl.body); }, info_.teardown->body, decl.span);
  } else {
    statements(decl.body);
  }
  // A prototype: no virtual call ends here.
  const bool prototype =
      info_.owner != kNoPou &&
      (decl.is_abstract || sema_.declared.pous[info_.owner].decl->kind == PouKind::kInterface);
  if (prototype && build_.reachable()) build_.trap(ir::TrapKind::kReference);
  set_line({decl.span.end, decl.span.end});
  if (body_.flow.exit.valid()) {
    if (build_.reachable()) build_.jump(body_.flow.exit);
    build_.start(body_.flow.exit);
    connect_outputs();
  }
  build_.finish();
  sema_.program.pous[info_.id.index] = std::move(body_.out);
}

void write_body(Sema& sema, uint32_t pou) {
  PouInfo& info = sema.declared.pous[pou];
  Lowering body(sema, info, pou, sema.program.pous[info.id.index]);
  Body(body, PouScope(info)).run();
}

void Body::leave() {
  leave_loops();
  go({}, 0);
}

ir::ValueId ValueCode::zero(ir::TypeId type) {
  bool usable = type.valid() && types().is_scalar(type);
  return build_.constant(usable ? scalar(type) : ir::Scalar::kI32, 0);
}

// Everything that the caller does not write starts anew at each call.
void Body::initialise_locals() {
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

void Body::initialise(const ir::Place& where, const Variable& variable) {
  set_line(variable.name.span);
  if (variable.runtime_init) {
    Target target;
    target.place = where;
    target.type = variable.type;
    if (types().is_scalar(variable.type)) {
      build_.store(where, scalar(variable.type), value(variable.decl->init, variable.type));
    } else {
      assign_aggregate(target, variable.decl->init);
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
