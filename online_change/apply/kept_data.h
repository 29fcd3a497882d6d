// All values of the version that runs, as they are when a switch or an undo begins to run code that
// somebody has written: FB_Exit of what goes, start code of what is new. Both may write to any
// variable; when it traps, all are put back (X1). For start code by standby the other data area is
// that copy. All memory is taken beforehand.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bytes.h"
#include "online_change/apply/leaving.h"
#include "online_change/apply/transfer.h"

namespace online_change {

class KeptData {
 public:
  explicit KeptData(const ir::Image& running);
  // At the boundary. False: interrupted.
  bool keep(const uint8_t* memory, const Interrupted& interrupted);
  bool holds() const { return holds_; }  // behind keep()
  void put_back(uint8_t* memory);
  uint64_t size() const { return bytes_.size(); }

 private:
  std::vector<ir::Extent> extents_;
  base::Bytes bytes_;
  bool holds_ = false;
};

// May code that somebody has written run in the switch: FB_Init of an instance that is new,
// FB_Reinit, a function that gives a new reference its value? Cost: one look at all initial values
// of the plan.
bool start_code_runs(const Plan& plan, const ir::Image& new_image, const Leaving& leaving);

}  // namespace online_change
