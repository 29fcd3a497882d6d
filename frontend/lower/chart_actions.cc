// Actions of charts: what steps ask of them, whether they run (IEC 61131-3, figures 22 to 24),
// and their statements.
#include "frontend/lower/chart.h"

namespace frontend {
namespace {

constexpr ir::Scalar kBool = ir::Scalar::kBool;
constexpr ir::Scalar kTime = ir::Scalar::kI64;

// A stored qualifier that counts time.
struct Timer {
  ActionQualifier qualifier;
  const char* stored;
  const char* elapsed;
  const char* limit;
};
constexpr Timer kDelayed = {ActionQualifier::kSD, "SD", "SD_ET", "SD_PT"};
constexpr Timer kLimited = {ActionQualifier::kSL, "SL", "SL_ET", "SL_PT"};

}  // namespace

// Statements of actions that no step uses are checked, in code that nothing reaches.
void Body::chart_unused(const ChartCode& code) {
  for (const sfc::Action& action : code.net.actions) {
    if (action.uses != 0) continue;
    ir::BlockId next = build_.new_block();
    build_.jump(next);
    build_.start(build_.new_block());
    chart_statements(*action.decl, next);
    build_.start(next);
  }
}

// RETURN leaves the action.
void Body::chart_statements(const ChartAction& action, ir::BlockId next) {
  ir::BlockId outer = exit_;
  exit_ = next;
  statements(action.body);
  exit_ = outer;
  if (build_.reachable()) build_.jump(next);
}

void Body::chart_uses(const ChartCode& code) {
  for (uint32_t step = 0; step < code.net.steps.size(); ++step) {
    const std::vector<sfc::Use>& uses = code.net.steps[step].uses;
    bool active = false;
    for (const sfc::Use& use : uses) {
      for (ExprId indicator : use.decl->indicators) sema_.infer(indicator);
      if (use.decl->qualifier != ActionQualifier::kP0) {
        active = true;
        continue;
      }
      set_line(use.decl->span);
      when(nth(code.left, step), [&] { set_flag(nth(code.pulsed, use.action)); });
    }
    if (!active) continue;
    set_line(code.net.steps[step].decl->name.span);
    when(chart_place(code.steps[step], "X"), [&] {
      for (const sfc::Use& use : uses) chart_use(code, step, use);
    });
  }
}

void Body::chart_use(const ChartCode& code, uint32_t step, const sfc::Use& use) {
  VarId record = code.actions[use.action];
  auto request = [&](const ir::Place& flag, ir::ValueId value) {
    ir::ValueId before = build_.load(flag, kBool);
    build_.store(flag, kBool, build_.binary(ir::Op::kOr, kBool, before, value));
  };
  auto still_shorter = [&] {
    ir::ValueId limit = chart_limit(*use.decl);
    ir::ValueId time = build_.load(chart_place(code.steps[step], "T"), kTime);
    return build_.compare(ir::Op::kLt, kTime, time, limit);
  };
  auto elapsed = [&] { return build_.unary(ir::Op::kNot, kBool, still_shorter()); };
  set_line(use.decl->span);
  switch (use.decl->qualifier) {
    case ActionQualifier::kN:
      return set_flag(nth(code.wanted, use.action));
    case ActionQualifier::kR:
      return set_flag(nth(code.reset, use.action));
    case ActionQualifier::kS:
      return set_flag(chart_place(record, "S"));
    case ActionQualifier::kL:
      return request(nth(code.wanted, use.action), still_shorter());
    case ActionQualifier::kD:
      return request(nth(code.wanted, use.action), elapsed());
    case ActionQualifier::kDS:
      return request(chart_place(record, "DS"), elapsed());
    case ActionQualifier::kP:
      return request(nth(code.wanted, use.action), build_.load(nth(code.entered, step), kBool));
    case ActionQualifier::kP1:
      return request(nth(code.pulsed, use.action), build_.load(nth(code.entered, step), kBool));
    case ActionQualifier::kP0:  // chart_uses()
      return;
    case ActionQualifier::kSD:
    case ActionQualifier::kSL:
      return chart_begin(record, use);
  }
}

ir::ValueId Body::chart_limit(const ActionUse& use) {
  ir::TypeId time = elementary(ir::Kind::kTime);
  return use.time.valid() ? value(use.time, time) : zero(time);
}

// The time is read while the step is active. What is stored already goes on counting.
void Body::chart_begin(VarId record, const sfc::Use& use) {
  const Timer& timer = use.decl->qualifier == ActionQualifier::kSD ? kDelayed : kLimited;
  ir::ValueId limit = chart_limit(*use.decl);
  build_.store(chart_place(record, timer.limit), kTime, limit);
  ir::Place stored = chart_place(record, timer.stored);
  when(build_.unary(ir::Op::kNot, kBool, build_.load(stored, kBool)), [&] {
    set_flag(stored);
    build_.store(chart_place(record, timer.elapsed), kTime, build_.constant(kTime, 0));
  });
}

void Body::chart_controls(const ChartCode& code) {
  for (uint32_t action = 0; action < code.actions.size(); ++action) {
    if (code.net.actions[action].uses != 0) chart_control(code, action);
  }
}

// Q and A of one action. R goes above everything.
void Body::chart_control(const ChartCode& code, uint32_t number) {
  const sfc::Action& action = code.net.actions[number];
  VarId record = code.actions[number];
  auto both = [&](ir::ValueId a, ir::ValueId b) {
    return build_.binary(ir::Op::kAnd, kBool, a, b);
  };
  auto either = [&](ir::ValueId a, ir::ValueId b) {
    return build_.binary(ir::Op::kOr, kBool, a, b);
  };
  set_line(action.decl != nullptr ? action.name.span : tree_[action.target].span);
  ir::ValueId keep;
  if (code.uses(number, ActionQualifier::kR)) {
    keep = build_.unary(ir::Op::kNot, kBool, build_.load(nth(code.reset, number), kBool));
  }
  auto stored = [&](const char* member) {
    ir::Place place = chart_place(record, member);
    ir::ValueId value = build_.load(place, kBool);
    if (!keep.valid()) return value;
    value = both(value, keep);
    build_.store(place, kBool, value);
    return value;
  };
  auto running = [&](const Timer& timer) {
    ir::ValueId elapsed = build_.load(chart_place(record, timer.elapsed), kTime);
    ir::ValueId limit = build_.load(chart_place(record, timer.limit), kTime);
    return build_.compare(ir::Op::kLt, kTime, elapsed, limit);
  };
  ir::ValueId wanted = build_.load(nth(code.wanted, number), kBool);
  if (code.uses(number, ActionQualifier::kS)) wanted = either(wanted, stored("S"));
  if (code.uses(number, ActionQualifier::kDS)) wanted = either(wanted, stored("DS"));
  if (code.uses(number, kDelayed.qualifier)) {
    ir::ValueId due = build_.unary(ir::Op::kNot, kBool, running(kDelayed));
    wanted = either(wanted, both(stored(kDelayed.stored), due));
  }
  if (code.uses(number, kLimited.qualifier)) {
    wanted = either(wanted, both(stored(kLimited.stored), running(kLimited)));
  }
  ir::ValueId pulsed = build_.load(nth(code.pulsed, number), kBool);
  if (keep.valid()) {
    wanted = both(wanted, keep);
    pulsed = both(pulsed, keep);
  }
  ir::ValueId q = either(wanted, pulsed);
  ir::Place due = chart_place(record, "FINAL_DUE");
  ir::ValueId final = both(build_.load(due, kBool), build_.unary(ir::Op::kNot, kBool, q));
  build_.store(due, kBool, wanted);
  build_.store(chart_place(record, "Q"), kBool, q);
  build_.store(chart_place(record, "A"), kBool, either(q, final));
  if (action.decl == nullptr) {
    auto variable = chart_variable(action);
    if (variable) store(*variable, q);
    return;
  }
  build_.store(code.final, kBool, either(build_.load(code.final, kBool), final));
}

// An action that is a BOOL variable.
std::optional<Target> Body::chart_variable(const sfc::Action& action) {
  const Expr& name = tree_[action.target];
  VarId id = sema_.find_variable(name);
  if (!id.valid()) {
    NearestName nearest(name.name.text);
    for (const auto& entry : info_.names) {
      if (entry.first.find('#') == std::string_view::npos) nearest.offer(entry.first);
    }
    sema_.error(DiagnosticCode::kUnknownAction, name.span,
                "`" + std::string(name.name.text) + "` is neither an ACTION nor a variable",
                nearest.fix());
    return std::nullopt;
  }
  const Note& note = sema_.infer(action.target);
  if (!note.type.valid()) return std::nullopt;
  if (!traits_of(types(), note.type).boolean) {
    sema_.error(DiagnosticCode::kUnknownAction, name.span,
                "`" + std::string(name.name.text) + "` is `" + sema_.type_text(note.type) +
                    "`; an action is an ACTION or a BOOL variable",
                "declare an ACTION that writes it");
    return std::nullopt;
  }
  return target(action.target);
}

// First the actions whose request has ended, then those that are requested: what a final
// scan writes cannot undo what an active action writes in the same scan.
void Body::chart_bodies(const ChartCode& code) {
  bool any = false;
  for (const sfc::Action& action : code.net.actions) {
    any = any || (action.decl != nullptr && action.uses != 0);
  }
  if (!any) return;
  ir::BlockId head = build_.new_block();
  ir::BlockId again = build_.new_block();
  ir::BlockId done = build_.new_block();
  ir::ValueId final = build_.add_param(head, kBool);
  build_.jump(head, {build_.load(code.final, kBool)});
  build_.start(head);
  for (uint32_t number = 0; number < code.net.actions.size(); ++number) {
    const sfc::Action& action = code.net.actions[number];
    if (action.decl == nullptr || action.uses == 0) continue;
    set_line(action.name.span);
    ir::BlockId run = build_.new_block();
    ir::BlockId next = build_.new_block();
    ir::ValueId q = build_.load(chart_place(code.actions[number], "Q"), kBool);
    ir::ValueId a = build_.load(chart_place(code.actions[number], "A"), kBool);
    ir::ValueId turn = build_.binary(ir::Op::kXor, kBool, q, final);
    build_.branch(build_.binary(ir::Op::kAnd, kBool, a, turn), run, next);
    build_.start(run);
    chart_statements(*action.decl, next);
    build_.start(next);
  }
  build_.branch(final, again, done);
  build_.start(again);
  build_.jump(head, {build_.constant(kBool, 0)});
  build_.start(done);
}

}  // namespace frontend
