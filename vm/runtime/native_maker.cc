#include "vm/runtime/native_maker.h"

#include <chrono>

#include "vm/runtime/realtime.h"

namespace vm {

NativeMaker::~NativeMaker() {
  progress_.stop = true;
  wait();
}

void NativeMaker::start(Generation& first, const TierOptions& tier) {
  pous_ = static_cast<uint32_t>(first.pous().size());
  done_ = std::async(std::launch::async, [this, &first, tier] {
            run_in_background();
            first.make_native(tier, progress_);
          }).share();
}

void NativeMaker::wait() const {
  if (done_.valid()) done_.wait();
}

uint32_t NativeMaker::to_make() const {
  if (!done_.valid()) return 0;
  const bool over = done_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return over ? 0 : pous_ - progress_.pous;
}

void NativeMaker::take(TaskTables& tables, uint64_t at, uint64_t cycle) const {
  if (at != 0 && done_.valid()) {
    if (cycle < at) return;
    wait();
  }
  const std::shared_ptr<const CodeTable>& newest = tables.generation->code();
  if (tables.own_code == newest) return;
  const bool is_own = tables.code == tables.own_code.get();  // nothing is forced
  tables.own_code = newest;
  if (is_own) tables.code = newest.get();
}

}  // namespace vm
