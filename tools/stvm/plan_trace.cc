#include "tools/stvm/plan_trace.h"

#include <algorithm>

namespace stvm {
namespace {

using online_change::Event;
using online_change::JournalEntry;

void follow(const JournalEntry& entry, const std::string& noted, PlanTrace& found) {
  const bool back = entry.text.find(", " + std::string(kBackNote)) != std::string::npos;
  const bool ours = !back && entry.text.find(noted) != std::string::npos;
  if (ours && entry.event == Event::kSwitched) {
    found.switched = true;
    found.accepted = false;
    found.edit = entry.text.substr(5, entry.text.find(',') - 5);  // behind "edit "
    found.from = entry.from;
    found.to = entry.to;
    found.text.clear();
    return;
  }
  if (!found.switched) return;
  if (entry.event == Event::kAccepted && entry.to == found.to) found.accepted = true;
  if (entry.event == Event::kUndone && entry.from == found.to) found.text = entry.text;
}

bool is_on_trial(const std::vector<TrialEdit>& edits, const PlanTrace& known) {
  return std::any_of(edits.begin(), edits.end(), [&](const TrialEdit& one) {
    return !one.undone && one.name == known.edit && one.from == known.from && one.to == known.to;
  });
}

}  // namespace

PlanTrace find_plan(ControllerClient& client, const std::string& plan, const PlanTrace& known) {
  PlanTrace found;
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return found;
  const std::string noted = "plan " + plan + " wave ";
  for (std::string& alarm : status->alarms) {
    if (alarm.find(noted) != std::string::npos) found.alarm = std::move(alarm);
  }
  const auto edits = client.edits();
  if (!edits.ok()) return found;
  found.answers = true;
  if (!known.edit.empty() && is_on_trial(*edits, known)) {
    found.on_trial = found.switched = true;
    found.edit = known.edit;
    found.from = known.from;
    found.to = known.to;
    return found;
  }
  const auto journal = client.journal();
  found.answers = journal.ok();
  if (!journal.ok()) return found;
  for (const JournalEntry& entry : *journal) follow(entry, noted, found);
  found.on_trial = found.switched && is_on_trial(*edits, found);
  return found;
}

}  // namespace stvm
