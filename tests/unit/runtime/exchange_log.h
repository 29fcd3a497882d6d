// A controller on virtual time whose devices note all that is exchanged: a round of a loop takes a
// microsecond.
#pragma once

#include "tests/unit/runtime/plant.h"

namespace runtime_test {

// The number of the reception is the first byte of the inputs. A note is "20 in3" or "20 out1.2",
// with whole milliseconds; all bytes of the outputs are in it.
class ExchangeLog : public vm::IoPort {
 public:
  explicit ExchangeLog(vm::Clock& clock) : clock_(clock) {}
  void receive(std::span<uint8_t> inputs) override {
    ++received;
    if (!inputs.empty()) inputs[0] = static_cast<uint8_t>(received);
    note("in" + std::to_string(received));
  }
  void lost_tasks(std::span<uint8_t> tasks) override {
    if (lost_in == received) tasks[lost_task] = 1;
  }
  void send(std::span<const uint8_t> outputs) override {
    sent.assign(outputs.begin(), outputs.end());
    std::string bytes;
    for (const uint8_t byte : outputs) {
      bytes += (bytes.empty() ? "" : ".") + std::to_string(byte);
    }
    note("out" + bytes);
  }

  std::string text;
  base::Bytes sent;
  int received = 0;
  int lost_in = 0;  // which reception finds a device lost, and whose
  uint32_t lost_task = 0;

 private:
  void note(const std::string& what) {
    text += std::to_string(clock_.now_ns() / kMs) + " " + what + "  ";
  }
  vm::Clock& clock_;
};

class ExchangePlant {
 public:
  explicit ExchangePlant(const std::string& source, const std::vector<ir::SafeOutput>& safe = {}) {
    auto image = build(source, nullptr, safe);
    if (!image) return;
    vm::ControllerOptions options;
    options.fuel_slice = 20;
    auto started = vm::Controller::start(*image, options, clock, devices);
    EXPECT_TRUE(started.ok());
    if (started.ok()) controller = std::move(*started);
    devices.text.clear();
  }
  bool ok() const { return controller != nullptr; }
  vm::Controller* operator->() { return controller.get(); }
  // What is exchanged in so many calls of Controller::cycle().
  std::string cycles(int count) {
    devices.text.clear();
    for (int i = 0; i < count; ++i) controller->cycle();
    return devices.text;
  }
  std::string get(const std::string& path) const { return *controller->get(path); }
  // The version of before.
  std::unique_ptr<vm::Generation> change(const std::string& source) {
    auto next = build(source, &controller->image());
    if (!next) return nullptr;
    auto generation = controller->prepare(*next);
    EXPECT_TRUE(generation.ok());
    return generation.ok() ? controller->publish(std::move(*generation)) : nullptr;
  }
  vm::TaskActivity activity(size_t task) const {
    return controller->activity(task, controller->generation().number())
        .value_or(vm::TaskActivity{});
  }

  vm::VirtualClock clock{1000};
  ExchangeLog devices{clock};
  std::unique_ptr<vm::Controller> controller;
};

}  // namespace runtime_test
