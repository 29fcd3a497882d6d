#include "vm/runtime/io.h"

#include <algorithm>

namespace vm {

base::Status IoPort::prepare(const ir::VerifiedImage&) { return base::Ok{}; }
std::vector<DeviceStatus> IoPort::status() const { return {}; }

void SimulatedIo::set_input(size_t byte, uint8_t value) {
  if (byte >= inputs_.size()) inputs_.resize(byte + 1);
  inputs_[byte] = value;
}

void SimulatedIo::lose(uint32_t task) {
  if (task >= lost_.size()) lost_.resize(size_t{task} + 1);
  lost_[task] = 1;
}

void SimulatedIo::lost_tasks(std::span<uint8_t> tasks) {
  const size_t known = std::min(tasks.size(), lost_.size());
  std::copy_n(lost_.begin(), known, tasks.begin());
  std::fill(lost_.begin(), lost_.end(), uint8_t{0});
}

void SimulatedIo::receive(std::span<uint8_t> inputs) {
  std::copy_n(inputs_.begin(), std::min(inputs.size(), inputs_.size()), inputs.begin());
}

void SimulatedIo::send(std::span<const uint8_t> outputs) {
  outputs_.assign(outputs.begin(), outputs.end());
  ++sends_;
}

}  // namespace vm
