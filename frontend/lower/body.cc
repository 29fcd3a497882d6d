#include "frontend/lower/body.h"

#include <algorithm>

#include "base/hash.h"
#include "frontend/lower/chart.h"
#include "frontend/lower/pool_code.h"

namespace frontend {

Body::Body(Sema& sema, uint32_t pou)
    : Body(sema, PouScope(sema.declared.pous[pou]), sema.declared.pous[pou], pou,
           sema.program.pous[sema.declared.pous[pou].id.index]) {}

Body::Body(Sema& sema, const PouScope& scope, PouInfo& info, uint32_t number, ir::Pou pou)
    : Phase(sema, scope),
      tree_(sema.tree),
      info_(info),
      pou_number_(number),
      out_(std::move(pou)),
      build_(out_) {}

void Body::run() {
  const PouDecl& decl = *info_.decl;
  base::SourceLocation head = sema_.sources.locate(decl.span.begin);
  out_.file = head.file;
  out_.line = head.line;
  lines_.begin(decl.span.begin, head.line);
  if (info_.made == MadeCode::kNone) out_.content = decl.content;
  build_.set_line(head.line);
  initialise_locals();
  connect_inputs();
  detect_edges();
  mock_prologue();
  const bool written = info_.made == MadeCode::kNone && !info_.test && !info_.library;
  if (written) counting_.begin(sema_.options.coverage, out_.name);
  if (info_.test && decl.kind == PouKind::kProgram) activate_mock_bodies();
  if (info_.setup != nullptr) statements(info_.setup->body);
  if (!info_.connections.empty()) exit_ = build_.new_block();
  if (info_.made == MadeCode::kStart) {
    StartCode(*this).run();
  } else if (info_.made == MadeCode::kReset) {
    PoolCode(*this).reset_method();
  } else if (info_.made == MadeCode::kLeave) {
    PoolCode(*this).leave_method();
  } else if (decl.chart != kNoChart) {
    ChartBody(*this, tree_.charts[decl.chart]).run();
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
  if (exit_.valid()) {
    if (build_.reachable()) build_.jump(exit_);
    build_.start(exit_);
    connect_outputs();
  }
  build_.finish();
  sema_.program.pous[info_.id.index] = std::move(out_);
}

void Body::leave() {
  leave_loops();
  go({}, 0);
}

// Is it outside of the POU's own text? The statements may be of a later one.
bool Body::is_outside(base::SourcePos pos) const {
  const PouDecl& decl = *info_.decl;
  const auto in = [pos](base::SourceSpan span) { return !(pos < span.begin) && pos <= span.end; };
  return !in(decl.span) && !(decl.code.begin.valid() && in(decl.code));
}

void Body::set_line(base::SourceSpan span) {
  if (!span.begin.valid()) return;
  if (sema_.log != nullptr && is_outside(span.begin)) sema_.log->other_lines = true;
  build_.set_line(lines_.line_of(span.begin));
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
    StartCode(*this).bind_references(where, variable.type, variable.init);
    return;
  }
  ir::ConstId init = variable.init.valid() ? variable.init : types()[variable.type].init;
  uint64_t bits = init.valid() ? sema_.program.constants[init].bits : 0;
  ir::Scalar machine = scalar(variable.type);
  build_.store(where, machine, build_.constant(machine, bits));
}

}  // namespace frontend
