// Sequential function charts: where their state lies, and the flags of one call. Steps and
// transitions: chart_steps.cc; actions: chart_actions.cc.
#include <algorithm>

#include "frontend/lower/chart.h"
#include "frontend/lower/statements.h"
#include "frontend/lower/values.h"
#include "frontend/sfc/declare.h"

namespace frontend {
namespace {

constexpr uint32_t kMostSingle = 16;  // flags that begin one by one

}  // namespace

void ChartBody::run() {
  set_line(chart_.span);
  unused_actions();
  if (!find_places()) return report_all();
  describe_net();
  read_clock();
  active_steps();
  stored_times();
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) transition(t);
  moves();
  starts();
  count_steps();
  step_uses();
  controls();
  bodies();
}

// A name that means something else, too, has been reported; what remains is only checked.
void ChartBody::report_all() {
  for (const ChartTransition& transition : chart_.transitions) {
    if (transition.condition.valid()) ask<Values>().condition(transition.condition);
  }
  for (const sfc::Action& action : net_.actions) {
    if (action.decl == nullptr) variable_of(action);
  }
  for (const ChartStep& step : chart_.steps) {
    for (const ActionUse& use : step.uses) {
      limit_of(use);
      for (ExprId indicator : use.indicators) infer(indicator);
    }
  }
  for (const ChartAction& action : chart_.actions) ask<Statements>().write(action.body);
}

void ChartBody::describe_net() {
  const auto members = [&](const std::vector<uint32_t>& steps) {
    std::vector<uint32_t> numbers;
    for (const uint32_t step : steps) numbers.push_back(resolve(steps_[step]).index);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
  };
  std::vector<ir::ChartMove>& chart = body_.out.chart;
  for (const uint32_t initial : net_.initial) {
    if (initial != sfc::kNone) chart.push_back({{}, members({initial})});
  }
  for (const sfc::Transition& transition : net_.transitions) {
    chart.push_back({members(transition.from), members(transition.to)});
  }
}

bool ChartBody::find_places() {
  auto variable = [&](std::string_view name, const char* member) {
    auto found = info_.names.find(name);
    if (found == info_.names.end()) return VarId();
    const Variable& resolved = resolve(found->second);
    bool own = resolved.decl != nullptr && resolved.decl->implied && resolved.type.valid();
    own = own && (member == nullptr || sema_.declared.find_member(resolved.type, member) >= 0);
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
  clock_ = variable(sfc::clock_name(*info_.decl), nullptr);
  if (!good || !clock_.valid()) return false;
  users_.resize(net_.actions.size());
  for (uint32_t step = 0; step < net_.steps.size(); ++step) {
    for (const sfc::Use& use : net_.steps[step].uses) {
      const ActionQualifier qualifier = use.decl->qualifier;
      users_[use.action].push_back({step, qualifier});
      qualifiers_[use.action] |= static_cast<uint16_t>(1u << static_cast<uint32_t>(qualifier));
    }
  }
  find_leaves();
  number_flags();
  late_.resize(net_.actions.size());
  if (flag_count_ == 0) return true;
  auto last = static_cast<int64_t>(flag_count_) - 1;
  ir::TypeId type = sema_.program.types.array(elementary(ir::Kind::kBool), {{0, last}});
  flags_ = temporary_place(type);
  if (flag_count_ > kMostSingle) {
    build_.init(flags_, {});
  } else {
    for (uint32_t i = 0; i < flag_count_; ++i) set_flag(flag(i), false);
  }
  return true;
}

void ChartBody::number_flags() {
  auto number = [&](Numbers& numbers, size_t count, auto&& needed) {
    for (uint32_t i = 0; i < count; ++i) numbers.push_back(needed(i) ? flag_count_++ : sfc::kNone);
  };
  auto step_uses = [&](ActionQualifier a, ActionQualifier b) {
    return [&, a, b](uint32_t step) {
      const std::vector<sfc::Use>& all = net_.steps[step].uses;
      return std::any_of(all.begin(), all.end(), [&](const sfc::Use& use) {
        return use.decl->qualifier == a || use.decl->qualifier == b;
      });
    };
  };
  number(spent_, net_.steps.size(),
         [&](uint32_t step) { return !alone_[step] && net_.steps[step].out.size() > 1; });
  number(entered_, net_.steps.size(), step_uses(ActionQualifier::kP, ActionQualifier::kP1));
  number(left_, net_.steps.size(), step_uses(ActionQualifier::kP0, ActionQualifier::kP0));
  number(wanted_, net_.actions.size(), [&](uint32_t action) {
    return uses(action, ActionQualifier::kL) || uses(action, ActionQualifier::kD) ||
           uses(action, ActionQualifier::kP);
  });
}

ir::Place ChartBody::flag(uint32_t number) const {
  ir::Place place = flags_;
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kIndex;
  step.constant_index = number;
  place.type = elementary(ir::Kind::kBool);
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
  const Variable& variable = resolve(id);
  ir::Place place = member_variable_place(variable);
  ir::Step& step = place.steps.emplace_back();
  step.kind = ir::StepKind::kMember;
  step.index = static_cast<uint32_t>(sema_.declared.find_member(variable.type, member));
  place.type = types()[variable.type].members[step.index].type;
  return place;
}

void ChartBody::set_flag(const ir::Place& flag, bool value) {
  build_.store(flag, kFlag, build_.constant(kFlag, value ? 1 : 0));
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
  when(build_.load(flag, kFlag), then);
}

}  // namespace frontend
