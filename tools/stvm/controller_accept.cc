// How edits on trial become final.
#include <algorithm>

#include "base/joined.h"
#include "tools/stvm/controller_service.h"

namespace stvm {

// Durable first: after a power cut in between, the accepted version boots, as it was asked for.
base::Status ControllerService::make_permanent() {
  if (trials_.empty()) return change_.accept();
  const ir::VerifiedImage& before = trials_.front().before;
  base::Status stored = keep_programs();
  if (stored.ok()) {
    complain(
        store_.keep_before({before.digest(), before.encoded()}, controller_.verified().digest()));
    stored = store_follows();
  }
  if (stored.ok() && !store_.retained_fits()) stored = save_retained_now();
  if (stored.ok()) stored = store_.accept();
  if (!stored.ok()) {
    return refused(
        {stored.error().refusal, stored.error().text + "; the change runs, but is still on trial"});
  }
  base::Status accepted = change_.accept();  // nothing that runs depends on it
  const std::string watched = guard_.is_on() ? guard_.note() : std::string();
  online_change::Snapshot after = empty_snapshot();
  base::Status taken = at_boundary([&] {
    keeper_.take(after);
    guard_.end();
  });
  change_.collect();
  complain(taken.ok() ? keeper_.save(after) : taken);
  note_accepted(trials_.size(), controller_.verified().digest(), watched);
  not_undone_.clear();
  given_back_.clear();
  probation_.reset();
  return accepted;
}

// The newest edits stay on trial, and what they would go back to is stored with the values that
// were retained there.
base::Status ControllerService::make_oldest_permanent(size_t edits) {
  const ir::VerifiedImage& before = trials_.front().before;
  const ir::VerifiedImage next = trials_[edits].before;
  base::Status stored = keep_programs();
  if (stored.ok()) stored = store_follows();
  if (stored.ok()) stored = save_retained_now();
  if (stored.ok()) {
    complain(store_.keep_before({before.digest(), before.encoded()}, next.digest()));
    const online_change::Snapshot& values = trials_[edits].retained;
    stored = store_.accept_below({next.digest(), next.encoded()}, values.cycle, values.values);
  }
  if (!stored.ok()) {
    return refused(
        {stored.error().refusal, stored.error().text + "; all edits are still on trial"});
  }
  base::Status accepted = change_.accept_oldest(edits);
  note_accepted(edits, next.digest(), {});
  if (last_edit_boots() || trials_.size() > 1) complain(keep_edits());
  return accepted;
}

void ControllerService::note_accepted(size_t edits, const base::Digest& next,
                                      const std::string& watched) {
  online_change::JournalEntry done = entry(online_change::Event::kAccepted);
  done.from = trials_.front().before.digest();
  done.to = next;
  done.text = "edit " + trials_.front().edit.name;
  if (edits > 1) done.text += " to " + trials_[edits - 1].edit.name;
  if (edits == trials_.size() && !watched.empty()) done.text += ", " + watched;
  store_.note(std::move(done));
  std::vector<Trial> rest;
  for (size_t i = edits; i < trials_.size(); ++i) rest.push_back(std::move(trials_[i]));
  trials_ = std::move(rest);
  ++edition_;
  changed_by_ = who_;
}

base::Result<base::Bytes> ControllerService::accept(const vm::Request& request) {
  size_t edits = trials_.size();
  if (!request.names.empty()) {
    const auto found = std::find_if(trials_.begin(), trials_.end(), [&](const Trial& trial) {
      return trial.edit.name == request.names.front();
    });
    if (found == trials_.end()) {
      return base::Error{
          base::Refusal::kNothingToUndo,
          "no edit `" + request.names.front() + "` is on trial; `stvm edits` shows those that are"};
    }
    edits = static_cast<size_t>(found - trials_.begin()) + 1;
  }
  base::Status permanent =
      edits == trials_.size() ? make_permanent() : make_oldest_permanent(edits);
  if (!permanent.ok()) return permanent.error();
  return base::Bytes{};
}

}  // namespace stvm
