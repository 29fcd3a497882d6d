// A controller under test: ST source -> image -> controller on virtual time with simulated devices.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "ir/bytecode/verify.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace runtime_test {

// Fails the test and returns nothing when the source does not compile.
std::optional<ir::VerifiedImage> build(const std::string& source, const ir::Image* base = nullptr,
                                       const std::vector<ir::SafeOutput>& safe = {});

class Plant {
 public:
  explicit Plant(const std::string& source, vm::ControllerOptions options = {},
                 int64_t ns_per_safe_point = 0,
                 const std::vector<ir::SafeOutput>& safe = {});

  vm::Controller& operator*() { return *controller; }
  vm::Controller* operator->() { return controller.get(); }
  bool ok() const { return controller != nullptr; }
  void cycles(int count);
  std::string get(const std::string& path) const;
  vm::TaskStatus task(const std::string& name) const;

  vm::VirtualClock clock;
  vm::SimulatedIo io;
  std::unique_ptr<vm::Controller> controller;
};

inline constexpr int64_t kMs = 1'000'000;

}  // namespace runtime_test
