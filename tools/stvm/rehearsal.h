// A change that is only looked at, while another one is staged or on trial (case 78). It is staged
// on a controller of its own that stands still and has a copy of the live data, so nothing of the
// running one is touched, its way back least of all. Devices and other resources are not asked.
#pragma once

#include <memory>

#include "online_change/apply/change.h"
#include "tools/stvm/live_report.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/io.h"

namespace stvm {

class Rehearsal {
 public:
  Rehearsal() = default;  // empty: stage() makes one
  // Rehearses a change of the version that runs. `copy_of` reads live data at boundaries; the rest
  // is done beside the running program. Errors: those of Change::stage(), and kNoMemory where a
  // second range of addresses cannot be had.
  static base::Result<std::unique_ptr<Rehearsal>> stage(const vm::Controller& running,
                                                        base::ByteSpan package,
                                                        online_change::Strategy strategy,
                                                        online_change::TakenOut taken_out,
                                                        const LiveReport::CopyRanges& copy_of);

  vm::Controller& controller() { return *controller_; }
  online_change::Change& change() { return *change_; }
  const ir::VerifiedImage& next() const { return *change_->next(); }

 private:
  base::Status start(const vm::Controller& running, const LiveReport::CopyRanges& copy_of);
  base::Status adopt_forces(const vm::Controller& running);

  vm::VirtualClock clock_;
  vm::NullIo io_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::Change> change_;  // ends before its controller
};

}  // namespace stvm
