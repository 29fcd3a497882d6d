// Actions of charts: what steps ask of them, whether they run (action control of IEC 61131-3),
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
      when(is_raised(code, code.left[step]), [&] { raise(code, code.released[use.action]); });
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
      return raise(code, code.wanted[use.action]);
    case ActionQualifier::kR:
      return raise(code, code.reset[use.action]);
    case ActionQualifier::kS:
      return set_flag(chart_place(record, "S"));
    case ActionQualifier::kL:
      return request(chart_flag(code, code.wanted[use.action]), still_shorter());
    case ActionQualifier::kD:
      return request(chart_flag(code, code.wanted[use.action]), elapsed());
    case ActionQualifier::kDS:
      return request(chart_place(record, "DS"), elapsed());
    case ActionQualifier::kP:
      return request(chart_flag(code, code.wanted[use.action]),
                     is_raised(code, code.entered[step]));
    case ActionQualifier::kP1:
      return request(chart_flag(code, code.pulsed[use.action]),
                     is_raised(code, code.entered[step]));
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

// What steps ask of an action and what they stored, without pulses. `keep`: no R; may be invalid.
ir::ValueId Body::chart_wanted(const ChartCode& code, uint32_t action, ir::ValueId keep) {
  VarId record = code.actions[action];
  ir::ValueId wanted = is_raised(code, code.wanted[action]);
  auto add = [&](ir::ValueId value) { wanted = build_.binary(ir::Op::kOr, kBool, wanted, value); };
  auto stored = [&](const char* member) {
    ir::Place place = chart_place(record, member);
    ir::ValueId value = build_.load(place, kBool);
    if (!keep.valid()) return value;
    value = build_.binary(ir::Op::kAnd, kBool, value, keep);
    build_.store(place, kBool, value);
    return value;
  };
  auto running = [&](const Timer& timer) {
    ir::ValueId elapsed = build_.load(chart_place(record, timer.elapsed), kTime);
    ir::ValueId limit = build_.load(chart_place(record, timer.limit), kTime);
    return build_.compare(ir::Op::kLt, kTime, elapsed, limit);
  };
  if (code.uses(action, ActionQualifier::kS)) add(stored("S"));
  if (code.uses(action, ActionQualifier::kDS)) add(stored("DS"));
  if (code.uses(action, kDelayed.qualifier)) {
    ir::ValueId due = build_.unary(ir::Op::kNot, kBool, running(kDelayed));
    add(build_.binary(ir::Op::kAnd, kBool, stored(kDelayed.stored), due));
  }
  if (code.uses(action, kLimited.qualifier)) {
    add(build_.binary(ir::Op::kAnd, kBool, stored(kLimited.stored), running(kLimited)));
  }
  return keep.valid() ? build_.binary(ir::Op::kAnd, kBool, wanted, keep) : wanted;
}

// Q and A of one action, and when its statements run: `late` by a request or P1, `early` for the
// final scan or by P0. R goes above everything. Statements see Q FALSE in P0 and P1, as the
// standard says; a BOOL variable is TRUE then.
void Body::chart_control(const ChartCode& code, uint32_t number) {
  const sfc::Action& action = code.net.actions[number];
  VarId record = code.actions[number];
  auto both = [&](ir::ValueId a, ir::ValueId b) {
    return build_.binary(ir::Op::kAnd, kBool, a, b);
  };
  auto either = [&](ir::ValueId a, ir::ValueId b) {
    return build_.binary(ir::Op::kOr, kBool, a, b);
  };
  auto no = [&](ir::ValueId value) { return build_.unary(ir::Op::kNot, kBool, value); };
  set_line(action.decl != nullptr ? action.name.span : tree_[action.target].span);
  ir::ValueId keep;
  if (code.reset[number] != sfc::kNone) keep = no(is_raised(code, code.reset[number]));
  auto pulse = [&](uint32_t flag) {
    ir::ValueId value = is_raised(code, flag);
    return keep.valid() ? both(value, keep) : value;
  };
  ir::ValueId q = chart_wanted(code, number, keep);
  ir::ValueId late = q;
  if (code.pulsed[number] != sfc::kNone) late = either(q, pulse(code.pulsed[number]));
  ir::Place due = chart_place(record, "FINAL_DUE");
  ir::ValueId early = both(build_.load(due, kBool), no(q));
  build_.store(due, kBool, q);
  if (code.released[number] != sfc::kNone) {
    ir::ValueId released = pulse(code.released[number]);
    early = either(early, released);
    if (action.decl == nullptr) late = either(late, released);
  }
  build_.store(chart_place(record, "A"), kBool, either(late, early));
  build_.store(chart_place(record, "Q"), kBool, action.decl != nullptr ? q : late);
  if (action.decl == nullptr) {
    auto variable = chart_variable(action);
    if (variable) store(*variable, late);
    return;
  }
  build_.store(chart_flag(code, code.late[number]), kBool, late);
  ir::Place any = chart_flag(code, code.early);
  build_.store(any, kBool, either(build_.load(any, kBool), both(early, no(late))));
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

// First final scans and what steps do when they are left, then what is requested: the end of one
// step cannot undo what the next one does in the same scan.
void Body::chart_bodies(const ChartCode& code) {
  bool any = false;
  for (const sfc::Action& action : code.net.actions) {
    any = any || (action.decl != nullptr && action.uses != 0);
  }
  if (!any) return;
  ir::BlockId head = build_.new_block();
  ir::BlockId again = build_.new_block();
  ir::BlockId done = build_.new_block();
  ir::ValueId early = build_.add_param(head, kBool);
  build_.jump(head, {is_raised(code, code.early)});
  build_.start(head);
  for (uint32_t number = 0; number < code.net.actions.size(); ++number) {
    const sfc::Action& action = code.net.actions[number];
    if (action.decl == nullptr || action.uses == 0) continue;
    set_line(action.name.span);
    ir::BlockId run = build_.new_block();
    ir::BlockId next = build_.new_block();
    ir::ValueId late = is_raised(code, code.late[number]);
    ir::ValueId a = build_.load(chart_place(code.actions[number], "A"), kBool);
    ir::ValueId turn = build_.binary(ir::Op::kXor, kBool, late, early);
    build_.branch(build_.binary(ir::Op::kAnd, kBool, a, turn), run, next);
    build_.start(run);
    chart_statements(*action.decl, next);
    build_.start(next);
  }
  build_.branch(early, again, done);
  build_.start(again);
  build_.jump(head, {build_.constant(kBool, 0)});
  build_.start(done);
}

}  // namespace frontend
