// stvm fleet change: the edit of a fleet file on one controller after the other (E-27 to E-31).
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/waiting.h"

namespace stvm {

FleetChange::FleetChange(const FleetEdit& edit, SwitchOptions how, FleetAccess access)
    : FleetVisit(edit, std::move(how), std::move(access), "Start it there?",
                 "not switched; the old program runs on") {
  how_.note = fleet_note(edit.digest);
}

// With --wait again, until others are done: what they leave is checked anew.
FleetRow FleetChange::visit(const FleetMember& member) {
  for (;;) {
    FleetRow row = talk_.begin(member);
    if (talk_.is_over()) return row;
    const bool waits = how_.wait && !how_.dry_run;
    std::optional<FleetSeen> seen = see(access_, talk_, member, row, waits);
    if (!seen) return row;
    base::Status fits = check_parts(edit_, seen->image, row);
    talk_.say(tools::part_edits_text(row.parts, true));
    if (!fits.ok()) return talk_.ended(std::move(row), FleetOutcome::kRefused, fits.error());
    if (row.outcome == FleetOutcome::kHadIt) return row;
    SwitchOptions how = how_;
    if (member.allow_loss) how.switch_flags |= vm::kAllowLoss;
    row = change(how, *seen, std::move(row));
    if (!waits || !row.why || !others_change(*row.why)) return row;
  }
}

FleetRow FleetChange::change(const SwitchOptions& how, FleetSeen& seen, FleetRow row) {
  base::Result<base::Bytes> package = access_.package(seen.running);
  if (!package.ok()) {
    const bool has = package.error().refusal == base::Refusal::kNoChange;
    row = talk_.ended(std::move(row), has ? FleetOutcome::kHadIt : FleetOutcome::kRefused,
                      package.error());
    if (has) row.why.reset();
    return row;
  }
  base::Result<Outcome> outcome = bring(how, seen.client, *package);
  if (why_not(outcome) != nullptr) return not_done(std::move(row), outcome);
  row.outcome = how.dry_run ? FleetOutcome::kPossible : FleetOutcome::kDone;
  row.report = outcome->report;
  if (!talk_.quiet()) print(how, *outcome);
  return row;
}

}  // namespace stvm
