// Devices under test: an image with devices and without much of a program, and a driver whose other
// end the test holds.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "ir/bytecode/verify.h"
#include "vm/io/device_io.h"

namespace io_test {

// Fails the test when the source does not compile or a device does not fit.
std::optional<ir::VerifiedImage> build(const std::string& source,
                                       const std::vector<ir::Device>& devices);

ir::DeviceMapping to_program(uint32_t first, uint32_t count, uint32_t byte);
ir::DeviceMapping to_device(uint32_t first, uint32_t count, uint32_t byte);
// Driver "simulated" by name; what it does is up to the test's factory.
ir::Device device(const std::string& name, std::vector<ir::DeviceMapping> map,
                  std::vector<ir::DeviceSetting> settings = {{"period_ms", "1"},
                                                             {"timeout_ms", "50"}});

// The other end of a FakeDriver; outlives it.
struct FakeDevice {
  std::mutex mutex;
  base::Bytes memory = base::Bytes(64);  // the device's bytes: outputs are written, inputs read
  std::vector<base::Bytes> written;      // every exchange that wrote
  std::atomic<bool> broken{false};       // answers with an error
  std::atomic<bool> hangs{false};        // an exchange does not end
  std::atomic<int> exchanges{0};
  std::atomic<int> alive{0};  // drivers that exist

  uint8_t byte(size_t at) {
    std::lock_guard lock(mutex);
    return memory[at];
  }
  void set(size_t at, uint8_t value) {
    std::lock_guard lock(mutex);
    memory[at] = value;
  }
};
// Inputs are bytes 32 and up of its memory, outputs those from 0 on.
std::unique_ptr<vm::IoDriver> fake_driver(FakeDevice& device);

// However loaded the machine is: waits up to ten minutes.
bool eventually(const std::function<bool()>& holds);

}  // namespace io_test
