#include "vm/runtime/io.h"

#include <algorithm>

namespace vm {

base::Status IoPort::prepare(const ir::VerifiedImage&) { return base::Ok{}; }
std::vector<DeviceStatus> IoPort::status() const { return {}; }

void SimulatedIo::set_input(size_t byte, uint8_t value) {
  if (byte >= inputs_.size()) inputs_.resize(byte + 1);
  inputs_[byte] = value;
}

void SimulatedIo::receive(std::span<uint8_t> inputs) {
  std::copy_n(inputs_.begin(), std::min(inputs.size(), inputs_.size()), inputs.begin());
}

void SimulatedIo::send(std::span<const uint8_t> outputs) {
  outputs_.assign(outputs.begin(), outputs.end());
  ++sends_;
}

}  // namespace vm
