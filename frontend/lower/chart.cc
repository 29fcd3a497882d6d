// Sequential function charts: step times, transitions, moves. Actions: chart_actions.cc.
#include "frontend/lower/chart.h"

#include <algorithm>

#include "frontend/sfc/declare.h"

namespace frontend {
namespace {

constexpr ir::Scalar kBool = ir::Scalar::kBool;
constexpr ir::Scalar kTime = ir::Scalar::kI64;

}  // namespace

void ChartBody::run() {
  body_.set_line(chart_.span);
  unused_actions();
  if (!find_places()) return report_all();
  read_clock();
  step_times();
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) transition(t);
  moves();
  starts();
  step_uses();
  controls();
  bodies();
}

// A name that means something else, too, has been reported; what remains is only checked.
void ChartBody::report_all() {
  for (const ChartTransition& transition : chart_.transitions) {
    if (transition.condition.valid()) body_.condition(transition.condition);
  }
  for (const sfc::Action& action : net_.actions) {
    if (action.decl == nullptr) variable_of(action);
  }
  for (const ChartStep& step : chart_.steps) {
    for (const ActionUse& use : step.uses) {
      limit_of(use);
      for (ExprId indicator : use.indicators) sema_.infer(indicator);
    }
  }
  for (const ChartAction& action : chart_.actions) body_.statements(action.body);
}

bool ChartBody::find_places() {
  auto variable = [&](std::string_view name, const char* member) {
    auto found = body_.info_.names.find(name);
    if (found == body_.info_.names.end()) return VarId();
    const Variable& resolved = sema_.resolve(found->second);
    bool own = resolved.decl != nullptr && resolved.decl->implied && resolved.type.valid();
    own = own && (member == nullptr || sema_.find_member(resolved.type, member) >= 0);
    return own ? found->second : VarId();
  };
  bool good = true;
  for (const sfc::Step& step : net_.steps) {
    steps_.push_back(variable(step.decl->name.text, "X"));
    good = good && steps_.back().valid();
  }
  qualifiers_.resize(net_.actions.size());
  for (const sfc::Action& action : net_.actions) {
    std::string record = std::string(action.name.text) + sfc::kRecordSuffix;
    actions_.push_back(variable(action.decl != nullptr ? action.name.text : record, "Q"));
    good = good && actions_.back().valid();
  }
  clock_ = variable(sfc::kClock, nullptr);
  if (!good || !clock_.valid()) return false;
  for (const sfc::Step& step : net_.steps) {
    for (const sfc::Use& use : step.uses) {
      qualifiers_[use.action] |=
          static_cast<uint16_t>(1u << static_cast<uint32_t>(use.decl->qualifier));
    }
  }
  number_flags();
  auto last = static_cast<int64_t>(flag_count_) - 1;
  ir::TypeId type = sema_.program.types.array(body_.elementary(ir::Kind::kBool), {{0, last}});
  flags_ = body_.temporary_place(type);
  build_.init(flags_, {});
  return true;
}

void ChartBody::number_flags() {
  auto number = [&](Numbers& numbers, size_t count, auto&& needed) {
    for (uint32_t i = 0; i < count; ++i) numbers.push_back(needed(i) ? flag_count_++ : sfc::kNone);
  };
  auto always = [](uint32_t) { return true; };
  auto step_uses = [&](ActionQualifier a, ActionQualifier b) {
    return [&, a, b](uint32_t step) {
      const std::vector<sfc::Use>& all = net_.steps[step].uses;
      return std::any_of(all.begin(), all.end(), [&](const sfc::Use& use) {
        return use.decl->qualifier == a || use.decl->qualifier == b;
      });
    };
  };
  moved_ = flag_count_++;
  early_ = flag_count_++;
  number(active_, net_.initial.size(), always);
  number(fired_, net_.transitions.size(), always);
  number(spent_, net_.steps.size(), [&](uint32_t step) { return net_.steps[step].out.size() > 1; });
  number(entered_, net_.steps.size(), step_uses(ActionQualifier::kP, ActionQualifier::kP1));
  number(left_, net_.steps.size(), step_uses(ActionQualifier::kP0, ActionQualifier::kP0));
  number(wanted_, net_.actions.size(), always);
  auto used_by = [&](ActionQualifier qualifier) {
    return [&, qualifier](uint32_t action) { return uses(action, qualifier); };
  };
  number(pulsed_, net_.actions.size(), used_by(ActionQualifier::kP1));
  number(released_, net_.actions.size(), used_by(ActionQualifier::kP0));
  number(reset_, net_.actions.size(), used_by(ActionQualifier::kR));
  number(late_, net_.actions.size(),
         [&](uint32_t action) { return net_.actions[action].decl != nullptr; });
}

ir::Place ChartBody::flag(uint32_t number) const {
  ir::Place place = flags_;
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kIndex;
  step.constant_index = number;
  place.type = body_.elementary(ir::Kind::kBool);
  return place;
}

ir::ValueId ChartBody::is_raised(uint32_t number) {
  return build_.load(flag(number), ir::Scalar::kBool);
}

void ChartBody::raise(uint32_t number) {
  if (number != sfc::kNone) set_flag(flag(number));
}

// A member of the variable of a step or action.
ir::Place ChartBody::part(VarId id, const char* member) {
  const Variable& variable = sema_.resolve(id);
  ir::Place place = body_.member_variable_place(variable);
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kMember;
  step.index = static_cast<uint32_t>(sema_.find_member(variable.type, member));
  place.type = body_.types()[variable.type].members[step.index].type;
  return place;
}

void ChartBody::set_flag(const ir::Place& flag, bool value) {
  build_.store(flag, kBool, build_.constant(kBool, value ? 1 : 0));
}

void ChartBody::when(ir::ValueId condition, const std::function<void()>& then) {
  ir::BlockId yes = build_.new_block();
  ir::BlockId done = build_.new_block();
  build_.branch(condition, yes, done);
  build_.start(yes);
  then();
  build_.jump(done);
  build_.start(done);
}

void ChartBody::when(const ir::Place& flag, const std::function<void()>& then) {
  when(build_.load(flag, kBool), then);
}

// A clock that has begun anew, after a restart with retained steps, stands still once.
void ChartBody::read_clock() {
  ir::Place clock = body_.member_variable_place(sema_.resolve(clock_));
  clock.type = body_.elementary(ir::Kind::kTime);
  ir::ValueId now = build_.task_time();
  ir::ValueId before = build_.load(clock, kTime);
  ir::ValueId passed = build_.binary(ir::Op::kSub, kTime, now, before);
  ir::ValueId backwards = build_.compare(ir::Op::kLt, kTime, now, before);
  elapsed_ = build_.select(kTime, backwards, passed, build_.constant(kTime, 0));
  build_.store(clock, kTime, now);
}

void ChartBody::pass_time(VarId variable, const char* member) {
  ir::Place time = part(variable, member);
  ir::ValueId before = build_.load(time, kTime);
  build_.store(time, kTime, build_.binary(ir::Op::kAdd, kTime, before, elapsed_));
}

void ChartBody::step_times() {
  for (uint32_t step = 0; step < steps_.size(); ++step) {
    when(part(steps_[step], "X"), [&] {
      pass_time(steps_[step], "T");
      raise(active_[net_.steps[step].network]);
    });
  }
  for (uint32_t action = 0; action < actions_.size(); ++action) {
    VarId record = actions_[action];
    if (uses(action, ActionQualifier::kSD)) {
      when(part(record, "SD"), [&] { pass_time(record, "SD_ET"); });
    }
    if (uses(action, ActionQualifier::kSL)) {
      when(part(record, "SL"), [&] { pass_time(record, "SL_ET"); });
    }
  }
}

// Fires when its steps are active, none of them was left by a transition that goes first,
// and its condition holds. No step changes yet: all conditions see the same steps.
void ChartBody::transition(uint32_t number) {
  const sfc::Transition& transition = net_.transitions[number];
  ir::BlockId next = build_.new_block();
  auto go_on_if = [&](ir::ValueId condition, bool holds) {
    ir::BlockId on = build_.new_block();
    build_.branch(condition, holds ? on : next, holds ? next : on);
    build_.start(on);
  };
  body_.set_line(transition.decl->span);
  for (uint32_t step : transition.from) {
    go_on_if(build_.load(part(steps_[step], "X"), kBool), true);
  }
  for (uint32_t step : transition.from) {
    if (spent_[step] != sfc::kNone) go_on_if(is_raised(spent_[step]), false);
  }
  if (transition.decl->condition.valid())
    go_on_if(body_.condition(transition.decl->condition), true);
  raise(fired_[number]);
  raise(moved_);
  for (uint32_t step : transition.from) {
    raise(spent_[step]);
  }
  build_.jump(next);
  build_.start(next);
}

void ChartBody::moves() {
  if (net_.transitions.empty()) return;
  when(is_raised(moved_), [&] {
    for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
      when(is_raised(fired_[t]), [&] {
        for (uint32_t step : net_.transitions[t].from) {
          set_flag(part(steps_[step], "X"), false);
          raise(left_[step]);
        }
      });
    }
    for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
      when(is_raised(fired_[t]), [&] {
        for (uint32_t step : net_.transitions[t].to) enter(step);
      });
    }
  });
}

void ChartBody::enter(uint32_t step) {
  set_flag(part(steps_[step], "X"));
  build_.store(part(steps_[step], "T"), kTime, build_.constant(kTime, 0));
  raise(entered_[step]);
}

// A network in which no step is active begins: at its first call, or when an online change has
// taken away the step that was.
void ChartBody::starts() {
  for (uint32_t network = 0; network < net_.initial.size(); ++network) {
    uint32_t initial = net_.initial[network];
    if (initial == sfc::kNone) continue;
    body_.set_line(net_.steps[initial].decl->name.span);
    ir::ValueId active = is_raised(active_[network]);
    when(build_.unary(ir::Op::kNot, kBool, active), [&] { enter(initial); });
  }
}

}  // namespace frontend
