// A trial over the end of a process (D4): what is stored of it, and how it goes on.
#include <algorithm>
#include <cstdlib>

#include "online_change/package/package.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

// The number of "E12".
uint64_t number_of(const std::string& name) {
  return name.empty() ? 0 : std::strtoull(name.c_str() + 1, nullptr, 10);
}

}  // namespace

base::Status ControllerService::keep_edits(const Trial* next) {
  std::vector<online_change::StoredEdit> edits;
  const auto add = [&](const Trial& trial) {
    edits.push_back({trial.edit.name, trial.edit.who, trial.edit.time_ns, trial.edit.cycle,
                     trial.flags, trial.switch_flags, trial.edit.from, trial.edit.to, trial.package,
                     trial.retained.cycle, trial.retained.values});
  };
  for (const Trial& trial : trials_) add(trial);
  if (next != nullptr) add(*next);
  return store_.keep_edits(edits);
}

// From now on the policy of the edit counts again.
void ControllerService::resume(const std::vector<online_change::ResumedEdit>& edits,
                               const std::vector<std::string>& alarms) {
  start_.alarms.insert(start_.alarms.end(), alarms.begin(), alarms.end());
  base::Status adopted = base::Ok{};
  for (size_t i = 0; i < edits.size() && adopted.ok(); ++i) {
    const online_change::StoredEdit& stored = edits[i].stored;
    const ir::VerifiedImage& after =
        i + 1 < edits.size() ? edits[i + 1].before : controller_.verified();
    adopted = change_.adopt(stored.package, edits[i].before, after, stored.retained);
    if (!adopted.ok()) break;
    Trial trial{describe(edits[i].before, after, change_.plan()),
                edits[i].before,
                stored.package,
                stored.stage_flags,
                stored.switch_flags,
                {}};
    trial.edit.name = stored.name;
    trial.edit.who = stored.who;
    trial.edit.time_ns = stored.time_ns;
    trial.edit.cycle = stored.cycle;
    trial.retained.image = stored.from;
    trial.retained.cycle = stored.retained_cycle;
    trial.retained.values = stored.retained;
    edits_made_ = std::max(edits_made_, number_of(stored.name));
    changed_by_ = stored.who;
    trials_.push_back(std::move(trial));
  }
  if (!adopted.ok()) {
    not_undone_ = "the edits on trial have no way back: " + base::to_string(adopted.error()) +
                  "; the next start runs " + base::short_hex(store_.boots());
    trials_.clear();
    // Edits below the one that failed have a way back only together with it.
    if (change_.on_trial() != 0) (void)change_.accept();
    complain(store_.set_resumes(false));
  }
  change_.collect();
  if (trials_.empty()) return;
  complain(store_.set_resumes(last_edit_boots()));
  begin_probation({});
}

void ControllerService::keep_trial_over_stop() {
  if (trials_.empty() || guard_.is_on()) return;  // X6-08: nobody would watch it
  base::Status kept = keep_edits();
  if (kept.ok()) kept = store_follows();
  if (kept.ok()) kept = store_.set_resumes(true);
  complain(kept);
}

}  // namespace stvm
