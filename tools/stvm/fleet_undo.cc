// stvm fleet undo, accept: what became of an edit on trial, on each controller that has it (E-32).
#include <algorithm>

#include "base/joined.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_edits.h"
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/waiting.h"

namespace stvm {
namespace {

// The newest edit of all, as `stvm undo` does it.
base::Result<Outcome> undo_newest(const SwitchOptions& how, const FleetTalk& talk,
                                  ControllerClient& client, const std::string& edit) {
  base::Result<FatePage> page = client.fates();
  if (!page.ok()) return page.error();
  talk.say(fates_text(*page) + losses_text(*page, ""));
  Outcome outcome;
  outcome.page = std::move(*page);
  const bool allow_loss = (how.switch_flags & vm::kAllowLoss) != 0;
  if (base::Status whole = check_losses(outcome.page, allow_loss); !whole.ok()) {
    outcome.refused = whole.error();
    return outcome;
  }
  if (how.dry_run) return outcome;
  if (how.ask) {
    if (base::Status go = how.confirm(); !go.ok()) {
      outcome.refused = go.error();
      return outcome;
    }
  }
  std::vector<std::string> ways;
  if (outcome.page.loss_count != 0) ways = {vm::kWithLoss};
  base::Result<online_change::SwitchReport> report = client.undo(edit, ways);
  if (!report.ok()) return report.error();
  outcome.report = *report;
  return outcome;
}

constexpr const char* kMakeFinal = "Make it final there?";
constexpr const char* kNotFinal = "not accepted; it stays on trial";

// "E2 by ann": those on trial below the newest edit of the file that are not of it.
std::string others_below(const FleetEdits& edits) {
  std::string text;
  bool below = false;
  for (const TrialEdit& edit : edits.on_trial) {
    below = below || edit.name == edits.here.front();
    const bool own = std::find(edits.here.begin(), edits.here.end(), edit.name) != edits.here.end();
    if (!below || own) continue;
    text += (text.empty() ? "" : ", ") + edit.name;
    if (!edit.who.empty()) text += " by " + edit.who;
  }
  return text;
}

// The outcome of a controller that has none of the edits on trial.
FleetOutcome without(const FleetEdit& edit, const ir::VerifiedImage& image) {
  FleetRow row;
  (void)check_parts(edit, image, row).ok();
  return row.outcome == FleetOutcome::kHadIt ? FleetOutcome::kHadIt : FleetOutcome::kHadItNot;
}

}  // namespace

FleetUndo::FleetUndo(const FleetEdit& edit, SwitchOptions how, FleetAccess access)
    : FleetVisit(edit, std::move(how), std::move(access), "Take it back there?",
                 "not taken back; the program on trial runs on") {}

// Where it was made more than once (--matching), each of them, newest first.
FleetRow FleetUndo::visit(const FleetMember& member) {
  if (is_at_agent(member)) {
    return access_.agents->decide(AgentAct::kTakeBack, edit_, how_, talk_, member);
  }
  FleetRow row = talk_.begin(member);
  if (talk_.is_over()) return row;
  std::optional<FleetSeen> seen = see(access_, talk_, member, row);
  if (!seen) return row;
  SwitchOptions how = how_;
  if (member.allow_loss) how.switch_flags |= vm::kAllowLoss;
  for (;;) {
    base::Result<FleetEdits> edits = fleet_edits_on(seen->client, edit_.digest);
    if (!edits.ok()) return talk_.failed(std::move(row), edits.error());
    if (edits->here.empty()) break;
    const std::string& edit = edits->here.front();
    talk_.say(edit + " is this edit\n");
    const bool newest = edit == edits->on_trial.front().name;
    base::Result<Outcome> outcome =
        newest ? undo_newest(how, talk_, seen->client, edit)
               : access_.take_back(how, seen->client, edit, edits->names());
    if (why_not(outcome) != nullptr) return not_done(std::move(row), outcome);
    row.edits += (row.edits.empty() ? "" : ", ") + edit;
    row.outcome = how.dry_run ? FleetOutcome::kPossible : FleetOutcome::kUndone;
    row.report = outcome->report;
    if (how.dry_run) return row;
    talk_.say("taken back\n");
    base::Result<vm::StatusReport> next = seen->client.status();
    if (!next.ok()) return talk_.failed(std::move(row), next.error());
  }
  if (!row.edits.empty()) return row;
  row.outcome = without(edit_, seen->image);
  if (row.outcome == FleetOutcome::kHadIt) {
    return talk_.failed(std::move(row), {base::Refusal::kNothingToUndo,
                                         "this edit is in the program and not on trial: it was "
                                         "accepted, or came in another way"});
  }
  talk_.say("this edit is not on trial here\n");
  return row;
}

// What lies below becomes final too, and that of others only where somebody has said so.
FleetRow make_final(const FleetEdit& edit, const SwitchOptions& how, FleetTalk& talk,
                    FleetSeen& seen, FleetRow row) {
  base::Result<FleetEdits> edits = fleet_edits_on(seen.client, edit.digest);
  if (!edits.ok()) return talk.failed(std::move(row), edits.error());
  if (edits->here.empty()) {
    row.outcome = without(edit, seen.image);
    talk.say("this edit is not on trial here\n");
    return row;
  }
  for (const std::string& name : edits->here) row.edits += (row.edits.empty() ? "" : ", ") + name;
  const std::string others = others_below(*edits);
  if (!others.empty()) talk.say("with it become final: " + others + "\n");
  if (how.dry_run) {
    row.outcome = FleetOutcome::kPossible;
    return row;
  }
  if (!others.empty() && !how.ask) {
    return talk.failed(
        std::move(row),
        {base::Refusal::kChangePending,
         base::joined({"edits below it are on trial and would become final, too: ", others,
                       "; accept or undo that there, or go without --yes"})});
  }
  if (how.ask) {
    base::Status go = talk.ask(kMakeFinal, kNotFinal);
    if (!go.ok()) return talk.ended(std::move(row), FleetOutcome::kCancelled, go.error());
  }
  // Undoes in the version that was looked at: whoever has changed it meanwhile is told so (R0301).
  base::Result<base::Bytes> done =
      seen.client.call({.command = vm::Command::kAccept, .names = {edits->here.front()}});
  if (!done.ok()) return talk.failed(std::move(row), done.error());
  row.outcome = FleetOutcome::kAccepted;
  talk.say("accepted\n");
  return row;
}

FleetAccept::FleetAccept(const FleetEdit& edit, SwitchOptions how, FleetAccess access)
    : FleetVisit(edit, std::move(how), std::move(access), kMakeFinal, kNotFinal) {}

FleetRow FleetAccept::visit(const FleetMember& member) {
  if (is_at_agent(member)) {
    return access_.agents->decide(AgentAct::kMakeFinal, edit_, how_, talk_, member);
  }
  FleetRow row = talk_.begin(member);
  if (talk_.is_over()) return row;
  std::optional<FleetSeen> seen = see(access_, talk_, member, row);
  if (!seen) return row;
  return make_final(edit_, how_, talk_, *seen, std::move(row));
}

}  // namespace stvm
