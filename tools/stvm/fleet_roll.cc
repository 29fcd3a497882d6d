#include "tools/stvm/fleet_roll.h"

#include <algorithm>

#include "base/joined.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_edits.h"
#include "tools/stvm/fleet_walk.h"

namespace stvm {
namespace {

constexpr int64_t kBetweenLooksMs = 1000;
constexpr const char* kLost = "it does not answer; if the edit came there, it decides alone";

bool counts_as_failed(RollState state) {
  return state == RollState::kRefused || state == RollState::kFailed || state == RollState::kLost ||
         state == RollState::kUndone || state == RollState::kStays;
}

}  // namespace

std::string FleetRoll::note(size_t wave) const {
  return base::joined({"plan ", plan_.id, " wave ", std::to_string(wave + 1), " by ", plan_.who});
}

SwitchOptions FleetRoll::how(size_t member) const {
  const size_t wave = plan_.wave_of(member);
  SwitchOptions how;
  how.stage_flags = plan_.stage_flags;
  how.switch_flags = plan_.switch_flags;
  if (plan_.members[member].member.allow_loss) how.switch_flags |= vm::kAllowLoss;
  how.sign = access_.sign;
  how.ask = false;
  how.json = true;
  how.note = base::joined({fleet_note(edit_.digest), ", ", note(wave)});
  how.wave = static_cast<uint32_t>(wave + 1);
  GuardOrder order = plan_.settings.guard;
  order.note = note(wave);
  order.deadline_ns = plan_.settings.waves[wave].deadline_ms * 1'000'000;
  how.guard = encode(order);
  how.window_ms = order.window_ns / 1'000'000;
  return how;
}

FleetRow FleetRoll::visit_change(size_t member, bool dry_run) const {
  SwitchOptions options = how(member);
  options.dry_run = dry_run;
  if (dry_run) options.stage_flags |= vm::kRehearsal;
  FleetChange change(edit_, std::move(options), access_);
  return change.visit(plan_.members[member].member);
}

std::vector<FleetRow> FleetRoll::check_all() const {
  std::vector<FleetMember> members;
  uint32_t most = 1;
  for (const RollMember& row : plan_.members) members.push_back(row.member);
  for (const Wave& wave : plan_.settings.waves) most = std::max(most, wave.parallel);
  FleetWalk walk_all;
  walk_all.jobs = most;
  walk_all.visit = [&](const FleetMember& member) {
    const auto found = std::find_if(members.begin(), members.end(), [&](const FleetMember& one) {
      return one.name == member.name;
    });
    return visit_change(static_cast<size_t>(found - members.begin()), true);
  };
  walk_all.told = [](const FleetMember&, const FleetRow&) {};
  return walk(members, walk_all);
}

// What the journal says of this plan, and what is on trial.
FleetRoll::Found FleetRoll::look(size_t member) const {
  const RollMember& row = plan_.members[member];
  if (is_at_agent(row.member)) return access_.agents->look(row.member, plan_.id);
  base::Result<ControllerClient> client = access_.connect(row.member);
  if (!client.ok()) return {};
  Found known;
  known.edit = row.edit;
  known.from = row.from;
  known.to = row.to;
  return find_plan(*client, plan_.id, known);
}

bool FleetRoll::save() {
  if (stopped_) return false;
  base::Status saved = ports_.save(plan_);
  if (!saved.ok()) stopped_ = saved.error();
  return saved.ok();
}

bool FleetRoll::decide(size_t member, RollState state, const std::string& text) {
  const std::lock_guard<std::mutex> one(lock_);
  if (stopped_) return false;
  RollMember& row = plan_.members[member];
  if (row.state != state) row.since_ms = ports_.now_ms();
  row.state = state;
  row.text = text;
  if (!save()) return false;
  ports_.say(base::joined(
      {row.member.name, ": ", roll_state_name(state), text.empty() ? "" : ": ", text, "\n"}));
  // What waits for it at a broker must not begin later.
  if (state == RollState::kLost && is_at_agent(row.member)) {
    access_.agents->withdraw(edit_, how(member), row.member);
  }
  return true;
}

void FleetRoll::for_each(const std::vector<size_t>& members, uint32_t parallel, Step step) {
  std::vector<FleetMember> list;
  for (const size_t member : members) list.push_back(plan_.members[member].member);
  FleetWalk all;
  all.jobs = parallel;
  all.visit = [&](const FleetMember& one) {
    const auto found = std::find_if(members.begin(), members.end(), [&](size_t member) {
      return plan_.members[member].member.name == one.name;
    });
    (this->*step)(*found);
    return FleetRow{};
  };
  all.told = [](const FleetMember&, const FleetRow&) {};
  (void)walk(list, all);
}

std::vector<size_t> FleetRoll::with_state(size_t wave, RollState state) const {
  std::vector<size_t> out;
  for (const size_t member : plan_.settings.waves[wave].members) {
    if (plan_.members[member].state == state) out.push_back(member);
  }
  return out;
}

size_t FleetRoll::failed_in(size_t wave) const {
  const std::vector<size_t>& members = plan_.settings.waves[wave].members;
  return static_cast<size_t>(std::count_if(members.begin(), members.end(), [&](size_t member) {
    return counts_as_failed(plan_.members[member].state);
  }));
}

// Of the wave at work, or of one before it that is on trial still.
bool FleetRoll::too_many_failed() const {
  for (size_t wave = 0; wave <= plan_.wave; ++wave) {
    if (failed_in(wave) > plan_.settings.waves[wave].max_failed) return true;
  }
  return false;
}

base::Status FleetRoll::run() {
  while (!is_over(plan_.phase) && !stopped_) {
    if (base::Status gone_on = go_on(); !gone_on.ok()) return gone_on;
  }
  return stopped_ ? base::Status(*stopped_) : base::Status(base::Ok{});
}

base::Status FleetRoll::abort() {
  if (is_over(plan_.phase)) {
    return base::Error{base::Refusal::kNothingToUndo,
                       base::joined({"the roll-out is over: ", roll_phase_name(plan_.phase)})};
  }
  fail(RollPhase::kAborting, "aborted");
  return run();
}

base::Status FleetRoll::go_on() {
  if (plan_.phase != RollPhase::kRunning) {
    undo_open();
    return base::Ok{};
  }
  const Wave& wave = plan_.settings.waves[plan_.wave];
  const bool fresh = with_state(plan_.wave, RollState::kWaiting).size() == wave.members.size();
  if (fresh) {
    if (base::Status may = ports_.may_begin(plan_); !may.ok()) return may;
  }
  run_wave();
  return base::Ok{};
}

void FleetRoll::run_wave() {
  const Wave& wave = plan_.settings.waves[plan_.wave];
  for_each(wave.members, wave.parallel, &FleetRoll::start);
  if (stopped_) return;
  if (plan_.soak_from_ms == 0) {
    plan_.soak_from_ms = ports_.now_ms();
    if (!save()) return;
  }
  for (;;) {
    watch_trials();
    if (stopped_) return;
    if (too_many_failed()) {
      return fail(RollPhase::kUndoing,
                  "wave " + std::to_string(plan_.wave + 1) + " has more failures than max_failed");
    }
    if (ports_.now_ms() - plan_.soak_from_ms >= wave.soak_ms) break;
    const int64_t left = wave.soak_ms - (ports_.now_ms() - plan_.soak_from_ms);
    ports_.pause_ms(std::min(left, kBetweenLooksMs));
  }
  end_wave();
}

// What was decided and perhaps done is looked at before it is done.
void FleetRoll::start(size_t member) {
  {
    const std::lock_guard<std::mutex> one(lock_);
    if (stopped_ || too_many_failed()) return;
  }
  const RollState state = plan_.members[member].state;
  if (state == RollState::kStarting) {
    const Found found = look(member);
    if (!found.answers) return silent(member);
    if (found.switched) return settle(member, found);
    return begin_trial(member);
  }
  if (state == RollState::kWaiting && decide(member, RollState::kStarting)) begin_trial(member);
}

void FleetRoll::begin_trial(size_t member) {
  const FleetRow row = visit_change(member, false);
  if (row.outcome == FleetOutcome::kHadIt) {
    decide(member, RollState::kHadIt);
    return;
  }
  // An answer that was lost says nothing of what was done.
  const Found found = look(member);
  if (found.answers && found.switched) return settle(member, found);
  const std::string why = row.why ? base::to_string(*row.why) : "";
  const bool gone = row.outcome == FleetOutcome::kUnreachable || !found.answers;
  if (gone) return silent(member);
  decide(member, RollState::kRefused, why);
}

// What has become of an edit that was brought.
void FleetRoll::settle(size_t member, const Found& found) {
  {
    const std::lock_guard<std::mutex> one(lock_);
    RollMember& row = plan_.members[member];
    if (!found.edit.empty()) {
      row.edit = found.edit;
      row.from = found.from;
      row.to = found.to;
    }
    row.was_accepted = row.was_accepted || found.accepted;
    row.silent_ms = 0;
  }
  const RollState state = plan_.members[member].state;
  if (found.on_trial && !found.alarm.empty()) {
    decide(member, RollState::kStays, found.alarm);
  } else if (found.on_trial) {
    if (state != RollState::kOnTrial) decide(member, RollState::kOnTrial);
  } else if (found.accepted) {
    decide(member, RollState::kAccepted);
  } else {
    decide(member, RollState::kFailed,
           found.text.empty() ? "the trial ended with its controller" : found.text);
  }
}

// X6-08. It is asked again until it has been silent for too long.
void FleetRoll::silent(size_t member) {
  int64_t since = 0;
  {
    const std::lock_guard<std::mutex> one(lock_);
    RollMember& row = plan_.members[member];
    if (row.silent_ms == 0) {
      row.silent_ms = ports_.now_ms();
      if (!save()) return;
    }
    since = row.silent_ms;
  }
  if (ports_.now_ms() - since < plan_.settings.lost_after_ms) return;
  decide(member, RollState::kLost, kLost);
}

void FleetRoll::watch_trials() {
  std::vector<size_t> open;
  for (size_t wave = 0; wave <= plan_.wave; ++wave) {
    for (const size_t member : plan_.settings.waves[wave].members) {
      const RollState state = plan_.members[member].state;
      if (state == RollState::kStarting || state == RollState::kOnTrial) open.push_back(member);
    }
  }
  for_each(open, plan_.settings.waves[plan_.wave].parallel, &FleetRoll::watch);
}

void FleetRoll::watch(size_t member) {
  if (plan_.members[member].state == RollState::kStarting) return start(member);
  const Found found = look(member);
  if (!found.answers) return silent(member);
  const bool was_silent = plan_.members[member].silent_ms != 0;
  if (found.on_trial && !was_silent && found.alarm.empty()) return;
  settle(member, found);
}

// Who is still being looked for when the soak is over counts as lost.
void FleetRoll::end_wave() {
  for (const RollState state : {RollState::kStarting, RollState::kOnTrial}) {
    for (const size_t member : with_state(plan_.wave, state)) {
      const bool silent_now = plan_.members[member].silent_ms != 0;
      if (silent_now && !decide(member, RollState::kLost, kLost)) {
        return;
      }
    }
  }
  const bool last = plan_.wave + 1 == plan_.settings.waves.size();
  const bool at_end = plan_.settings.waves[plan_.wave].accept_at_end;
  if (!too_many_failed() && (!at_end || last)) {
    for (size_t wave = last ? 0 : plan_.wave; wave <= plan_.wave; ++wave) accept_wave(wave);
  }
  if (stopped_) return;
  if (too_many_failed()) {
    return fail(RollPhase::kUndoing,
                "wave " + std::to_string(plan_.wave + 1) + " has more failures than max_failed");
  }
  if (last) {
    plan_.phase = RollPhase::kDone;
  } else {
    ++plan_.wave;
    plan_.soak_from_ms = 0;
  }
  save();
}

void FleetRoll::accept_wave(size_t wave) {
  std::vector<size_t> members = with_state(wave, RollState::kOnTrial);
  for (const size_t member : with_state(wave, RollState::kAccepting)) members.push_back(member);
  for_each(members, plan_.settings.waves[wave].parallel, &FleetRoll::accept);
}

void FleetRoll::accept(size_t member) {
  if (plan_.members[member].state == RollState::kOnTrial &&
      !decide(member, RollState::kAccepting)) {
    return;
  }
  const Found before = look(member);
  const bool well = before.on_trial && before.alarm.empty();
  if (before.answers && !well) return settle(member, before);
  FleetAccept accept(edit_, how(member), access_);
  const FleetRow row = accept.visit(plan_.members[member].member);
  const Found found = look(member);
  if (found.answers && !found.on_trial) return settle(member, found);
  const std::string why = row.why ? base::to_string(*row.why) : "it is still on trial";
  decide(member, RollState::kLost, "it was not accepted, so it is taken back there: " + why);
}

}  // namespace stvm
