// Devices without a fieldbus: none at all, and one whose terminals a test or a simulator sets.
#pragma once

#include <vector>

#include "vm/runtime/ports.h"

namespace vm {

// Inputs stay as they are, outputs go nowhere.
class NullIo : public IoPort {
 public:
  void receive(std::span<uint8_t>) override {}
  void send(std::span<const uint8_t>) override {}
};

// Input terminals hold what was set last; output terminals show what was sent last.
class SimulatedIo : public IoPort {
 public:
  void set_input(size_t byte, uint8_t value);
  uint8_t output(size_t byte) const { return byte < outputs_.size() ? outputs_[byte] : 0; }
  const base::Bytes& outputs() const { return outputs_; }
  uint64_t sends() const { return sends_; }

  // The next receive() finds a device lost whose loss is a trap of that task of the version.
  void lose(uint32_t task);

  void receive(std::span<uint8_t> inputs) override;
  void lost_tasks(std::span<uint8_t> tasks) override;
  void send(std::span<const uint8_t> outputs) override;

 private:
  base::Bytes inputs_;
  base::Bytes outputs_;
  base::Bytes lost_;  // by task
  uint64_t sends_ = 0;
};

}  // namespace vm
