// stvm fleet change: the edit of a fleet file on one controller after the other (E-27 to E-31).
#include <optional>

#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_edits.h"
#include "tools/stvm/fleet_steps.h"
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/waiting.h"

namespace stvm {

FleetChange::FleetChange(const FleetEdit& edit, SwitchOptions how, FleetAccess access)
    : FleetVisit(edit, std::move(how), std::move(access), "Start it there?",
                 "not switched; the old program runs on") {
  if (how_.note.empty()) how_.note = fleet_note(edit.digest);
}

// With --wait again, until others are done: what they leave is checked anew.
FleetRow FleetChange::visit(const FleetMember& member) {
  if (is_at_agent(member)) return access_.agents->change(edit_, how_, talk_, member);
  for (;;) {
    FleetRow row = talk_.begin(member);
    if (talk_.is_over()) return row;
    const bool waits = how_.wait && !how_.dry_run;
    std::optional<FleetSeen> seen = see(access_, talk_, member, row, waits);
    if (!seen) return row;
    base::Status fits = check_parts(edit_, seen->image, row);
    talk_.say(tools::part_edits_text(row.parts, true));
    if (!fits.ok()) return talk_.ended(std::move(row), FleetOutcome::kRefused, fits.error());
    if (row.outcome == FleetOutcome::kHadIt) return had_it(*seen, std::move(row));
    SwitchOptions how = how_;
    if (member.allow_loss) how.switch_flags |= vm::kAllowLoss;
    row = change(how, *seen, std::move(row));
    if (!waits || !row.why || !others_change(*row.why)) return row;
  }
}

base::Error rolls_on_trial() {
  return {base::Refusal::kChangePending,
          "an edit is on trial there, and no roll-out begins on that; accept it or undo it first"};
}

// Perhaps on trial: what has been for some time is no canary, and --permanent ends it.
FleetRow FleetChange::had_it(FleetSeen& seen, FleetRow row) {
  if ((how_.switch_flags & vm::kPermanent) != 0) {
    return make_final(edit_, how_, talk_, seen, std::move(row));
  }
  if (how_.guard.empty()) return row;  // no roll-out
  base::Result<vm::StatusReport> status = seen.client.status();
  if (!status.ok()) return talk_.failed(std::move(row), status.error());
  if (status->edits == 0) return row;
  return talk_.ended(std::move(row), FleetOutcome::kRefused, rolls_on_trial());
}

FleetRow FleetChange::finished(const SwitchOptions& how, FleetRow row,
                               const Outcome& outcome) const {
  row.outcome = how.dry_run ? FleetOutcome::kPossible : FleetOutcome::kDone;
  row.report = outcome.report;
  if (!talk_.quiet()) print(how, outcome);
  return row;
}

FleetRow FleetChange::change(const SwitchOptions& how, FleetSeen& seen, FleetRow row) {
  const bool steps = !edit_.steps.empty() && !how.dry_run;
  if (steps && !edit_.steps_if_needed) return change_in_steps(how, seen, std::move(row));
  base::Result<base::Bytes> package = access_.package(seen.running, 0);
  if (!package.ok()) {
    if (steps && lacks_room(package.error())) {
      talk_.say("each unit starts by itself: " + package.error().text + "\n");
      return change_in_steps(how, seen, std::move(row));
    }
    const bool has = package.error().refusal == base::Refusal::kNoChange;
    row = talk_.ended(std::move(row), has ? FleetOutcome::kHadIt : FleetOutcome::kRefused,
                      package.error());
    if (has) row.why.reset();
    return row;
  }
  if (steps) talk_.say("all units start together: there is room for them\n");
  base::Result<Outcome> outcome = bring(how, seen.client, *package);
  const base::Error* const why = why_not(outcome);
  if (why != nullptr && steps && lacks_room(*why)) {
    talk_.say("each unit starts by itself: " + why->text + "\n");
    return change_in_steps(how, seen, std::move(row));
  }
  if (why != nullptr) return not_done(std::move(row), outcome);
  return finished(how, std::move(row), *outcome);
}

base::Result<Outcome> FleetChange::bring_step(const SwitchOptions& how, FleetSeen& seen,
                                              size_t step) {
  base::Result<base::Bytes> package = access_.package(seen.running, step + 1);
  if (!package.ok()) return package.error();
  base::Result<Outcome> outcome = bring(how, seen.client, *package);
  if (why_not(outcome) != nullptr) return outcome;
  if (base::Result<vm::StatusReport> status = seen.client.status(); !status.ok()) {
    return status.error();
  }
  base::Result<base::Bytes> running = seen.client.image();
  if (!running.ok()) return running.error();
  seen.running = std::move(*running);
  return outcome;
}

// The controller does it too when this program or the connection ends in the middle, or a trap
// takes the newest edit back.
FleetRow FleetChange::taken_back(FleetSeen& seen, FleetRow row, const base::Error& why) const {
  for (size_t left = row.mixtures.size(); left != 0; --left) {
    base::Result<FleetEdits> edits = fleet_edits_on(seen.client, edit_.digest);
    if (edits.ok() && edits->here.empty()) break;  // it has done so by itself
    base::Status gone = edits.ok() ? base::Status(base::Ok{}) : edits.error();
    base::Result<vm::StatusReport> status = seen.client.status();
    if (gone.ok() && !status.ok()) gone = status.error();
    if (gone.ok()) {
      base::Result<online_change::SwitchReport> undone =
          seen.client.undo(edits->here.front(), {vm::kWithLoss});
      if (!undone.ok()) gone = undone.error();
    }
    if (gone.ok()) continue;
    return talk_.failed(std::move(row),
                        {why.refusal, why.text +
                                          "; what had come was not taken back by this "
                                          "program: " +
                                          base::to_string(gone.error())});
  }
  return talk_.ended(std::move(row), FleetOutcome::kTakenBack, why);
}

FleetRow FleetChange::change_in_steps(SwitchOptions how, FleetSeen& seen, FleetRow row) {
  const std::vector<size_t> to_come = steps_to_come(edit_.steps, row.parts, edit_.parts.units());
  const uint32_t flags = how.switch_flags;
  std::optional<Outcome> last;
  for (size_t i = 0; i < to_come.size(); ++i) {
    const bool more = i + 1 < to_come.size();
    how.switch_flags = more ? (flags & ~vm::kPermanent) | vm::kMoreToCome : flags;
    talk_.say("step " + std::to_string(i + 1) + " of " + std::to_string(to_come.size()) + ": " +
              ir::step_text(edit_.steps[to_come[i]]) + "\n");
    base::Result<Outcome> outcome = bring_step(how, seen, to_come[i]);
    const base::Error* const why = why_not(outcome);
    if (why != nullptr && i == 0) return not_done(std::move(row), outcome);
    if (why != nullptr) return taken_back(seen, std::move(row), *why);
    how.ask = false;  // somebody has said yes to all of it
    last = std::move(*outcome);
    if (!more) break;
    row.mixtures.push_back(
        mixture_of(edit_.steps, to_come, i + 1, last->report ? last->report->cycle_after : 0));
    talk_.say(mixture_text(row.mixtures.back()) + "\n");
  }
  if (!last) return row;
  return finished(how, std::move(row), *last);
}

}  // namespace stvm
