// The first program of a controller that holds none, because no stored one is intact or none was
// ever stored: a change like any other up to its switch. It begins as at a start, and there is
// nothing that an undo could bring back.
#include "ir/bytecode/no_program.h"
#include "online_change/store/retained_values.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_service.h"

namespace stvm {

bool ControllerService::has_no_program() const {
  return ir::is_no_program(controller_.image());
}

base::Status ControllerService::store_first(base::Bytes& retained) {
  const base::Result<uint64_t> bytes = online_change::retained_bytes(staged_->image());
  if (!bytes.ok()) return bytes.error();
  keeper_.expect_bytes(*bytes);
  const std::optional<base::Digest> kept = store_.retained_program();
  std::optional<base::Bytes> own = store_.retained_of(staged_->digest());
  if (own && own->size() == *bytes) {
    retained = std::move(*own);
  } else if (kept) {
    start_.alarms.push_back("retained values begin anew: those that were stored are of " +
                            base::short_hex(*kept) + ", another program");
  }
  return store_.install({staged_->digest(), staged_->encoded()}, *bytes);
}

void ControllerService::begin_first(base::ByteSpan retained) {
  if (!retained.empty()) {
    vm::write_retained(controller_.image(), retained, controller_.memory().data());
  }
  (void)controller_.restart(vm::Restart::kWarm, kExitLimitNs).ok();  // nothing leaves
}

// Durable before it runs, as at a start.
base::Result<base::Bytes> ControllerService::switch_to_first() {
  preparing_ = true;
  base::Status ready = base::Ok{};
  base::Status taken = arm_in_time(true, true, ready);
  if (!taken.ok()) return not_switched(taken.error());
  if (!ready.ok()) return not_switched(ready.error());
  base::Bytes retained;
  base::Status stored = admission_.take(signer_, wall_time_());
  if (stored.ok()) stored = store_first(retained);
  if (!stored.ok()) {
    change_.cancel();
    return not_switched(stored.error());
  }
  online_change::JournalEntry installed = entry(online_change::Event::kInstalled);
  installed.text = signer_text(signer_);
  std::optional<base::Result<online_change::SwitchReport>> report;
  online_change::Snapshot after = empty_snapshot();
  int64_t done_ns = 0;
  taken = at_boundary([&] {
    report.emplace(change_.switch_now(false));
    if (report->ok()) begin_first(retained);
    done_ns = clock_.now_ns();
    if (report->ok()) keeper_.take(after);
  });
  change_.collect();
  if (!taken.ok() || !report->ok()) {
    change_.cancel();
    const base::Error& why = taken.ok() ? report->error() : taken.error();
    return not_switched({why.refusal, why.text + "; the program is stored, and the next start of "
                                                 "the controller runs it"});
  }
  preparing_ = false;
  (void)change_.accept().ok();  // nothing was there before
  change_.collect();
  complain(keeper_.save(after));
  store_.note(std::move(installed));
  start_.fault.clear();
  ++edition_;
  changed_by_ = who_;
  switched_cycle_ = (*report)->cycle_before;
  note_units("switched", (*report)->cycle_after);
  forget_staged();
  forget_rehearsal();
  return encode(finish_report(**report, 0, done_ns));
}

}  // namespace stvm
