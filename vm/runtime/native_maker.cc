#include "vm/runtime/native_maker.h"

#include <chrono>

#include "vm/runtime/realtime.h"

namespace vm {
namespace {

void* enter(void* task) {
  (*static_cast<std::packaged_task<void()>*>(task))();
  return nullptr;
}

}  // namespace

void NativeMaker::start(const Generation& of, const TierOptions& tier,
                        std::optional<MadeCode> like) {
  stop();
  progress_.stop = false;
  progress_.pous = 0;
  pous_ = static_cast<uint32_t>(of.pous().size());
  progress_.stopped.reset();
  for_ = of.first_code();
  version_ = of.verified();
  task_ = std::packaged_task<void()>([this, work = of.native_work(tier, std::move(like))] {
    run_in_background();
    work(progress_);
  });
  done_ = {};
  pthread_t thread;
  if (::pthread_create(&thread, nullptr, enter, &task_) != 0) return;
  thread_ = thread;
  done_ = task_.get_future().share();
}

void NativeMaker::stop() {
  progress_.stop = true;
  if (thread_) ::pthread_join(*thread_, nullptr);
  thread_.reset();
  for_.reset();
}

std::optional<MadeCode> NativeMaker::take_stopped() {
  std::optional<MadeCode> made;
  if (progress_.stopped != nullptr && version_) {
    made.emplace(MadeCode{*version_, std::move(progress_.stopped)});
  }
  progress_.stopped.reset();
  version_.reset();
  return made;
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
