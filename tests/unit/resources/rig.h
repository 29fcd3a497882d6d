// Several resources under test: one source -> an image for each -> controllers that take turns on
// virtual time, with their globals exchanged; changed and undone one by one.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "online_change/apply/change.h"
#include "vm/io/global_exchange.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace resources_test {

inline constexpr int64_t kMs = 1'000'000;

// In the order of the source; each linked against what its entry of `bases` is, if any. Fails the
// test when the source does not compile.
std::vector<ir::VerifiedImage> build(const std::string& source,
                                     const std::vector<const ir::Image*>& bases = {});

class Rig {
 public:
  explicit Rig(const std::string& source, int64_t ns_per_safe_point = 0,
               vm::ControllerOptions options = {});

  bool ok() const { return error.empty(); }
  // Cycles of all, each at its time, up to and including those that begin at `ms`.
  void run_to(int64_t ms, const std::function<void(size_t)>& behind_cycle = {});
  std::string get(size_t resource, const std::string& path) const;
  vm::Controller& controller(size_t resource) { return *resources[resource]->controller; }
  std::vector<vm::DeviceStatus> status(size_t resource) const;
  // What the others say of the exchange with what this resource writes; "": nothing is wrong.
  std::string complaint(size_t resource) const;

  // Of one resource, to the program that it has in `source`. The refusal, if it is one.
  base::Status change(size_t resource, const std::string& source, bool allow_loss = true);
  void undo(size_t resource);
  void accept(size_t resource);

  struct Resource {
    explicit Resource(int64_t ns_per_safe_point) : clock(ns_per_safe_point) {}
    vm::VirtualClock clock;
    vm::SimulatedIo io;
    std::unique_ptr<vm::ResourcePort> port;
    std::unique_ptr<vm::Controller> controller;
    std::unique_ptr<online_change::Change> change;
  };
  std::unique_ptr<vm::GlobalExchange> exchange;
  std::vector<std::unique_ptr<Resource>> resources;
  std::string error;
};

}  // namespace resources_test
