#include "tools/stvm/fleet_edits.h"

#include <algorithm>

#include "tools/stvm/fleet_edit.h"
#include "tools/stvm/undo_only.h"

namespace stvm {
namespace {

using online_change::JournalEntry;

// The journal says of the switch to this edit what whoever brought it noted.
bool is_noted(const std::vector<JournalEntry>& journal, const TrialEdit& edit,
              const std::string& note) {
  return std::any_of(journal.begin(), journal.end(), [&](const JournalEntry& entry) {
    const std::string said = "edit " + edit.name + ", " + note;
    return entry.event == online_change::Event::kSwitched && entry.from == edit.from &&
           entry.to == edit.to && (entry.text == said || entry.text.starts_with(said + ", "));
  });
}

}  // namespace

std::vector<std::string> FleetEdits::names() const {
  std::vector<std::string> out;
  for (const TrialEdit& edit : on_trial) out.push_back(edit.name);
  return out;
}

FleetEdits fleet_edits(std::vector<TrialEdit> edits, const std::vector<JournalEntry>& journal,
                       const base::Digest& file) {
  FleetEdits out;
  for (TrialEdit& edit : edits) {
    if (!edit.undone) out.on_trial.push_back(std::move(edit));
  }
  std::reverse(out.on_trial.begin(), out.on_trial.end());
  for (auto edit = out.on_trial.begin(); edit != out.on_trial.end(); ++edit) {
    if (!is_noted(journal, *edit, fleet_note(file))) continue;
    const bool gone = std::any_of(out.on_trial.begin(), edit, [&](const TrialEdit& later) {
      return is_noted(journal, later, take_out_note(edit->name));
    });
    if (!gone) out.here.push_back(edit->name);
  }
  return out;
}

base::Result<FleetEdits> fleet_edits_on(ControllerClient& client, const base::Digest& file) {
  base::Result<std::vector<TrialEdit>> edits = client.edits();
  if (!edits.ok()) return edits.error();
  if (edits->empty()) return FleetEdits{};
  auto journal = client.journal();
  if (!journal.ok()) return journal.error();
  return fleet_edits(std::move(*edits), *journal, file);
}

}  // namespace stvm
