// A recorded run again: the same image sees what the controller saw then and is asked the same, and
// each cycle is compared with what it was.
#pragma once

#include <memory>
#include <optional>

#include "tools/stvm/controller_service.h"
#include "tools/stvm/memory_storage.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/recording.h"
#include "vm/runtime/replay.h"
#include "vm/runtime/state_sum.h"

namespace stvm {

class Player {
 public:
  explicit Player(vm::Recording recording) : recording_(std::move(recording)), store_(storage_) {}

  // The image is verified, and cycle 0 is run. kBadRecording for what cannot be played; else as
  // cycle().
  base::Status start();
  // Once after start() was ok: does a cycle follow?
  bool at_end() const { return next_ == recording_.cycles.size(); }
  // kReplayDiffers: it came out in another way, or a request that was carried out is refused.
  base::Status cycle();

  vm::Controller& controller() { return *controller_; }
  const vm::Recording& recording() const { return recording_; }

 private:
  // Every job is done at once: between two cycles of a replay there is nobody else.
  class AtOnce : public vm::Boundary {
   public:
    Outcome run(const std::function<void()>& job, int64_t) override {
      job();
      return Outcome::kDone;
    }
    void pause(int64_t) override {}
  };

  base::Status start_controller(const ir::VerifiedImage& image);
  base::Status start_service(const ir::VerifiedImage& image, uint64_t retained);
  // The cycle came out as it was, and after it is done what was asked for then.
  base::Status compare_and_ask(const vm::RecordedCycle& cycle);
  // The request was carried out then, whatever time was left; so it is now.
  base::Status ask(const vm::RecordedRequest& recorded);

  vm::Recording recording_;
  vm::Replay replay_;
  vm::StateSum sum_;
  vm::VirtualClock idle_clock_;
  MemoryStorage storage_;
  online_change::Store store_;
  AtOnce boundary_;
  std::unique_ptr<vm::Controller> controller_;
  std::optional<ControllerService> service_;
  size_t next_ = 1;
  size_t request_ = 0;
};

}  // namespace stvm
