#include "online_change/apply/migrator.h"

#include <cstring>

#include "base/limits.h"
#include "online_change/diff/value_conversion.h"
#include "online_change/plan/migration_calls.h"

namespace online_change {
namespace {

// What looking at a call costs beside its bytes.
constexpr size_t kGatherCallBytes = 64;

}  // namespace

Migrator::Migrator(Plan& plan, const ir::Image& from, const ir::Image& to,
                   const vm::Generation& code, vm::Memory scratch)
    : plan_(plan),
      to_(to),
      code_(&code),
      conversions_(from, code.image()),
      scratch_(std::move(scratch)),
      execution_(base::kMaxCallDepth, 0, code.try_depth()),
      calls_(plan.calls.size()) {
  code_->write_pool(scratch_.data());
  size_t bytes = 0;
  for (size_t i = 0; i < calls_.size(); ++i) {
    const MigrationCall& call = plan_.calls[i];
    calls_[i].first_byte = bytes;
    for (const MigrationInput& input : call.inputs) {
      calls_[i].inputs.push_back(input_of(input, code_of(call), from));
      bytes += calls_[i].inputs.back().size;
    }
  }
  bytes_.resize(bytes);
  for (uint32_t i = 0; i < plan_.steps.size(); ++i) {
    auto* const value = plan_.steps[i].as<GivenValue>();
    if (value == nullptr) continue;
    calls_[value->call].outputs.push_back({i, value->slot});
    value->made.reserve(plan_.steps[i].size);  // filled where nothing is allocated: at the boundary
  }
}

Migrator::Input Migrator::input_of(const MigrationInput& input, const ir::LinkedPou& pou,
                                   const ir::Image& from) const {
  Input out;
  out.from = input.from;
  out.size = from.layouts[input.type].size;
  out.slot = input.slot;
  for (const ir::FrameSlot& slot : pou.slots) {
    if (slot.kind != ir::SlotKind::kParam || slot.offset != input.slot) continue;
    const ir::Image& image = code_->image();
    out.slot_size = image.layouts[slot.region.type].size;
    out.converts =
        classify(from.types, input.type, image.types, slot.region.type) == Conversion::kExact;
    out.conversion.old_type = input.type;
    out.conversion.new_type = slot.region.type;
  }
  return out;
}

base::Result<std::unique_ptr<Migrator>> Migrator::make(Plan& plan, const ir::Image& from,
                                                       const ir::Image& to,
                                                       const vm::Generation& code) {
  if (plan.calls.empty()) return std::unique_ptr<Migrator>();
  base::Result<vm::Memory> scratch = vm::Memory::reserve();
  if (!scratch.ok()) return scratch.error();
  return std::make_unique<Migrator>(plan, from, to, code, std::move(*scratch));
}

const ir::LinkedPou& Migrator::code_of(const MigrationCall& call) const {
  return code_->image().pous[code_->image().migrations[call.row].pou];
}

size_t Migrator::gather_call(size_t number, const uint8_t* memory) {
  Call& call = calls_[number];
  uint8_t* const begin = bytes_.data() + call.first_byte;
  uint8_t* at = begin;
  for (const Input& input : call.inputs) {
    if (std::memcmp(at, memory + input.from, input.size) != 0) {
      call.done = false;
      std::memcpy(at, memory + input.from, input.size);
    }
    at += input.size;
  }
  return static_cast<size_t>(at - begin);
}

size_t Migrator::gather(size_t first, size_t most_bytes, const uint8_t* memory) {
  for (size_t bytes = 0; first < calls_.size() && bytes < most_bytes; ++first) {
    bytes += gather_call(first, memory) + kGatherCallBytes;
  }
  return first;
}

void Migrator::run_by(const vm::Generation& code) {
  code_ = &code;
  code_->write_pool(scratch_.data());
}

void Migrator::note(const uint8_t* memory) {
  gather(0, SIZE_MAX, memory);
  for (Call& call : calls_) call.done = true;
}

base::Status Migrator::run(const uint8_t* memory) {
  gather(0, SIZE_MAX, memory);
  return run_gathered();
}

base::Status Migrator::run_gathered(const Failed& failed) {
  fuel_ = 0;
  for (size_t i = 0; i < calls_.size(); ++i) {
    if (calls_[i].done) continue;
    base::Status status = run_call(i);
    calls_[i].done = status.ok();
    if (status.ok()) continue;
    if (!failed) return status;
    failed(status.error());
  }
  most_fuel_ = std::max(most_fuel_, fuel_);
  return base::Ok{};
}

base::Error Migrator::failed(const MigrationCall& call, const std::string& why) const {
  return {base::Refusal::kMigrationFailed,
          "`" + code_of(call).name + "` for " + place_of(call, to_) + ": " + why};
}

base::Status Migrator::run_call(size_t number) {
  const MigrationCall& call = plan_.calls[number];
  if (fuel_ > kMigrationsFuel) return failed(call, "no time is left after those before it");
  const uint32_t pou = code_->image().migrations[call.row].pou;
  uint8_t* frame = scratch_.data() + ir::kStackBegin;
  std::memset(frame, 0, code_->image().pous[pou].frame_size);
  const uint8_t* from = bytes_.data() + calls_[number].first_byte;
  for (const Input& input : calls_[number].inputs) {
    if (input.converts) {
      conversions_.convert(input.conversion, 0, from, 0, {frame + input.slot, input.slot_size});
    } else {
      std::memcpy(frame + input.slot, from, input.size);
      code_->bools().normalise(input.conversion.new_type, frame + input.slot);
    }
    from += input.size;
  }
  execution_.call(*code_, scratch_.data(), pou, ir::kStackBegin);
  const vm::Exit exit = execution_.run(kMigrationFuel);
  fuel_ += execution_.fuel_used() + 1;
  if (exit == vm::Exit::kSuspended || fuel_ > kMigrationsFuel) {
    const vm::TrapText text =
        vm::describe(code_->image(), execution_.interrupted(ir::TrapKind::kFuel));
    return failed(
        call, "line " + std::to_string(text.line) + ": it does not end within " +
                  std::to_string(exit == vm::Exit::kSuspended ? kMigrationFuel : kMigrationsFuel) +
                  " loops and calls");
  }
  if (exit == vm::Exit::kTrap) {
    const vm::TrapText text = vm::describe(code_->image(), execution_.trap());
    return failed(call,
                  "`" + text.pou + "` in line " + std::to_string(text.line) + ": " + text.text);
  }
  for (const Output& output : calls_[number].outputs) {
    UpdateStep& step = plan_.steps[output.step];
    step.as<GivenValue>()->made.assign(frame + output.at, frame + output.at + step.size);
  }
  return base::Ok{};
}

}  // namespace online_change
