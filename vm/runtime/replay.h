// The other end of a Recorder: a clock and devices that give a controller what it saw then.
#pragma once

#include "vm/runtime/ports.h"
#include "vm/runtime/recording.h"

namespace vm {

class Replay : public Clock, public IoPort {
 public:
  int64_t now_ns() override;
  void wait_until(int64_t) override {}
  void consumed(uint64_t) override {}
  void worked(int64_t) override {}
  void receive(std::span<uint8_t> inputs) override;
  void lost_tasks(std::span<uint8_t> tasks) override;
  void send(std::span<const uint8_t>) override {}
  void at_boundary(const ProcessImage& image, uint8_t* memory) override;

  void take_globals(const SharedGlobals& globals, uint8_t* memory) override;

  // What is seen from now on.
  void see(const Observed& observed);
  void see(const std::vector<int64_t>& clock);
  // Was everything seen, and no more asked for than was recorded?
  bool exact() const { return !asked_too_often_ && at_ == clock_.size(); }

 private:
  void take_reception();

  std::vector<int64_t> clock_;
  size_t at_ = 0;
  int64_t last_ns_ = 0;
  bool asked_too_often_ = false;
  base::Bytes inputs_;
  ByteChanges outputs_, markers_;  // to be written at the next boundary
  ByteChanges globals_;            // when the next cycle begins
  std::vector<RecordedReception> receptions_;
  size_t received_ = 0;  // of these
  ByteChanges changed_;  // Observed: of all receptions
  ByteChanges lost_;
};

}  // namespace vm
