// Recordings with any content: read within their bytes, what is read is written as it was, and
// whatever a recording says of clock, devices and requests, it is played or refused.
//
// An input is the rest of a file behind a good header: records of {tag, length, payload}, whose
// checksums are put right here, so that the decoders behind them are reached. The header has the
// image of a program that fills every table, or, by the number of records, another one.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/check.h"
#include "base/crc32c.h"
#include "online_change/package/package.h"
#include "online_change/store/resumed_edits.h"
#include "online_change/store/retained_values.h"
#include "tests/fuzz/versions.h"
#include "tools/stvm/player.h"
#include "vm/runtime/recording.h"

namespace {

constexpr uint8_t kTags = 6;
constexpr uint64_t kFuel = 2000;

base::Bytes file_of(base::ByteSpan input, const vm::RecordedStart& start) {
  base::Bytes file = vm::encode_record(start);
  while (input.size() >= 2) {
    const size_t length = std::min<size_t>(input[1], input.size() - 2);
    base::ByteWriter record;
    record.u8(input[0] % kTags);
    record.blob(input.subspan(2, length));
    record.u32(base::crc32c(record.bytes()));
    file.insert(file.end(), record.bytes().begin(), record.bytes().end());
    input = input.subspan(2 + length);
  }
  return file;
}

void append(base::Bytes& file, const base::Bytes& record) {
  file.insert(file.end(), record.begin(), record.end());
}

void check_written(const vm::Recording& read) {
  base::Bytes again = vm::encode_record(read.start);
  for (const vm::RecordedCycle& cycle : read.cycles) append(again, vm::encode_record(cycle));
  for (const vm::RecordedRequest& row : read.requests) append(again, vm::encode_record(row));
  append(again, vm::encode_end());
  const base::Result<vm::Recording> same = vm::decode_recording(again);
  base::check(same.ok() && !same->cut_off, "what was read is written whole");
  base::check(same->cycles.size() == read.cycles.size(), "no cycle is lost");
  for (size_t i = 0; i < read.cycles.size(); ++i) {
    const vm::Observed& a = read.cycles[i].observed;
    const vm::Observed& b = same->cycles[i].observed;
    const bool devices =
        a.changed == b.changed && a.lost == b.lost && a.receptions.size() == b.receptions.size();
    base::check(a.clock == b.clock && devices, "what the cycle saw is the same");
  }
}

// What a controller has asked for.
class Listening : public vm::Replay {
 public:
  int64_t now_ns() override {
    reads.push_back(vm::Replay::now_ns());
    return reads.back();
  }
  std::vector<int64_t> reads;
};

// As a controller would have written it that saw all this: states and clock are put right.
void put_right(vm::Recording& recording, const ir::VerifiedImage& image) {
  Listening seen;
  vm::StateSum sum;
  vm::ControllerOptions options;
  options.fuel_slice = recording.start.fuel_slice;
  options.fuel_budget = recording.start.fuel_budget;
  options.on_trap = recording.start.on_trap;
  options.tier.tier = vm::Tier::kInterpreter;
  std::unique_ptr<vm::Controller> controller;
  for (vm::RecordedCycle& cycle : recording.cycles) {
    seen.see(cycle.observed);
    seen.reads.clear();
    if (controller == nullptr) {
      auto started = vm::Controller::start(image, options, seen, seen, recording.start.retained);
      if (!started.ok()) return;
      controller = *std::move(started);
    } else {
      controller->cycle();
    }
    cycle.observed.clock = seen.reads;
    cycle.state = sum.of(*controller);
  }
}

// Requests are for what runs, and come at the end, so that they are carried out.
void put_right(vm::RecordedRequest& recorded, const vm::Recording& recording,
               const base::Digest& running) {
  base::Result<vm::Request> request = vm::decode_request(recorded.bytes);
  if (!request.ok()) return;
  request->expected = running;
  recorded.bytes = vm::encode(*request);
  if (!recording.cycles.empty()) recorded.cycle = recording.cycles.back().number;
}

void play(vm::Recording recording) {
  stvm::Player player(std::move(recording));
  base::Status done = player.start();
  while (done.ok() && !player.at_end()) done = player.cycle();
  base::check(done.ok() || !done.error().text.empty(), "a reason");
}

// An edit on trial, as the recording of a controller begins that was started with one.
const base::Bytes& trial_of(const fuzz::Versions& pair) {
  static const base::Bytes trial = [&] {
    online_change::StoredEdit edit;
    edit.name = "E1";
    edit.from = pair.from.digest();
    edit.to = pair.to.digest();
    edit.package = online_change::encode(pair.package);
    edit.retained = online_change::initial_retained(pair.from.image());
    return online_change::encode_trial({{edit, pair.from}});
  }();
  return trial;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const base::ByteSpan input(data, size);
  if (vm::decode_recording(input).ok()) return 0;  // as it is
  const fuzz::Versions& pair = fuzz::versions(fuzz::kEveryTable);
  const bool on_trial = size % 4 == 0;
  const ir::VerifiedImage& image = on_trial ? pair.to : pair.from;
  vm::RecordedStart start;
  start.image = image.encoded();
  start.fuel_slice = size % 3;
  start.fuel_budget = size % 5 == 0 ? size % 7 : kFuel;
  start.code_limit = size % 13 == 0 ? 4096 : vm::ControllerOptions().code_limit;
  start.on_trap = static_cast<ir::OnTrap>(size % 4);
  if (on_trial) {
    start.trial = trial_of(pair);
    // One byte of it is another one.
    if (size > 2) start.trial[(data[0] | data[1] << 8) % start.trial.size()] ^= data[2] % 2;
  }
  base::Result<vm::Recording> read = vm::decode_recording(file_of(input, start));
  base::check(read.ok(), "the header is good");
  check_written(*read);
  if (read->cycles.empty() || size % 8 == 0) play(*read);
  if (read->cycles.empty()) return 0;
  put_right(*read, image);
  for (vm::RecordedRequest& row : read->requests) put_right(row, *read, image.digest());
  play(*std::move(read));
  return 0;
}
