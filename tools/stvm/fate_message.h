// The fate report of a staged change on the wire: pages of rows with live values.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "online_change/apply/change.h"
#include "tools/common/fate_report.h"

namespace stvm {

using tools::FateLine;

struct LossLine {
  online_change::LiveLoss loss;
};

struct FatePage {
  online_change::FateCounts counts;
  int64_t predicted_pause_ns = 0;
  uint64_t boundary_bytes = 0;
  uint64_t next = 0;  // first line of the next page; 0: this was the last
  std::vector<FateLine> lines;
  uint64_t loss_count = 0;       // live values that would be lost now
  std::vector<LossLine> losses;  // the first of them; first page only
  tools::PouEdits edits;         // first page only
  tools::SystemEdits system;     // first page only
};

base::Bytes encode(const FatePage& page);
base::Result<FatePage> decode_fate_page(base::ByteSpan body);

base::Bytes encode(const online_change::SwitchReport& report);
base::Result<online_change::SwitchReport> decode_switch_report(base::ByteSpan body);

}  // namespace stvm
