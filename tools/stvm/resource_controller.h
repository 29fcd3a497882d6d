// One resource of a run: its controller with devices, recorder and its share of the exchange.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "tools/common/options.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/device_drivers.h"
#include "vm/io/device_io.h"
#include "vm/io/global_exchange.h"
#include "vm/runtime/recorder.h"

namespace stvm {

// Images of the resources of one CONFIGURATION, and the names by which people address them: the
// last part of the image's name. One program alone has the name "". kUsage when they do not belong
// together.
base::Result<std::vector<vm::GlobalExchange::Resource>> name_resources(
    std::vector<ir::VerifiedImage> images);

// nullptr for one resource; kTwoWriters.
base::Result<std::unique_ptr<vm::GlobalExchange>> make_exchange(
    const std::vector<vm::GlobalExchange::Resource>& resources);

class ResourceController {
 public:
  struct Settings {
    const tools::Options& options;  // --device, --record
    vm::ControllerOptions limits = {};
    bool virtual_time = false;
    vm::GlobalExchange* exchange = nullptr;
    const std::vector<vm::GlobalExchange::Resource>& all;
    size_t number = 0;               // of this one among `all`
    vm::DeviceLog log = log_device;  // with `limits.events` for those that hang
    base::Bytes trial = {};          // RecordedStart::trial
  };
  // `clock` and what the settings refer to must outlive it. With several resources each records to
  // FILE.NAME.
  static base::Result<std::unique_ptr<ResourceController>> start(const Settings& settings,
                                                                 vm::Clock& clock,
                                                                 base::ByteSpan retained);

  explicit ResourceController(vm::DeviceIo::Options devices) : io_(std::move(devices)) {}

  // One control cycle, recorded when it is.
  void cycle();
  vm::Controller& controller() { return *controller_; }
  vm::Recorder* recorder() { return recorder_.get(); }
  const std::string& name() const { return name_; }
  // Closes the recording, which is whole then.
  base::Status close() { return recorder_ ? recorder_->close() : base::Status(base::Ok{}); }

 private:
  std::string name_;
  vm::DeviceIo io_;
  std::unique_ptr<vm::ResourcePort> port_;
  std::unique_ptr<vm::Recorder> recorder_;
  std::unique_ptr<vm::Controller> controller_;
};

}  // namespace stvm
