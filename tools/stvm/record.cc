#include "tools/stvm/record.h"

#include <cstdio>

namespace stvm {

base::Result<std::unique_ptr<vm::Recorder>> open_recorder(const tools::Options& options,
                                                          const std::string& resource,
                                                          const ir::VerifiedImage& image,
                                                          base::ByteSpan retained,
                                                          const vm::ControllerOptions& limits,
                                                          vm::Clock& clock, vm::IoPort& io,
                                                          base::ByteSpan trial) {
  if (!options.has("--record")) return std::unique_ptr<vm::Recorder>();
  if (limits.halted) {
    std::fputs("nothing is recorded: the controller begins in FAULT\n", stderr);
    return std::unique_ptr<vm::Recorder>();
  }
  vm::RecordedStart start;
  start.image = image.encoded();
  start.retained.assign(retained.begin(), retained.end());
  start.fuel_slice = limits.fuel_slice;
  start.fuel_budget = limits.fuel_budget;
  start.code_limit = limits.code_limit;
  start.data_limit = limits.data_limit;
  start.on_trap = limits.on_trap;
  start.trial.assign(trial.begin(), trial.end());
  std::string file = options.text("--record");
  if (!resource.empty()) file += "." + resource;
  return vm::Recorder::create(file, clock, io, start);
}

base::Result<std::unique_ptr<vm::Controller>> start_recorded(const ir::VerifiedImage& image,
                                                             const vm::ControllerOptions& limits,
                                                             vm::Clock& clock, vm::IoPort& io,
                                                             base::ByteSpan retained,
                                                             vm::Recorder* recorder) {
  if (recorder == nullptr) return vm::Controller::start(image, limits, clock, io, retained);
  recorder->begin();
  auto controller = vm::Controller::start(image, limits, *recorder, *recorder, retained);
  if (controller.ok()) recorder->end(**controller);
  return controller;
}

}  // namespace stvm
