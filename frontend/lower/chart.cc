// Sequential function charts: step times, transitions, moves. Actions: chart_actions.cc.
#include "frontend/lower/chart.h"

#include <algorithm>

#include "frontend/sfc/declare.h"

namespace frontend {
namespace {

constexpr ir::Scalar kBool = ir::Scalar::kBool;
constexpr ir::Scalar kTime = ir::Scalar::kI64;
constexpr ir::Scalar kWord = ir::Scalar::kU64;
constexpr uint32_t kWordBits = 64;
constexpr uint32_t kMostSingle = 16;  // flags that begin one by one

// How many of `count` tests share one that asks for all of them: few of them hold.
uint32_t group_size(size_t count) {
  uint32_t size = 1;
  if (count < 8) return size;
  while (size * size < count) ++size;
  return size;
}

}  // namespace

void ChartBody::run() {
  body_.set_line(chart_.span);
  unused_actions();
  if (!find_places()) return report_all();
  read_clock();
  active_steps();
  stored_times();
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
  ir::TypeId type = sema_.program.types.array(body_.elementary(ir::Kind::kBool), {{0, last}});
  flags_ = body_.temporary_place(type);
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

// Which steps' transitions need not wait until all times have grown.
void ChartBody::find_leaves() {
  leaves_at_once_ = true;
  std::vector<bool> plain;  // by transition
  for (const sfc::Transition& transition : net_.transitions) {
    const uint32_t from = transition.from.size() == 1 ? transition.from[0] : sfc::kNone;
    const ExprId condition = transition.decl->condition;
    plain.push_back(!condition.valid() || asks_only(condition, from));
    leaves_at_once_ = leaves_at_once_ && plain.back();
  }
  alone_.assign(net_.steps.size(), true);
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
    const std::vector<uint32_t>& from = net_.transitions[t].from;
    if (plain[t] && from.size() == 1) continue;
    for (uint32_t step : from) alone_[step] = false;
  }
}

// Nothing that a step or an action has, but for `step`; nothing that can trap, and no call.
bool ChartBody::asks_only(ExprId condition, uint32_t step) {
  const Note& note = sema_.infer(condition);
  const Expr& expr = tree_[condition];
  if (note.calls || note.can_trap || !note.type.valid()) return false;
  if (note.constant) return true;
  switch (expr.kind) {
    case ExprKind::kLiteral:
    case ExprKind::kName:
    case ExprKind::kQualified:
    case ExprKind::kDirect:
      return true;
    case ExprKind::kMember: {
      if (note.variable.valid()) return true;
      const Note& outer = sema_.infer(expr.operand);
      for (uint32_t other = 0; other < steps_.size(); ++other) {
        if (outer.variable == steps_[other]) return other == step;
      }
      const auto is_of = [&](const std::vector<VarId>& all) {
        return !all.empty() && sema_.resolve(all[0]).type == outer.type;
      };
      return !is_of(steps_) && !is_of(actions_) && asks_only(expr.operand, step);
    }
    case ExprKind::kBit:
    case ExprKind::kUnary:
      return asks_only(expr.operand, step);
    case ExprKind::kBinary:
      if (expr.binary == BinaryOp::kDiv || expr.binary == BinaryOp::kMod) return false;
      if (expr.binary == BinaryOp::kMul || expr.binary == BinaryOp::kPower) return false;
      return asks_only(expr.operand, step) && asks_only(expr.right, step);
    default:
      return false;
  }
}

// What is done for active steps alone, behind one test for several of them.
void ChartBody::active_steps() {
  const uint32_t size = group_size(steps_.size());
  active_.resize(net_.initial.size());
  fired_.resize((net_.transitions.size() + kWordBits - 1) / kWordBits);
  for (ir::Place& word : fired_) {
    word = body_.temporary_place(body_.elementary(ir::Kind::kLword));
    build_.store(word, kWord, build_.constant(kWord, 0));
  }
  for (uint32_t first = 0; first < steps_.size();) {
    const uint32_t network = net_.steps[first].network;
    uint32_t end = first;
    ir::ValueId any;
    while (end < steps_.size() && end - first < size && net_.steps[end].network == network) {
      any = either(any, build_.load(part(steps_[end++], "X"), kBool));
    }
    active_[network] = either(active_[network], any);
    when(any, [&] {
      if (end - first == 1) return active_step(first);
      for (uint32_t step = first; step < end; ++step) {
        when(part(steps_[step], "X"), [&] { active_step(step); });
      }
    });
    first = end;
  }
}

// Of the transitions that leave a step, the first whose condition holds fires.
void ChartBody::active_step(uint32_t step) {
  pass_time(steps_[step], "T");
  if (!alone_[step]) return;
  const uint32_t line = build_.line();
  ir::BlockId done = build_.new_block();
  for (uint32_t t : net_.steps[step].out) {
    if (!build_.reachable()) build_.start(build_.new_block());  // is checked
    const ChartTransition& decl = *net_.transitions[t].decl;
    ir::BlockId next = done;
    body_.set_line(decl.span);
    if (decl.condition.valid()) {
      next = build_.new_block();
      go_on_if(body_.condition(decl.condition), true, next);
    }
    fire(t);
    build_.jump(done);
    if (decl.condition.valid()) build_.start(next);
  }
  if (build_.reachable()) build_.jump(done);
  build_.start(done);
  build_.set_line(line);
}

void ChartBody::stored_times() {
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

void ChartBody::go_on_if(ir::ValueId condition, bool holds, ir::BlockId otherwise) {
  ir::BlockId on = build_.new_block();
  build_.branch(condition, holds ? on : otherwise, holds ? otherwise : on);
  build_.start(on);
}

// Fires when its steps are active, none of them was left by a transition that goes first,
// and its condition holds. No condition sees that a step has changed.
void ChartBody::transition(uint32_t number) {
  const sfc::Transition& transition = net_.transitions[number];
  if (alone_[transition.from[0]]) return;  // active_step()
  ir::BlockId next = build_.new_block();
  body_.set_line(transition.decl->span);
  for (uint32_t step : transition.from) {
    go_on_if(build_.load(part(steps_[step], "X"), kBool), true, next);
  }
  for (uint32_t step : transition.from) {
    if (spent_[step] != sfc::kNone) go_on_if(is_raised(spent_[step]), false, next);
  }
  if (transition.decl->condition.valid())
    go_on_if(body_.condition(transition.decl->condition), true, next);
  fire(number);
  for (uint32_t step : transition.from) raise(spent_[step]);
  build_.jump(next);
  build_.start(next);
}

void ChartBody::fire(uint32_t number) {
  const ir::Place& word = fired_[number / kWordBits];
  ir::ValueId bit = build_.constant(kWord, uint64_t{1} << number % kWordBits);
  build_.store(word, kWord, build_.binary(ir::Op::kOr, kWord, build_.load(word, kWord), bit));
  if (leaves_at_once_) leave(number);
}

void ChartBody::leave(uint32_t number) {
  for (uint32_t step : net_.transitions[number].from) {
    set_flag(part(steps_[step], "X"), false);
    raise(left_[step]);
  }
}

void ChartBody::each_fired(const std::function<void(uint32_t)>& then) {
  const auto count = static_cast<uint32_t>(net_.transitions.size());
  const uint32_t size = std::min(group_size(count), kWordBits);
  const auto any_of = [&](uint32_t first, uint32_t end) {
    const uint64_t bits = ~uint64_t{0} >> (kWordBits - (end - first)) << first % kWordBits;
    ir::ValueId word = build_.load(fired_[first / kWordBits], kWord);
    ir::ValueId fired = build_.binary(ir::Op::kAnd, kWord, word, build_.constant(kWord, bits));
    return build_.compare(ir::Op::kNe, kWord, fired, build_.constant(kWord, 0));
  };
  for (uint32_t first = 0; first < count;) {
    const uint32_t behind_word = (first / kWordBits + 1) * kWordBits;
    const uint32_t end = std::min({first + size, behind_word, count});
    when(any_of(first, end), [&] {
      if (end - first == 1) return then(first);
      for (uint32_t t = first; t < end; ++t) when(any_of(t, t + 1), [&] { then(t); });
    });
    first = end;
  }
}

void ChartBody::moves() {
  if (net_.transitions.empty()) return;
  ir::ValueId all;
  for (const ir::Place& place : fired_) {
    ir::ValueId word = build_.load(place, kWord);
    all = all.valid() ? build_.binary(ir::Op::kOr, kWord, all, word) : word;
  }
  when(build_.compare(ir::Op::kNe, kWord, all, build_.constant(kWord, 0)), [&] {
    if (!leaves_at_once_) each_fired([&](uint32_t t) { leave(t); });
    each_fired([&](uint32_t t) {
      for (uint32_t step : net_.transitions[t].to) enter(step);
    });
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
    when(build_.unary(ir::Op::kNot, kBool, active_[network]), [&] { enter(initial); });
  }
}

}  // namespace frontend
