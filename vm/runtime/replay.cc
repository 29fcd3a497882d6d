#include "vm/runtime/replay.h"

#include <algorithm>

#include "vm/runtime/process_image.h"
#include "vm/runtime/shared_globals.h"

namespace vm {

int64_t Replay::now_ns() {
  if (at_ == clock_.size()) {
    asked_too_often_ = true;
    return last_ns_;
  }
  last_ns_ = clock_[at_++];
  return last_ns_;
}

void Replay::receive(std::span<uint8_t> inputs) {
  take_reception();
  if (inputs_.size() < inputs.size()) inputs_.resize(inputs.size());
  std::copy_n(inputs_.begin(), inputs.size(), inputs.begin());
}

// The next one that was recorded.
void Replay::take_reception() {
  if (received_ == receptions_.size()) return;
  const RecordedReception begin = received_ == 0 ? RecordedReception{} : receptions_[received_ - 1];
  const RecordedReception& end = receptions_[received_++];
  for (uint32_t i = begin.changed; i < end.changed; ++i) {
    const auto& [offset, value] = changed_[i];
    if (offset >= inputs_.size()) inputs_.resize(size_t{offset} + 1);
    inputs_[offset] = value;
  }
}

namespace {

void change(base::Bytes& bytes, ByteChanges& changes) {
  for (const auto& [offset, value] : changes) {
    if (offset < bytes.size()) bytes[offset] = value;
  }
  changes.clear();
}

}  // namespace

void Replay::lost_tasks(std::span<uint8_t> tasks) {
  if (received_ == 0) return;
  const uint32_t begin = received_ == 1 ? 0 : receptions_[received_ - 2].lost;
  for (uint32_t i = begin; i < receptions_[received_ - 1].lost; ++i) {
    const auto& [task, byte] = lost_[i];
    if (task < tasks.size()) tasks[task] = byte;
  }
}

void Replay::take_globals(const SharedGlobals& globals, uint8_t* memory) {
  if (globals_.empty()) return;
  base::Bytes bytes(globals.read_bytes());
  globals.gather_read(memory, bytes);
  change(bytes, globals_);
  globals.scatter_read(bytes, memory);
}

void Replay::at_boundary(const ProcessImage& image, uint8_t* memory) {
  if (!outputs_.empty()) {
    base::Bytes bytes(image.output_bytes());
    image.variables_to_outputs(memory, bytes);
    change(bytes, outputs_);
    image.outputs_to_variables(bytes, memory);
  }
  if (!markers_.empty()) {
    base::Bytes bytes(image.marker_bytes());
    image.variables_to_markers(memory, bytes);
    change(bytes, markers_);
    image.markers_to_variables(bytes, memory);
  }
}

void Replay::see(const Observed& observed) {
  see(observed.clock);
  outputs_ = observed.outputs;
  markers_ = observed.markers;
  globals_ = observed.globals;
  lost_ = observed.lost;
  changed_ = observed.changed;
  receptions_ = observed.receptions;
  received_ = 0;
}

void Replay::see(const std::vector<int64_t>& clock) {
  clock_ = clock;
  at_ = 0;
  asked_too_often_ = false;
}

}  // namespace vm
