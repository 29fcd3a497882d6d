#include "frontend/lower/body_phase.h"
#include "frontend/lower/conversions.h"
#include "frontend/lower/places.h"
#include "frontend/lower/targets.h"
#include "frontend/lower/values.h"

namespace frontend {

ir::ValueId BodyPhase::value(ExprId expr, ir::TypeId target) const {
  return ask<Values>().value(expr, target);
}

Typed BodyPhase::natural(ExprId expr) const { return ask<Values>().natural(expr); }

ir::ValueId BodyPhase::convert(Typed from, ir::TypeId to, base::SourceSpan span) const {
  return ask<Conversions>().convert(from, to, span);
}

ir::Place BodyPhase::place(ExprId expr) const { return ask<Places>().place(expr); }

ir::Place BodyPhase::variable_place(VarId id) const { return ask<Places>().variable_place(id); }

std::optional<Target> BodyPhase::target(ExprId expr) const { return ask<Targets>().target(expr); }

void BodyPhase::store(const Target& target, ir::ValueId value) const {
  ask<Targets>().store(target, value);
}

ir::Place BodyPhase::member_variable_place(const Variable& variable) const {
  ir::Place place;
  place.base = ir::PlaceBase::kSelf;
  place.base_type = info_.self;
  place.steps.push_back(step_to(ir::StepKind::kMember, variable.index));
  place.type = variable.type;
  return place;
}

ir::Place BodyPhase::global_place(uint32_t member) const {
  ir::Place place;
  place.base = ir::PlaceBase::kGlobal;
  place.base_type = sema_.program.globals;
  place.steps.push_back(step_to(ir::StepKind::kMember, member));
  place.type = types()[sema_.program.globals].members[member].type;
  return place;
}

ir::Place BodyPhase::local_place(uint32_t local) const {
  ir::Place place;
  place.base = ir::PlaceBase::kLocal;
  place.base_index = local;
  place.base_type = place.type = body_.out.locals[local].type;
  return place;
}

ir::Place BodyPhase::temporary_place(ir::TypeId type) const {
  return local_place(build_.temporary(type));
}

// Is it outside of the POU's own text? The statements may be of a later one.
bool BodyPhase::is_outside(base::SourcePos pos) const {
  const PouDecl& decl = *info_.decl;
  const auto in = [pos](base::SourceSpan span) { return !(pos < span.begin) && pos <= span.end; };
  return !in(decl.span) && !(decl.code.begin.valid() && in(decl.code));
}

void BodyPhase::set_line(base::SourceSpan span) const {
  if (!span.begin.valid()) return;
  // The code of a constant, which is of no POU, is run here and now and then forgotten.
  const bool kept = sema_.log != nullptr && !body_.evaluating;
  if (kept && is_outside(span.begin)) sema_.log->other_lines = true;
  build_.set_line(body_.lines.line_of(span.begin));
}

}  // namespace frontend
