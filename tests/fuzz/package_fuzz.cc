// Change packages that somebody has tampered with and hashed anew: the controller refuses them and
// runs on as it was, or it changes, runs, goes back and runs, and nobody touches memory that the
// two versions do not declare.
//
// An input is a script: a byte that names the pair of versions, one for form, strategy and what is
// mapped, then 7 bytes {part, what, where, value, how} for each change to the good package of the
// pair. The pairs are versions 1 and 2 of golden files.
#include <sys/mman.h>

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "base/hash.h"
#include "ir/bytecode/symbols.h"
#include "online_change/apply/change.h"
#include "online_change/package/stored_step.h"
#include "tests/fuzz/image_changes.h"
#include "tests/fuzz/versions.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace {

using namespace online_change;
using fuzz::alter;
using fuzz::pick;
using fuzz::Versions;

constexpr size_t kStep = 7;
constexpr size_t kMostSteps = 8;
constexpr uint64_t kMostData = uint64_t{16} << 20;  // of versions that declare more none is run

// --- changes to a package -------------------------------------------------------------

// What a package with other bytes says, unless it cannot be read then.
void change_step(UpdateStep& changed, const fuzz::Change& change) {
  StoredStep step = stored(changed);
  base::Bytes bytes = changed.bytes() == nullptr ? base::Bytes() : *changed.bytes();
  uint32_t* const numbers[] = {
      &step.from,        &step.to,        &step.size,           &step.count,
      &step.from_stride, &step.to_stride, &step.old_type.index, &step.new_type.index,
      &step.fate};
  switch (change.how / 4 % 16) {
    case 0:
      step.kind = static_cast<StepKind>(change.value % 6);
      break;
    case 1:
      step.early = !step.early;
      break;
    case 2:
      bytes.resize(change.value % 32);
      break;
    case 3:
      if (uint8_t* byte = pick(bytes, change.where / 16)) alter(*byte, change);
      break;
    default:
      alter(*numbers[change.how / 4 % std::size(numbers)], change);
  }
  if (auto read = from_stored(step, std::move(bytes))) changed = std::move(*read);
}

// One that is like others, but nobody asked for.
UpdateStep made_step(const Plan& plan, const fuzz::Change& change) {
  UpdateStep like;
  if (!plan.steps.empty()) like = plan.steps[change.where % plan.steps.size()];
  StoredStep step = stored(like);
  step.kind = static_cast<StepKind>(change.how / 4 % 6);
  // Among the others, in holes and slack too.
  const uint32_t last = plan.steps.empty() ? 1024 : plan.steps.back().to + 64;
  step.to = change.value % last / 4 * 4;
  step.early = false;
  if (step.kind == StepKind::kMigrate || step.kind == StepKind::kGather) step.from = 0;
  const bool initial = step.kind == StepKind::kInitialise && like.bytes() != nullptr;
  return *from_stored(step, initial ? *like.bytes() : base::Bytes());
}

void change_list(Plan& plan, const fuzz::Change& change) {
  UpdateStep* const step = pick(plan.steps, change.where);
  switch (change.how % 4) {
    case 0:
      plan.steps.push_back(made_step(plan, change));
      return;
    case 1:
      if (step != nullptr) plan.steps.push_back(UpdateStep(*step));
      return;
    case 2:
      if (step != nullptr) std::swap(*step, plan.steps[change.value % plan.steps.size()]);
      return;
    default:
      if (step != nullptr) plan.steps.erase(plan.steps.begin() + (step - plan.steps.data()));
  }
}

void change_call(Plan& plan, const fuzz::Change& change) {
  MigrationCall* const call = pick(plan.calls, change.where);
  if (call == nullptr) {
    plan.calls.push_back({change.where, change.value, 0, {}, {}});
    return;
  }
  MigrationInput* const input = pick(call->inputs, change.where / 16);
  switch (change.how / 4 % 8) {
    case 0:
      return alter(call->row, change);
    case 1:
      return alter(call->instance, change);
    case 2:
      return alter(call->place, change);
    case 3:
      return alter(call->type.index, change);
    case 4:
      if (input != nullptr) alter(input->from, change);
      return;
    case 5:
      if (input != nullptr) alter(input->type.index, change);
      return;
    case 6:
      if (input != nullptr) alter(input->slot, change);
      return;
    default:
      plan.calls.push_back(MigrationCall(*call));
  }
}

void change_report(Plan& plan, const fuzz::Change& change) {
  FateRow* const row = pick(plan.fates, change.where);
  switch (change.how / 4 % 6) {
    case 0:
      return alter(plan.boundary_bytes, change);
    case 1:
      return alter(plan.predicted_pause_ns, change);
    case 2:
      return alter(plan.counts.dropped, change);
    case 3:
      if (row != nullptr) plan.fates.erase(plan.fates.begin() + (row - plan.fates.data()));
      return;
    case 4:
      if (row != nullptr) row->path.resize(change.value % 64, 'x');
      return;
    default:
      if (row != nullptr) row->fate = static_cast<Fate>(change.value % 5);
  }
}

void change_image(base::Bytes& encoded, const fuzz::Change& change) {
  base::Result<ir::Image> image = ir::decode(encoded);
  if (!image.ok()) return;
  fuzz::apply(*image, change);
  encoded = ir::encode(*image);
}

// Of the encoded form: magic and version, then of three parts length and SHA-256; the parts.
constexpr size_t kPartRow = 4 + 32;
constexpr size_t kHeader = 8 + 3 * kPartRow;

void change_bytes(base::Bytes& bytes, const fuzz::Change& change) {
  size_t begin = kHeader;
  uint8_t* row = bytes.data() + 8;
  uint32_t length = 0;
  for (int part = change.what % 3;; --part, row += kPartRow, begin += length) {
    std::memcpy(&length, row, sizeof length);
    if (part == 0) break;
  }
  const size_t row_at = static_cast<size_t>(row - bytes.data());
  const size_t at = begin + (length == 0 ? 0 : change.where % length);
  if (change.how / 4 % 8 == 0) {  // cut out, or put in
    const size_t count = std::min<size_t>(change.value % 16, begin + length - at);
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    if (change.how % 2 == 0) {
      bytes.erase(from, from + static_cast<std::ptrdiff_t>(count));
      length -= static_cast<uint32_t>(count);
    } else {
      bytes.insert(from, count, static_cast<uint8_t>(change.value >> 8));
      length += static_cast<uint32_t>(count);
    }
  } else if (length != 0) {
    alter(bytes[at], change);
  }
  std::memcpy(bytes.data() + row_at, &length, sizeof length);
  const base::Digest digest = base::sha256(base::ByteSpan(bytes).subspan(begin, length));
  std::memcpy(bytes.data() + row_at + 4, digest.data(), digest.size());
}

// True: the change is one of bytes, which come last.
bool apply(Package& package, uint8_t part, const fuzz::Change& change) {
  Plan& plan = (part & 0x10) != 0 ? package.inverse : package.forward;
  switch (part % 8) {
    case 0:
    case 1:
    case 2:
      if (UpdateStep* step = pick(plan.steps, change.where)) change_step(*step, change);
      return false;
    case 3:
      change_list(plan, change);
      return false;
    case 4:
      change_call(plan, change);
      return false;
    case 5:
      change_report(plan, change);
      return false;
    case 6:
      change_image(package.image, change);
      return false;
    default:
      return true;
  }
}

base::Bytes scripted(const Versions& pair, bool short_form, const uint8_t* data, size_t size) {
  Package package = pair.package;
  std::vector<fuzz::Change> of_bytes;
  for (size_t at = 0; at + kStep <= size && at < kStep * kMostSteps; at += kStep) {
    fuzz::Change change{data[at + 1], 0, 0, data[at + 6]};
    std::memcpy(&change.where, data + at + 2, 2);
    std::memcpy(&change.value, data + at + 4, 2);
    if (apply(package, data[at], change)) of_bytes.push_back(change);
  }
  base::Bytes bytes = short_form ? encode_short(package, pair.from.encoded()) : encode(package);
  for (const fuzz::Change& change : of_bytes) change_bytes(bytes, change);
  return bytes;
}

// --- the controller ---------------------------------------------------------------------

base::Digest hash(vm::Controller& controller) {
  return ir::state_hash(controller.image(), controller.memory().view());
}

void run(vm::Controller& controller) {
  for (int i = 0; i < 4; ++i) controller.cycle();
  base::check(!ir::state_text(controller.image(), controller.memory().view()).empty(),
              "values can be shown");
}

bool refused(const base::Error& error) {
  base::check(!error.text.empty() || error.refusal == base::Refusal::kNoMemory, "a reason");
  base::check(error.refusal != base::Refusal::kInternal,
              "a reason that one can do something about");
  return false;
}

// True: it is on trial.
bool change_to(vm::Controller& controller, Change& change, base::ByteSpan package,
               Strategy strategy) {
  base::Status status = change.stage(package, strategy);
  if (!status.ok()) return refused(status.error());
  if (change.next()->image().data_capacity > kMostData) return false;
  for (const LiveLoss& loss : change.live_losses()) {
    base::check(!loss.what.empty(), "what is lost says how");
  }
  status = change.arm(true, true);
  if (!status.ok()) return refused(status.error());
  base::Result<SwitchReport> report = change.switch_now();
  if (!report.ok()) return refused(report.error());
  base::check(controller.at_boundary(), "the switch is at a boundary");
  return true;
}

// Only pages of what the versions declare may ever have been touched.
void check_untouched(vm::Memory& memory, uint64_t begin, uint64_t end) {
  constexpr uint64_t kPage = 4096;
  constexpr uint64_t kChunk = uint64_t{1} << 28;
  static std::vector<unsigned char> resident(kChunk / kPage);
  for (uint64_t at = (begin + kPage - 1) / kPage * kPage; at < end; at += kChunk) {
    const uint64_t pages = (std::min(kChunk, end - at) + kPage - 1) / kPage;
    base::check(mincore(memory.data() + at, pages * kPage, resident.data()) == 0, "mincore");
    base::check(std::memchr(resident.data(), 1, pages) == nullptr,
                "memory outside of what the versions declare is untouched");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  const Versions& pair = fuzz::versions(data[0]);
  const bool short_form = (data[1] & 1) != 0;
  const Strategy strategy = (data[1] & 2) != 0 ? Strategy::kStandby : Strategy::kInPlace;
  const base::Bytes bytes = scripted(pair, short_form, data + 2, size - 2);
  vm::VirtualClock clock;
  vm::SimulatedIo io;
  vm::ControllerOptions options;
  options.fuel_budget = 2000;
  options.tier.tier = vm::Tier::kInterpreter;
  auto controller = vm::Controller::start(pair.from, options, clock, io);
  base::check(controller.ok(), "the controller starts");
  run(**controller);
  const base::Digest before = hash(**controller);
  Change change(**controller);
  uint64_t most_data = pair.from.image().data_capacity;
  const bool changed = change_to(**controller, change, bytes, strategy);
  base::check(changed || size >= 2 + kStep, "the package is good as it was made");
  if (changed) {
    most_data = std::max<uint64_t>(most_data, (*controller)->image().data_capacity);
    run(**controller);
    const base::Result<SwitchReport> undone = change.undo();
    if (!undone.ok()) refused(undone.error());
  } else {
    change.cancel();
    base::check(hash(**controller) == before, "a refused package changes nothing");
  }
  run(**controller);
  static uint64_t count = 0;
  if (changed && strategy == Strategy::kInPlace && ++count % 16 == 1) {
    check_untouched((*controller)->memory(), most_data, ir::kConstPoolA);
    check_untouched((*controller)->memory(), uint64_t{ir::kStackBegin} + ir::kStackLimit,
                    uint64_t{1} << 32);
  }
  return 0;
}
