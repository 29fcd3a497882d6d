// `--record FILE` of `stvm run` and `stvm serve`.
#pragma once

#include <memory>

#include "tools/common/options.h"
#include "vm/runtime/recorder.h"

namespace stvm {

// A recording that is there becomes FILE.before: a controller that died and was started anew has
// not lost what led to it. Not for a halted controller, which records nothing.
void keep_last_recording(const tools::Options& options, const std::string& resource);
// Nothing without the option. To FILE.NAME for a resource of several. `clock` and `io` must outlive
// it. `trial`: RecordedStart::trial.
base::Result<std::unique_ptr<vm::Recorder>> open_recorder(
    const tools::Options& options, const std::string& resource, const ir::VerifiedImage& image,
    base::ByteSpan retained, const vm::ControllerOptions& limits, vm::Clock& clock, vm::IoPort& io,
    base::ByteSpan trial = {});
// Controller::start(), recorded when `recorder` is one.
base::Result<std::unique_ptr<vm::Controller>> start_recorded(const ir::VerifiedImage& image,
                                                             const vm::ControllerOptions& limits,
                                                             vm::Clock& clock, vm::IoPort& io,
                                                             base::ByteSpan retained,
                                                             vm::Recorder* recorder);

}  // namespace stvm
