#include "tools/stvm/record.h"

#include <cstdio>
#include <filesystem>

namespace stvm {
namespace {

std::string file_of(const tools::Options& options, const std::string& resource) {
  return options.text("--record") + (resource.empty() ? "" : "." + resource);
}

}  // namespace

void keep_last_recording(const tools::Options& options, const std::string& resource) {
  const std::string file = file_of(options, resource);
  std::error_code unknown;
  if (!options.has("--record") || !std::filesystem::is_regular_file(file, unknown)) return;
  std::filesystem::rename(file, file + ".before", unknown);  // else it is overwritten
}

base::Result<std::unique_ptr<vm::Recorder>> open_recorder(
    const tools::Options& options, const std::string& resource, const ir::VerifiedImage& image,
    base::ByteSpan retained, const vm::ControllerOptions& limits, vm::Clock& clock, vm::IoPort& io,
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
  return vm::Recorder::create(file_of(options, resource), clock, io, start);
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
