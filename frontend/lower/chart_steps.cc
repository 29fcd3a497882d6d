// Step times, transitions and moves of charts.
#include <algorithm>

#include "frontend/lower/chart.h"
#include "frontend/lower/values.h"

namespace frontend {
namespace {

constexpr ir::Scalar kStepWord = ir::Scalar::kU64;
constexpr uint32_t kWordBits = 64;

// How many of `count` tests share one that asks for all of them: few of them hold.
uint32_t group_size(size_t count) {
  uint32_t size = 1;
  if (count < 8) return size;
  while (size * size < count) ++size;
  return size;
}

}  // namespace

// A clock that has begun anew stands still once: after a restart with retained steps, or where the
// chart got a clock of its own.
void ChartBody::read_clock() {
  ir::Place clock = member_variable_place(resolve(clock_));
  clock.type = elementary(ir::Kind::kTime);
  ir::ValueId now = build_.task_time();
  ir::ValueId before = build_.load(clock, kElapsed);
  ir::ValueId passed = build_.binary(ir::Op::kSub, kElapsed, now, before);
  ir::ValueId backwards = build_.compare(ir::Op::kLt, kElapsed, now, before);
  elapsed_ = build_.select(kElapsed, backwards, passed, build_.constant(kElapsed, 0));
  build_.store(clock, kElapsed, now);
}

void ChartBody::pass_time(VarId variable, const char* member) {
  ir::Place time = part(variable, member);
  ir::ValueId before = build_.load(time, kElapsed);
  build_.store(time, kElapsed, build_.binary(ir::Op::kAdd, kElapsed, before, elapsed_));
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
  bit_.assign(net_.transitions.size(), sfc::kNone);
  for (uint32_t t = 0; t < net_.transitions.size(); ++t) {
    if (moves_at_once(t)) continue;
    bit_[t] = static_cast<uint32_t>(waiting_.size());
    waiting_.push_back(t);
  }
}

// The steps that it enters have been asked already, by active_steps(), and nobody asks again.
bool ChartBody::moves_at_once(uint32_t number) const {
  const sfc::Transition& transition = net_.transitions[number];
  const uint32_t from = transition.from[0];
  return leaves_at_once_ && alone_[from] &&
         std::all_of(transition.to.begin(), transition.to.end(),
                     [&](uint32_t step) { return step > from && alone_[step]; });
}

// Nothing that a step or an action has, but for `step`; nothing that can trap, and no call.
bool ChartBody::asks_only(ExprId condition, uint32_t step) {
  const Note& note = infer(condition);
  const Expr& expr = tree_[condition];
  if (note.calls || note.can_trap || !note.type.valid()) return false;
  if (note.constant) return true;
  // What the caller gave may be a part of a step.
  const bool in_out = note.variable.valid() && resolve(note.variable).section == VarSection::kInOut;
  if (in_out) return false;
  switch (expr.kind) {
    case ExprKind::kLiteral:
    case ExprKind::kName:
    case ExprKind::kQualified:
    case ExprKind::kDirect:
      return true;
    case ExprKind::kMember: {
      if (note.variable.valid()) return true;
      const Note& outer = infer(expr.operand);
      for (uint32_t other = 0; other < steps_.size(); ++other) {
        if (outer.variable == steps_[other]) return other == step;
      }
      const auto is_of = [&](const std::vector<VarId>& all) {
        return !all.empty() && resolve(all[0]).type == outer.type;
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

// What is done for active steps alone, after one test for several of them. The last ones come
// first: most transitions lead on.
void ChartBody::active_steps() {
  const uint32_t size = group_size(steps_.size());
  active_.resize(net_.initial.size());
  fired_.resize((waiting_.size() + kWordBits - 1) / kWordBits);
  for (ir::Place& word : fired_) {
    word = temporary_place(elementary(ir::Kind::kLword));
    build_.store(word, kStepWord, build_.constant(kStepWord, 0));
  }
  for (auto end = static_cast<uint32_t>(steps_.size()); end > 0;) {
    const uint32_t network = net_.steps[end - 1].network;
    uint32_t first = end;
    ir::ValueId any;
    while (first > 0 && end - first < size && net_.steps[first - 1].network == network) {
      any = either(any, build_.load(part(steps_[--first], "X"), kFlag));
    }
    active_[network] = either(active_[network], any);
    when(any, [&] {
      if (end - first == 1) return active_step(first);
      for (uint32_t step = end; step > first; --step) {
        when(part(steps_[step - 1], "X"), [&] { active_step(step - 1); });
      }
    });
    end = first;
  }
}

// Among the transitions that leave a step, the first whose condition holds fires.
void ChartBody::active_step(uint32_t step) {
  pass_time(steps_[step], "T");
  if (!alone_[step]) return;
  const uint32_t line = build_.line();
  ir::BlockId done = build_.new_block();
  for (uint32_t t : net_.steps[step].out) {
    if (!build_.reachable()) build_.start(build_.new_block());  // is checked
    const ChartTransition& decl = *net_.transitions[t].decl;
    ir::BlockId next = done;
    set_line(decl.span);
    if (decl.condition.valid()) {
      next = build_.new_block();
      go_on_if(ask<Values>().condition(decl.condition), true, next);
    }
    count_transition(t);
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
  set_line(transition.decl->span);
  for (uint32_t step : transition.from) {
    go_on_if(build_.load(part(steps_[step], "X"), kFlag), true, next);
  }
  for (uint32_t step : transition.from) {
    if (spent_[step] != sfc::kNone) go_on_if(is_raised(spent_[step]), false, next);
  }
  if (transition.decl->condition.valid())
    go_on_if(ask<Values>().condition(transition.decl->condition), true, next);
  count_transition(number);
  fire(number);
  for (uint32_t step : transition.from) raise(spent_[step]);
  build_.jump(next);
  build_.start(next);
}

void ChartBody::count_transition(uint32_t number) {
  if (!body_.counting.on()) return;
  const auto names = [&](const std::vector<uint32_t>& steps) {
    std::string text;
    for (const uint32_t step : steps) {
      text += (text.empty() ? "" : ", ") + std::string(net_.steps[step].decl->name.text);
    }
    return text;
  };
  const sfc::Transition& transition = net_.transitions[number];
  body_.counting.count(SiteKind::kTransition, transition.decl->span.begin,
                       names(transition.from) + " to " + names(transition.to));
}

// At the end of a call, when all moves are made.
void ChartBody::count_steps() {
  if (!body_.counting.on()) return;
  for (uint32_t step = 0; step < net_.steps.size(); ++step) {
    const Name& name = net_.steps[step].decl->name;
    when(part(steps_[step], "X"),
         [&] { body_.counting.count(SiteKind::kStep, name.span.begin, std::string(name.text)); });
  }
}

void ChartBody::fire(uint32_t number) {
  if (leaves_at_once_) leave(number);
  if (bit_[number] == sfc::kNone) return enter_all(number);
  const ir::Place& word = fired_[bit_[number] / kWordBits];
  ir::ValueId bit = build_.constant(kStepWord, uint64_t{1} << bit_[number] % kWordBits);
  build_.store(word, kStepWord,
               build_.binary(ir::Op::kOr, kStepWord, build_.load(word, kStepWord), bit));
}

void ChartBody::leave(uint32_t number) {
  for (uint32_t step : net_.transitions[number].from) {
    set_flag(part(steps_[step], "X"), false);
    raise(left_[step]);
  }
}

void ChartBody::each_fired(const std::function<void(uint32_t)>& then) {
  const auto count = static_cast<uint32_t>(waiting_.size());
  const uint32_t size = std::min(group_size(count), kWordBits);
  const auto any_of = [&](uint32_t first, uint32_t end) {
    const uint64_t bits = ~uint64_t{0} >> (kWordBits - (end - first)) << first % kWordBits;
    ir::ValueId word = build_.load(fired_[first / kWordBits], kStepWord);
    ir::ValueId fired =
        build_.binary(ir::Op::kAnd, kStepWord, word, build_.constant(kStepWord, bits));
    return build_.compare(ir::Op::kNe, kStepWord, fired, build_.constant(kStepWord, 0));
  };
  for (uint32_t first = 0; first < count;) {
    const uint32_t behind_word = (first / kWordBits + 1) * kWordBits;
    const uint32_t end = std::min({first + size, behind_word, count});
    when(any_of(first, end), [&] {
      if (end - first == 1) return then(waiting_[first]);
      for (uint32_t i = first; i < end; ++i) when(any_of(i, i + 1), [&] { then(waiting_[i]); });
    });
    first = end;
  }
}

void ChartBody::moves() {
  if (waiting_.empty()) return;
  ir::ValueId all;
  for (const ir::Place& place : fired_) {
    ir::ValueId word = build_.load(place, kStepWord);
    all = all.valid() ? build_.binary(ir::Op::kOr, kStepWord, all, word) : word;
  }
  when(build_.compare(ir::Op::kNe, kStepWord, all, build_.constant(kStepWord, 0)), [&] {
    if (!leaves_at_once_) each_fired([&](uint32_t t) { leave(t); });
    each_fired([&](uint32_t t) { enter_all(t); });
  });
}

void ChartBody::enter_all(uint32_t number) {
  for (uint32_t step : net_.transitions[number].to) enter(step);
}

void ChartBody::enter(uint32_t step) {
  set_flag(part(steps_[step], "X"));
  build_.store(part(steps_[step], "T"), kElapsed, build_.constant(kElapsed, 0));
  raise(entered_[step]);
}

// A network in which no step is active begins: at its first call, or when an online change has
// taken away the step that was.
void ChartBody::starts() {
  for (uint32_t network = 0; network < net_.initial.size(); ++network) {
    uint32_t initial = net_.initial[network];
    if (initial == sfc::kNone) continue;
    set_line(net_.steps[initial].decl->name.span);
    when(build_.unary(ir::Op::kNot, kFlag, active_[network]), [&] { enter(initial); });
  }
}

}  // namespace frontend
