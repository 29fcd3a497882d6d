// The end of a roll-out that failed or was aborted (X6-07): the edit goes again.
#include "base/joined.h"
#include "tools/stvm/fleet_roll.h"

namespace stvm {
namespace {

bool is_open(RollState state) {
  return state == RollState::kStarting || state == RollState::kOnTrial ||
         state == RollState::kAccepting || state == RollState::kLost ||
         state == RollState::kUndoing || state == RollState::kStays;
}

}  // namespace

void FleetRoll::fail(RollPhase phase, std::string why) {
  const std::lock_guard<std::mutex> one(lock_);
  plan_.phase = phase;
  plan_.why = std::move(why);
  for (RollMember& row : plan_.members) {
    if (row.state != RollState::kWaiting) continue;
    row.state = RollState::kSkipped;
    row.since_ms = ports_.now_ms();
  }
  if (save()) ports_.say(plan_.why + "\n");
}

// The rest of the wave, and of all where the policy says so. Whom nobody reaches takes it back by
// itself when its deadline comes.
void FleetRoll::undo_open() {
  const bool aborts = plan_.phase == RollPhase::kAborting;
  std::vector<size_t> open;
  for (size_t wave = plan_.wave + 1; wave-- > 0;) {
    for (const size_t member : plan_.settings.waves[wave].members) {
      const RollMember& row = plan_.members[member];
      const bool accepted = !aborts && plan_.settings.undo_all && row.state == RollState::kAccepted;
      if (is_open(row.state) || accepted) open.push_back(member);
    }
  }
  for_each(open, plan_.settings.waves[plan_.wave].parallel, &FleetRoll::undo);
  if (stopped_) return;
  plan_.phase = aborts ? RollPhase::kAborted : RollPhase::kFailed;
  save();
}

void FleetRoll::undo(size_t member) {
  const RollState before = plan_.members[member].state;
  {
    const std::lock_guard<std::mutex> one(lock_);
    RollMember& row = plan_.members[member];
    row.was_accepted = row.was_accepted || before == RollState::kAccepted;
  }
  if (!decide(member, RollState::kUndoing)) return;
  Found found = look(member);
  if (found.answers && !found.on_trial && found.accepted) return undo_accepted(member);
  SwitchOptions options = how(member);
  options.switch_flags |= vm::kAllowLoss;  // nobody is there to ask, and the edit must go
  FleetUndo undo(edit_, std::move(options), access_);
  FleetRow row;
  if (found.on_trial) row = undo.visit(plan_.members[member].member);
  found = look(member);
  if (!found.answers) {
    decide(member, RollState::kLost, "it does not answer; its deadline takes the edit back");
  } else if (found.on_trial) {
    decide(member, RollState::kStays, row.why ? base::to_string(*row.why) : "it is still on trial");
  } else if (!found.switched) {
    decide(member, RollState::kSkipped);
  } else {
    decide(member, RollState::kUndone, found.text);
  }
}

// X8: to the version before, if it is the one that the plan has found there.
void FleetRoll::undo_accepted(size_t member) {
  const RollMember row = plan_.members[member];
  const auto stays = [&](const base::Error& why) {
    const bool gone = why.refusal == base::Refusal::kNotRunning;
    decide(member, gone ? RollState::kLost : RollState::kStays, base::to_string(why));
  };
  if (is_at_agent(row.member)) {
    return stays({base::Refusal::kUsage,
                  "what is accepted does not go back over a broker; `stvm revert` there"});
  }
  base::Result<ControllerClient> client = access_.connect(row.member);
  if (!client.ok()) return stays(client.error());
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return stays(status.error());
  if (status->running == row.from) {
    decide(member, RollState::kUndone, "the version before runs");
    return;
  }
  base::Result<base::Bytes> running = client->image();
  if (!running.ok()) return stays(running.error());
  base::Result<base::Bytes> before = client->image_before();
  if (!before.ok()) return stays(before.error());
  base::Result<ir::VerifiedImage> image = ir::verify(*before);
  if (status->running != row.to || !image.ok() || image->digest() != row.from) {
    return stays({base::Refusal::kStaleBase,
                  "somebody has changed it since it was accepted; `stvm revert` there"});
  }
  base::Result<base::Bytes> package = ports_.package_back(*running, *before);
  if (!package.ok()) return stays(package.error());
  SwitchOptions options = how(member);
  options.guard.clear();
  options.note = kBackNote + note(plan_.wave_of(member));
  options.switch_flags |= vm::kAllowLoss | vm::kPermanent;
  base::Result<Outcome> outcome = bring(options, *client, *package);
  if (!outcome.ok()) return stays(outcome.error());
  if (outcome->refused) return stays(*outcome->refused);
  decide(member, RollState::kUndone, "the version before runs");
}

}  // namespace stvm
