// FOR (docs/LANGUAGE.md): bounds and step are evaluated once; the loop ends
// correctly at the limits of its variable's type; step 0 traps; afterwards the
// variable is last + step, except at the type's limit, where it stays.
#include "frontend/lower/for_code.h"
#include "frontend/lower/statements.h"
#include "frontend/sema/constants/constants.h"

namespace frontend {

struct ForCode::ForLoop {
  ir::Place variable;
  ir::TypeId type;  // without subrange
  ir::Scalar machine = ir::Scalar::kI16;
  Limits limits;
  ir::ValueId to;
  ir::Scalar bound = ir::Scalar::kI16;  // what `to` is compared in: the variable's, or DINT
  std::optional<Wide> constant_to;
  std::optional<Wide> constant_step;
  ir::ValueId step;  // otherwise; as wide as the variable, signed unless both have no sign
  ir::ValueId upwards;
};

namespace {

ir::Kind signed_kind(ir::Scalar machine) {
  switch (ir::scalar_size(machine)) {
    case 1:
      return ir::Kind::kSint;
    case 2:
      return ir::Kind::kInt;
    case 4:
      return ir::Kind::kDint;
    default:
      return ir::Kind::kLint;
  }
}

bool is_unsigned(const ir::TypeTable& types, ir::TypeId type) {
  const Traits traits = traits_of(types, type);
  return (traits.integer || traits.bits) && !ir::is_signed(types.scalar(type));
}

}  // namespace

void ForCode::for_statement(const Stmt& stmt) {
  ForLoop loop;
  if (!for_head(stmt, loop)) {
    ask<Statements>().write(stmt.body);
    return;
  }
  VarId variable = infer(stmt.target).variable;
  ir::BlockId head = build_.new_block();
  ir::BlockId body = build_.new_block();
  ir::BlockId next = build_.new_block();
  ir::BlockId exit = build_.new_block();
  const bool may_be_left_out = !infer(stmt.from).constant || !loop.constant_to;
  if (body_.counting.on() && may_be_left_out) {
    const ir::BlockId sides[] = {build_.new_block(), build_.new_block()};
    for_test(loop, sides[0], sides[1]);
    build_.start(sides[0]);
    body_.counting.count(SiteKind::kBranch, stmt.span.begin, "FOR: some rounds", 0);
    build_.jump(head);
    build_.start(sides[1]);
    body_.counting.count(SiteKind::kBranch, stmt.span.begin, "FOR: no round", 1);
  }
  build_.jump(head);
  build_.start(head);
  for_test(loop, body, exit);
  build_.start(body);
  if (variable.valid()) body_.flow.for_variables.push_back(variable);
  ask<Statements>().loop_body(stmt.body, next, exit);
  if (variable.valid()) body_.flow.for_variables.pop_back();
  build_.start(next);
  set_line(stmt.span);
  for_advance(loop, head, exit);
  build_.start(exit);
}

bool ForCode::for_head(const Stmt& stmt, ForLoop& loop) {
  auto to = target(stmt.target);
  if (!to) return false;
  Traits traits = traits_of(types(), to->type);
  const bool iec = sema_.options.dialect == Dialect::kIec;
  const bool enumeration = traits.enumeration && !iec;  // it counts through the numbers
  const bool counts = traits.integer || enumeration || (traits.bits && !iec);
  if (to->bit_size != 0 || to->character.valid() || !counts) {
    error(DiagnosticCode::kBadLoopVariable, tree_[stmt.target].span,
          "a FOR variable of `" + sema_.report.type_text(to->type) + "`",
          "use an integer variable");
    return false;
  }
  loop.variable = to->place;
  loop.type = enumeration ? types()[to->type].base : without_range(types(), to->type);
  loop.machine = scalar(loop.type);
  loop.limits = limits_of(loop.machine);
  const ir::Type& declared = types()[to->type];
  if (declared.kind == ir::Kind::kSubrange) loop.limits = {declared.low, declared.high};
  ir::ValueId from = value(stmt.from, to->type);
  const bool wide = ir::scalar_size(loop.machine) < 4 && infer(stmt.to).width == Width::kWide;
  const ir::TypeId own = enumeration ? to->type : loop.type;
  const ir::TypeId bound = wide ? elementary(ir::Kind::kDint) : own;
  loop.to = value(stmt.to, bound);
  loop.bound = scalar(bound);
  if (infer(stmt.to).type.valid() && infer(stmt.to).constant) {
    if (auto known = ask<Constants>().fold(stmt.to, bound)) loop.constant_to = known->integer;
  }
  for_step(stmt, loop);
  set_line(stmt.span);
  build_.store(loop.variable, loop.machine, from);
  return true;
}

void ForCode::for_step(const Stmt& stmt, ForLoop& loop) {
  loop.constant_step = 1;
  if (!stmt.by.valid()) return;
  const Note& note = infer(stmt.by);
  if (!note.type.valid()) return;
  if (note.constant) {
    auto step = ask<Constants>().fold_integer(stmt.by);
    if (!step) return;
    if (*step == 0) {
      error(DiagnosticCode::kZeroStep, tree_[stmt.by].span, "BY 0 would never end");
      return;
    }
    loop.constant_step = *step;
    return;
  }
  loop.constant_step.reset();
  // A step without a sign counts upwards, where the variable has none either: UINT BY UINT.
  const bool unsigned_step = !ir::is_signed(loop.machine) && note.width != Width::kWide &&
                             is_unsigned(types(), note.type);
  const ir::TypeId type = unsigned_step ? loop.type : elementary(signed_kind(loop.machine));
  ir::Scalar machine = scalar(type);
  loop.step = build_.check_step(machine, value(stmt.by, type));
  ir::ValueId none = build_.constant(machine, 0);
  loop.upwards = build_.compare(ir::Op::kLt, machine, none, loop.step);
}

void ForCode::for_test(const ForLoop& loop, ir::BlockId body, ir::BlockId exit) {
  const ir::ValueId variable = build_.load(loop.variable, loop.machine);
  const ir::ValueId now = code_.machine_convert(variable, loop.machine, loop.bound);
  auto not_above = [&] { return build_.compare(ir::Op::kLe, loop.bound, now, loop.to); };
  auto not_below = [&] { return build_.compare(ir::Op::kLe, loop.bound, loop.to, now); };
  if (loop.constant_step) {
    build_.branch(*loop.constant_step > 0 ? not_above() : not_below(), body, exit);
    return;
  }
  ir::ValueId up = not_above();
  ir::ValueId down = not_below();
  build_.branch(build_.select(ir::Scalar::kBool, loop.upwards, down, up), body, exit);
}

void ForCode::for_advance(const ForLoop& loop, ir::BlockId head, ir::BlockId exit) {
  if (loop.constant_step) {
    for_advance_constant(loop, head, exit);
  } else {
    for_advance_variable(loop, head, exit);
  }
}

// The test against the type's limit falls away where the end keeps away from it.
void ForCode::for_advance_constant(const ForLoop& loop, ir::BlockId head, ir::BlockId exit) {
  Wide step = *loop.constant_step;
  bool up = step > 0;
  Wide last = up ? loop.limits.high - step : loop.limits.low - step;  // from there one more fits
  bool safe = loop.constant_to && (up ? *loop.constant_to <= last : *loop.constant_to >= last);
  ir::ValueId now = build_.load(loop.variable, loop.machine);
  if (!safe) {
    bool never = up ? last < loop.limits.low : last > loop.limits.high;
    if (never) {
      build_.jump(exit);
      return;
    }
    ir::ValueId edge = build_.constant(loop.machine, static_cast<uint64_t>(last));
    ir::ValueId fits = up ? build_.compare(ir::Op::kLe, loop.machine, now, edge)
                          : build_.compare(ir::Op::kLe, loop.machine, edge, now);
    ir::BlockId advance = build_.new_block();
    build_.branch(fits, advance, exit);
    build_.start(advance);
  }
  uint64_t bits = static_cast<uint64_t>(up ? step : -step);
  ir::ValueId amount = build_.constant(loop.machine, bits);
  ir::ValueId next = build_.binary(up ? ir::Op::kAdd : ir::Op::kSub, loop.machine, now, amount);
  build_.store(loop.variable, loop.machine, next);
  build_.jump(head);
}

void ForCode::for_advance_variable(const ForLoop& loop, ir::BlockId head, ir::BlockId exit) {
  ir::ValueId now = build_.load(loop.variable, loop.machine);
  ir::ValueId step = loop.step;
  if (!ir::is_signed(loop.machine)) step = build_.unary(ir::Op::kWrap, loop.machine, step);
  ir::ValueId next = build_.binary(ir::Op::kAdd, loop.machine, now, step);
  ir::ValueId wrapped_up = build_.compare(ir::Op::kLt, loop.machine, next, now);
  ir::ValueId wrapped_down = build_.compare(ir::Op::kLt, loop.machine, now, next);
  ir::ValueId stop = build_.select(ir::Scalar::kBool, loop.upwards, wrapped_down, wrapped_up);
  auto bound = [&](Wide limit) {
    return build_.constant(loop.machine, static_cast<uint64_t>(limit));
  };
  Limits whole = limits_of(loop.machine);
  if (loop.limits.low != whole.low) {
    ir::ValueId below = build_.compare(ir::Op::kLt, loop.machine, next, bound(loop.limits.low));
    stop = build_.binary(ir::Op::kOr, ir::Scalar::kBool, stop, below);
  }
  if (loop.limits.high != whole.high) {
    ir::ValueId above = build_.compare(ir::Op::kLt, loop.machine, bound(loop.limits.high), next);
    stop = build_.binary(ir::Op::kOr, ir::Scalar::kBool, stop, above);
  }
  ir::BlockId advance = build_.new_block();
  build_.branch(stop, exit, advance);
  build_.start(advance);
  build_.store(loop.variable, loop.machine, next);
  build_.jump(head);
}

}  // namespace frontend
