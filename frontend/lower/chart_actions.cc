// Actions of charts: what steps ask of them, whether they run (action control of IEC 61131-3),
// and their statements.
#include "frontend/lower/chart.h"
#include "frontend/lower/statements.h"
#include "frontend/sema/declarations/variables.h"

namespace frontend {
namespace {

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
void ChartBody::unused_actions() {
  for (const sfc::Action& action : net_.actions) {
    if (action.uses != 0) continue;
    ir::BlockId next = build_.new_block();
    build_.jump(next);
    build_.start(build_.new_block());
    action_statements(*action.decl, next);
    build_.start(next);
  }
}

// RETURN leaves the action.
void ChartBody::action_statements(const ChartAction& action, ir::BlockId next) {
  ir::BlockId outer = body_.flow.exit;
  body_.flow.exit = next;
  ask<Statements>().write(action.body);
  body_.flow.exit = outer;
  if (build_.reachable()) build_.jump(next);
}

void ChartBody::step_uses() {
  for (uint32_t step = 0; step < net_.steps.size(); ++step) {
    const std::vector<sfc::Use>& uses = net_.steps[step].uses;
    bool active = false;  // asks something that only an active step may
    for (const sfc::Use& use : uses) {
      for (ExprId indicator : use.decl->indicators) {
        const VarId variable = infer(indicator).variable;
        if (variable.valid()) sema_.mark_written(variable);  // by what the action says
      }
      switch (use.decl->qualifier) {
        case ActionQualifier::kN:  // control()
        case ActionQualifier::kR:
        case ActionQualifier::kP1:
        case ActionQualifier::kP0:
          break;
        default:
          active = true;
      }
    }
    if (!active) continue;
    set_line(net_.steps[step].decl->name.span);
    when(part(steps_[step], "X"), [&] {
      for (const sfc::Use& use : uses) request(step, use);
    });
  }
}

ir::ValueId ChartBody::either(ir::ValueId a, ir::ValueId b) {
  if (!a.valid() || !b.valid()) return a.valid() ? a : b;
  return build_.binary(ir::Op::kOr, kFlag, a, b);
}

ir::ValueId ChartBody::any_user(uint32_t action, ActionQualifier qualifier,
                                const std::function<ir::ValueId(uint32_t)>& of) {
  ir::ValueId any;
  for (const User& user : users_[action]) {
    if (user.qualifier == qualifier) any = either(any, of(user.step));
  }
  return any;
}

void ChartBody::add_to(const ir::Place& flag, ir::ValueId value) {
  ir::ValueId before = build_.load(flag, kFlag);
  build_.store(flag, kFlag, build_.binary(ir::Op::kOr, kFlag, before, value));
}

void ChartBody::request(uint32_t step, const sfc::Use& use) {
  VarId record = actions_[use.action];
  auto still_shorter = [&] {
    ir::ValueId limit = limit_of(*use.decl);
    ir::ValueId time = build_.load(part(steps_[step], "T"), kElapsed);
    return build_.compare(ir::Op::kLt, kElapsed, time, limit);
  };
  auto elapsed = [&] { return build_.unary(ir::Op::kNot, kFlag, still_shorter()); };
  set_line(use.decl->span);
  switch (use.decl->qualifier) {
    case ActionQualifier::kS:
      return set_flag(part(record, "S"));
    case ActionQualifier::kL:
      return add_to(flag(wanted_[use.action]), still_shorter());
    case ActionQualifier::kD:
      return add_to(flag(wanted_[use.action]), elapsed());
    case ActionQualifier::kDS:
      return add_to(part(record, "DS"), elapsed());
    case ActionQualifier::kP:
      return add_to(flag(wanted_[use.action]), is_raised(entered_[step]));
    case ActionQualifier::kN:  // control()
    case ActionQualifier::kR:
    case ActionQualifier::kP1:
    case ActionQualifier::kP0:
      return;
    case ActionQualifier::kSD:
    case ActionQualifier::kSL:
      return begin(record, use);
  }
}

ir::ValueId ChartBody::limit_of(const ActionUse& use) {
  ir::TypeId time = elementary(ir::Kind::kTime);
  return use.time.valid() ? value(use.time, time) : code_.zero(time);
}

// The time is read while the step is active. What is stored already goes on counting.
void ChartBody::begin(VarId record, const sfc::Use& use) {
  const Timer& timer = use.decl->qualifier == ActionQualifier::kSD ? kDelayed : kLimited;
  ir::ValueId limit = limit_of(*use.decl);
  build_.store(part(record, timer.limit), kElapsed, limit);
  ir::Place stored = part(record, timer.stored);
  when(build_.unary(ir::Op::kNot, kFlag, build_.load(stored, kFlag)), [&] {
    set_flag(stored);
    build_.store(part(record, timer.elapsed), kElapsed, build_.constant(kElapsed, 0));
  });
}

void ChartBody::controls() {
  for (uint32_t action = 0; action < actions_.size(); ++action) {
    if (net_.actions[action].uses != 0) control(action);
  }
}

// What steps ask of an action and what they stored, without pulses. `keep`: no R; may be invalid.
ir::ValueId ChartBody::wants(uint32_t action, ir::ValueId keep) {
  VarId record = actions_[action];
  ir::ValueId wanted = any_user(action, ActionQualifier::kN, [&](uint32_t step) {
    return build_.load(part(steps_[step], "X"), kFlag);
  });
  auto add = [&](ir::ValueId value) { wanted = either(wanted, value); };
  if (wanted_[action] != sfc::kNone) add(is_raised(wanted_[action]));
  auto stored = [&](const char* member) {
    ir::Place place = part(record, member);
    ir::ValueId value = build_.load(place, kFlag);
    if (!keep.valid()) return value;
    value = build_.binary(ir::Op::kAnd, kFlag, value, keep);
    build_.store(place, kFlag, value);
    return value;
  };
  auto running = [&](const Timer& timer) {
    ir::ValueId elapsed = build_.load(part(record, timer.elapsed), kElapsed);
    ir::ValueId limit = build_.load(part(record, timer.limit), kElapsed);
    return build_.compare(ir::Op::kLt, kElapsed, elapsed, limit);
  };
  if (uses(action, ActionQualifier::kS)) add(stored("S"));
  if (uses(action, ActionQualifier::kDS)) add(stored("DS"));
  if (uses(action, kDelayed.qualifier)) {
    ir::ValueId due = build_.unary(ir::Op::kNot, kFlag, running(kDelayed));
    add(build_.binary(ir::Op::kAnd, kFlag, stored(kDelayed.stored), due));
  }
  if (uses(action, kLimited.qualifier)) {
    add(build_.binary(ir::Op::kAnd, kFlag, stored(kLimited.stored), running(kLimited)));
  }
  if (!wanted.valid()) return build_.constant(kFlag, 0);
  return keep.valid() ? build_.binary(ir::Op::kAnd, kFlag, wanted, keep) : wanted;
}

// Q and A of one action, and when its statements run: `late` by a request or P1, `early` for the
// final scan or by P0. R goes above everything. Statements see Q FALSE in P0 and P1, as the
// standard says; a BOOL variable is TRUE then.
void ChartBody::control(uint32_t number) {
  const sfc::Action& action = net_.actions[number];
  VarId record = actions_[number];
  auto both = [&](ir::ValueId a, ir::ValueId b) {
    return build_.binary(ir::Op::kAnd, kFlag, a, b);
  };
  auto no = [&](ir::ValueId value) { return build_.unary(ir::Op::kNot, kFlag, value); };
  set_line(action.decl != nullptr ? action.name.span : tree_[action.target].span);
  auto is_active = [&](uint32_t step) { return build_.load(part(steps_[step], "X"), kFlag); };
  ir::ValueId reset = any_user(number, ActionQualifier::kR, is_active);
  ir::ValueId keep = reset.valid() ? no(reset) : reset;
  auto pulse = [&](ActionQualifier qualifier, const Numbers& flags) {
    ir::ValueId value =
        any_user(number, qualifier, [&](uint32_t step) { return is_raised(flags[step]); });
    return value.valid() && keep.valid() ? both(value, keep) : value;
  };
  ir::ValueId q = wants(number, keep);
  ir::ValueId late =
      either(q, pulse(ActionQualifier::kP1, entered_));  // what was entered is active
  ir::ValueId early = build_.constant(kFlag, 0);
  const bool ends_at_once = is_of_step(action);
  ir::Place due = part(record, "FINAL_DUE");
  if (!ends_at_once) early = both(build_.load(due, kFlag), no(q));
  build_.store(due, kFlag, ends_at_once ? early : q);
  ir::ValueId released = pulse(ActionQualifier::kP0, left_);
  early = either(early, released);
  if (action.decl == nullptr) late = either(late, released);
  build_.store(part(record, "A"), kFlag, either(late, early));
  build_.store(part(record, "Q"), kFlag, action.decl != nullptr ? q : late);
  if (action.decl == nullptr) {
    auto variable = variable_of(action);
    if (variable) store(*variable, late);
    return;
  }
  late_[number] = late;
  ir::ValueId& any_early = early_[ends_at_once ? 0 : 1];
  any_early = either(any_early, both(early, no(late)));
}

// An action that is a BOOL variable.
std::optional<Target> ChartBody::variable_of(const sfc::Action& action) {
  const Expr& name = tree_[action.target];
  VarId id = ask<Variables>().find_variable(name);
  if (!id.valid()) {
    NearestName nearest(name.name.text);
    for (const auto& entry : info_.names) {
      if (entry.first.find('#') == std::string_view::npos) nearest.offer(entry.first);
    }
    error(DiagnosticCode::kUnknownAction, name.span,
          "`" + std::string(name.name.text) + "` is neither an ACTION nor a variable",
          nearest.fix());
    return std::nullopt;
  }
  const Note& note = infer(action.target);
  if (!note.type.valid()) return std::nullopt;
  if (!traits_of(types(), note.type).boolean) {
    error(DiagnosticCode::kUnknownAction, name.span,
          "`" + std::string(name.name.text) + "` is `" + sema_.report.type_text(note.type) +
              "`; an action is an ACTION or a BOOL variable",
          "declare an ACTION that writes it");
    return std::nullopt;
  }
  return target(action.target);
}

// One that a step has for itself.
bool ChartBody::is_of_step(const sfc::Action& action) const {
  return action.decl != nullptr &&
         tree_.find_attribute(action.decl->attributes, kNoFinalScan) != nullptr;
}

// First the actions that steps have for themselves, then all others.
void ChartBody::bodies() {
  bodies(true);
  bodies(false);
}

// First final scans and what steps do when they are left, then what is requested: the end of one
// step cannot undo what the next one does in the same scan.
void ChartBody::bodies(bool of_steps) {
  const ir::ValueId any_early = early_[of_steps ? 0 : 1];
  if (!any_early.valid()) return;
  ir::BlockId head = build_.new_block();
  ir::BlockId again = build_.new_block();
  ir::BlockId done = build_.new_block();
  ir::ValueId early = build_.add_param(head, kFlag);
  build_.jump(head, {any_early});
  build_.start(head);
  for (uint32_t number = 0; number < net_.actions.size(); ++number) {
    const sfc::Action& action = net_.actions[number];
    if (action.decl == nullptr || action.uses == 0 || is_of_step(action) != of_steps) continue;
    set_line(action.name.span);
    ir::BlockId run = build_.new_block();
    ir::BlockId next = build_.new_block();
    ir::ValueId a = build_.load(part(actions_[number], "A"), kFlag);
    ir::ValueId turn = build_.binary(ir::Op::kXor, kFlag, late_[number], early);
    build_.branch(build_.binary(ir::Op::kAnd, kFlag, a, turn), run, next);
    build_.start(run);
    action_statements(*action.decl, next);
    build_.start(next);
  }
  build_.branch(early, again, done);
  build_.start(again);
  build_.jump(head, {build_.constant(kFlag, 0)});
  build_.start(done);
}

}  // namespace frontend
