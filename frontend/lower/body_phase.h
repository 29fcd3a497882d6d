// What the phases of lowering have in common: the body that they write to, the scope that they look
// from, and the words in which they ask for values and places. A phase has no state of its own
// beyond one piece of code: who needs one makes it, `ask<References>().handle_of(expr)`, and it
// looks from the same scope. So expressions, calls and statements ask each other in circles.
//
// Order of evaluation is source order: a target's indices, then the value; operands and arguments
// from left to right (docs/LANGUAGE.md). After an error phases go on with harmless values, so that
// one run reports all errors; the result is then thrown away.
#pragma once

#include <optional>
#include <type_traits>

#include "frontend/lower/lowering.h"
#include "frontend/lower/target.h"
#include "frontend/sema/phase.h"

namespace frontend {

inline ir::Step step_to(ir::StepKind kind, uint32_t index = 0) {
  ir::Step step;
  step.kind = kind;
  step.index = index;
  return step;
}

class BodyPhase : public Phase {
 public:
  BodyPhase(Lowering& body, const PouScope& scope)
      : Phase(body.sema, scope),
        body_(body),
        info_(body.info),
        build_(body.build),
        code_(body.code),
        tree_(body.sema.tree) {}

  // Another phase, of this body or of sema, for the same scope.
  template <class Other>
  Other ask() const {
    if constexpr (std::is_base_of_v<BodyPhase, Other>) {
      return Other(body_, scope_);
    } else {
      return Phase::ask<Other>();
    }
  }

 protected:
  // --- values (values.h, conversions.h)
  // The scalar value of `expr` as `target`, converted and checked.
  ir::ValueId value(ExprId expr, ir::TypeId target) const;
  Typed natural(ExprId expr) const;  // in its own type; literals take their default type
  ir::ValueId convert(Typed from, ir::TypeId to, base::SourceSpan span) const;

  // --- places (places.h, targets.h)
  ir::Place place(ExprId expr) const;
  ir::Place variable_place(VarId id) const;
  // Evaluates the indices of an assignment's left side; reports what cannot be written.
  std::optional<Target> target(ExprId expr) const;
  // `value` has the target's type.
  void store(const Target& target, ir::ValueId value) const;
  // Places that no expression names (body_phase.cc).
  ir::Place member_variable_place(const Variable& variable) const;
  ir::Place global_place(uint32_t member) const;
  ir::Place local_place(uint32_t local) const;
  ir::Place temporary_place(ir::TypeId type) const;

  // The line of what is written from here on.
  void set_line(base::SourceSpan span) const;

  const ir::TypeTable& types() const { return sema_.program.types; }
  ir::Scalar scalar(ir::TypeId type) const { return types().scalar(type); }
  ir::TypeId elementary(ir::Kind kind) const { return types().elementary(kind); }
  bool wide(ir::TypeId type) const { return types()[type].kind == ir::Kind::kWstring; }
  bool is_known(const Note& note) const {
    return note.constant || (body_.evaluating && note.known != Known::kNo);
  }

  Lowering& body_;
  PouInfo& info_;
  Builder& build_;
  ValueCode& code_;
  const Tree& tree_;

 private:
  bool is_outside(base::SourcePos pos) const;
};

}  // namespace frontend
