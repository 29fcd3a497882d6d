// Sequential function charts: step times, transitions, moves. Actions: chart_actions.cc.
#include "frontend/lower/chart.h"

#include <algorithm>

#include "frontend/sfc/declare.h"

namespace frontend {
namespace {

constexpr ir::Scalar kBool = ir::Scalar::kBool;
constexpr ir::Scalar kTime = ir::Scalar::kI64;

}  // namespace

void Body::chart_body(const Chart& chart) {
  ChartCode code(chart);
  set_line(chart.span);
  chart_unused(code);
  if (!chart_places(code)) return chart_errors(code);
  chart_clock(code);
  chart_times(code);
  for (uint32_t t = 0; t < code.net.transitions.size(); ++t) chart_transition(code, t);
  chart_moves(code);
  chart_starts(code);
  chart_uses(code);
  chart_controls(code);
  chart_bodies(code);
}

// A name that means something else, too, has been reported; what remains is only checked.
void Body::chart_errors(const ChartCode& code) {
  for (const ChartTransition& transition : code.chart.transitions) {
    if (transition.condition.valid()) condition(transition.condition);
  }
  for (const sfc::Action& action : code.net.actions) {
    if (action.decl == nullptr) chart_variable(action);
  }
  for (const ChartStep& step : code.chart.steps) {
    for (const ActionUse& use : step.uses) {
      chart_limit(use);
      for (ExprId indicator : use.indicators) sema_.infer(indicator);
    }
  }
  for (const ChartAction& action : code.chart.actions) statements(action.body);
}

bool Body::chart_places(ChartCode& code) {
  auto variable = [&](std::string_view name, const char* member) {
    auto found = info_.names.find(name);
    if (found == info_.names.end()) return VarId();
    const Variable& resolved = sema_.resolve(found->second);
    bool own = resolved.decl != nullptr && resolved.decl->implied && resolved.type.valid();
    own = own && (member == nullptr || sema_.find_member(resolved.type, member) >= 0);
    return own ? found->second : VarId();
  };
  bool good = true;
  for (const sfc::Step& step : code.net.steps) {
    code.steps.push_back(variable(step.decl->name.text, "X"));
    good = good && code.steps.back().valid();
  }
  code.qualifiers.resize(code.net.actions.size());
  for (const sfc::Action& action : code.net.actions) {
    std::string record = std::string(action.name.text) + sfc::kRecordSuffix;
    code.actions.push_back(variable(action.decl != nullptr ? action.name.text : record, "Q"));
    good = good && code.actions.back().valid();
  }
  code.clock = variable(sfc::kClock, nullptr);
  if (!good || !code.clock.valid()) return false;
  for (const sfc::Step& step : code.net.steps) {
    for (const sfc::Use& use : step.uses) {
      code.qualifiers[use.action] |=
          static_cast<uint16_t>(1u << static_cast<uint32_t>(use.decl->qualifier));
    }
  }
  code.number_flags();
  auto last = static_cast<int64_t>(code.flag_count) - 1;
  ir::TypeId type = sema_.program.types.array(elementary(ir::Kind::kBool), {{0, last}});
  code.flags = temporary_place(type);
  build_.init(code.flags, {});
  return true;
}

void Body::ChartCode::number_flags() {
  auto number = [&](Numbers& numbers, size_t count, auto&& needed) {
    for (uint32_t i = 0; i < count; ++i) numbers.push_back(needed(i) ? flag_count++ : sfc::kNone);
  };
  auto always = [](uint32_t) { return true; };
  auto step_uses = [&](ActionQualifier a, ActionQualifier b) {
    return [&, a, b](uint32_t step) {
      const std::vector<sfc::Use>& all = net.steps[step].uses;
      return std::any_of(all.begin(), all.end(), [&](const sfc::Use& use) {
        return use.decl->qualifier == a || use.decl->qualifier == b;
      });
    };
  };
  moved = flag_count++;
  early = flag_count++;
  number(active, net.initial.size(), always);
  number(fired, net.transitions.size(), always);
  number(spent, net.steps.size(), [&](uint32_t step) { return net.steps[step].out.size() > 1; });
  number(entered, net.steps.size(), step_uses(ActionQualifier::kP, ActionQualifier::kP1));
  number(left, net.steps.size(), step_uses(ActionQualifier::kP0, ActionQualifier::kP0));
  number(wanted, net.actions.size(), always);
  auto used_by = [&](ActionQualifier qualifier) {
    return [&, qualifier](uint32_t action) { return uses(action, qualifier); };
  };
  number(pulsed, net.actions.size(), used_by(ActionQualifier::kP1));
  number(released, net.actions.size(), used_by(ActionQualifier::kP0));
  number(reset, net.actions.size(), used_by(ActionQualifier::kR));
  number(late, net.actions.size(),
         [&](uint32_t action) { return net.actions[action].decl != nullptr; });
}

ir::Place Body::chart_flag(const ChartCode& code, uint32_t number) const {
  ir::Place place = code.flags;
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kIndex;
  step.constant_index = number;
  place.type = elementary(ir::Kind::kBool);
  return place;
}

ir::ValueId Body::is_raised(const ChartCode& code, uint32_t number) {
  return build_.load(chart_flag(code, number), ir::Scalar::kBool);
}

void Body::raise(const ChartCode& code, uint32_t number) {
  if (number != sfc::kNone) set_flag(chart_flag(code, number));
}

// A member of the variable of a step or action.
ir::Place Body::chart_place(VarId id, const char* member) {
  const Variable& variable = sema_.resolve(id);
  ir::Place place = member_variable_place(variable);
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kMember;
  step.index = static_cast<uint32_t>(sema_.find_member(variable.type, member));
  place.type = types()[variable.type].members[step.index].type;
  return place;
}

void Body::set_flag(const ir::Place& flag, bool value) {
  build_.store(flag, kBool, build_.constant(kBool, value ? 1 : 0));
}

void Body::when(ir::ValueId condition, const std::function<void()>& then) {
  ir::BlockId yes = build_.new_block();
  ir::BlockId done = build_.new_block();
  build_.branch(condition, yes, done);
  build_.start(yes);
  then();
  build_.jump(done);
  build_.start(done);
}

void Body::when(const ir::Place& flag, const std::function<void()>& then) {
  when(build_.load(flag, kBool), then);
}

// A clock that has begun anew, after a restart with retained steps, stands still once.
void Body::chart_clock(ChartCode& code) {
  ir::Place clock = member_variable_place(sema_.resolve(code.clock));
  clock.type = elementary(ir::Kind::kTime);
  ir::ValueId now = build_.task_time();
  ir::ValueId before = build_.load(clock, kTime);
  ir::ValueId passed = build_.binary(ir::Op::kSub, kTime, now, before);
  ir::ValueId backwards = build_.compare(ir::Op::kLt, kTime, now, before);
  code.elapsed = build_.select(kTime, backwards, passed, build_.constant(kTime, 0));
  build_.store(clock, kTime, now);
}

void Body::chart_pass_time(const ChartCode& code, VarId variable, const char* member) {
  ir::Place time = chart_place(variable, member);
  ir::ValueId before = build_.load(time, kTime);
  build_.store(time, kTime, build_.binary(ir::Op::kAdd, kTime, before, code.elapsed));
}

void Body::chart_times(const ChartCode& code) {
  for (uint32_t step = 0; step < code.steps.size(); ++step) {
    when(chart_place(code.steps[step], "X"), [&] {
      chart_pass_time(code, code.steps[step], "T");
      raise(code, code.active[code.net.steps[step].network]);
    });
  }
  for (uint32_t action = 0; action < code.actions.size(); ++action) {
    VarId record = code.actions[action];
    if (code.uses(action, ActionQualifier::kSD)) {
      when(chart_place(record, "SD"), [&] { chart_pass_time(code, record, "SD_ET"); });
    }
    if (code.uses(action, ActionQualifier::kSL)) {
      when(chart_place(record, "SL"), [&] { chart_pass_time(code, record, "SL_ET"); });
    }
  }
}

// Fires when its steps are active, none of them was left by a transition that goes first,
// and its condition holds. No step changes yet: all conditions see the same steps.
void Body::chart_transition(const ChartCode& code, uint32_t number) {
  const sfc::Transition& transition = code.net.transitions[number];
  ir::BlockId next = build_.new_block();
  auto go_on_if = [&](ir::ValueId condition, bool holds) {
    ir::BlockId on = build_.new_block();
    build_.branch(condition, holds ? on : next, holds ? next : on);
    build_.start(on);
  };
  set_line(transition.decl->span);
  for (uint32_t step : transition.from) {
    go_on_if(build_.load(chart_place(code.steps[step], "X"), kBool), true);
  }
  for (uint32_t step : transition.from) {
    if (code.spent[step] != sfc::kNone) go_on_if(is_raised(code, code.spent[step]), false);
  }
  if (transition.decl->condition.valid()) go_on_if(condition(transition.decl->condition), true);
  raise(code, code.fired[number]);
  raise(code, code.moved);
  for (uint32_t step : transition.from) {
    raise(code, code.spent[step]);
  }
  build_.jump(next);
  build_.start(next);
}

void Body::chart_moves(const ChartCode& code) {
  if (code.net.transitions.empty()) return;
  when(is_raised(code, code.moved), [&] {
    for (uint32_t t = 0; t < code.net.transitions.size(); ++t) {
      when(is_raised(code, code.fired[t]), [&] {
        for (uint32_t step : code.net.transitions[t].from) {
          set_flag(chart_place(code.steps[step], "X"), false);
          raise(code, code.left[step]);
        }
      });
    }
    for (uint32_t t = 0; t < code.net.transitions.size(); ++t) {
      when(is_raised(code, code.fired[t]), [&] {
        for (uint32_t step : code.net.transitions[t].to) chart_enter(code, step);
      });
    }
  });
}

void Body::chart_enter(const ChartCode& code, uint32_t step) {
  set_flag(chart_place(code.steps[step], "X"));
  build_.store(chart_place(code.steps[step], "T"), kTime, build_.constant(kTime, 0));
  raise(code, code.entered[step]);
}

// A network in which no step is active begins: at its first call, or when an online change has
// taken away the step that was.
void Body::chart_starts(const ChartCode& code) {
  for (uint32_t network = 0; network < code.net.initial.size(); ++network) {
    uint32_t initial = code.net.initial[network];
    if (initial == sfc::kNone) continue;
    set_line(code.net.steps[initial].decl->name.span);
    ir::ValueId active = is_raised(code, code.active[network]);
    when(build_.unary(ir::Op::kNot, kBool, active), [&] { chart_enter(code, initial); });
  }
}

}  // namespace frontend
