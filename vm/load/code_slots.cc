#include "vm/load/code_slots.h"

#include <algorithm>
#include <cstring>

#include "base/limits.h"

namespace vm {
namespace {

constexpr uint64_t kLeastSlack = 16;  // units: a line or two in a small POU

uint64_t capacity_for(uint64_t units, uint64_t slack_percent) {
  return units + units * slack_percent / 100 + kLeastSlack;
}

std::string bytes_text(uint64_t units) { return std::to_string(units * sizeof(ir::Unit)); }

}  // namespace

SlotLabel::Start SlotLabel::start_of(const base::Digest& digest) {
  Start out;
  std::copy_n(digest.begin(), out.size(), out.begin());
  return out;
}

base::Digest SlotLabel::digest_of(const Start& start) {
  base::Digest out{};
  std::copy(start.begin(), start.end(), out.begin());
  return out;
}

base::Status CodeSlots::make_room(Slot& slot, const std::string& name, uint64_t size) {
  if (size <= slot.capacity) return base::Ok{};
  const uint64_t capacity = capacity_for(size, slack_percent_);
  const uint64_t others = total_units_ - slot.capacity;
  if (others + capacity > limit_units_) {
    return base::Error{base::Refusal::kTooLarge,
                       "`" + name + "` needs a code slot of " + bytes_text(capacity) +
                           " bytes; the other slots take " + bytes_text(others) +
                           " of the controller's " + bytes_text(limit_units_) + " bytes, " +
                           bytes_text(others + capacity - limit_units_) + " too few are free"};
  }
  slot.units = std::make_unique<ir::Unit[]>(capacity);
  slot.capacity = static_cast<uint32_t>(capacity);
  slot.used = 0;
  total_units_ = others + capacity;
  return base::Ok{};
}

base::Result<const ir::Unit*> CodeSlots::place(uint32_t number, const std::string& name,
                                               std::span<const ir::Unit> code,
                                               const ir::Unit* running, const SlotLabel& label) {
  if (number >= pairs_.size()) pairs_.resize(size_t{number} + 1);
  Pair& pair = pairs_[number];
  const bool second_runs = running != nullptr && running == pair.slots[1].units.get();
  const Slot& current = pair.slots[second_runs ? 1 : 0];
  if (running != nullptr && current.used == code.size() &&
      std::memcmp(running, code.data(), code.size_bytes()) == 0) {
    return running;
  }
  Slot& unused = pair.slots[running == nullptr || second_runs ? 0 : 1];
  base::Status room = make_room(unused, name, code.size());
  if (!room.ok()) return room.error();
  std::copy(code.begin(), code.end(), unused.units.get());
  unused.used = static_cast<uint32_t>(code.size());
  unused.label = label;
  ++written_;
  return unused.units.get();
}

CodeSlots::View CodeSlots::view(uint32_t number, const ir::Unit* running) const {
  if (number >= pairs_.size()) return {};
  const Pair& pair = pairs_[number];
  const bool second_runs = running != nullptr && running == pair.slots[1].units.get();
  const Slot& other = pair.slots[second_runs ? 0 : 1];
  View out{static_cast<uint8_t>(second_runs ? 1 : 0), std::nullopt};
  if (other.used != 0) out.other = other.label;
  return out;
}

void CodeSlots::keep_first(uint32_t count) {
  for (size_t number = count; number < pairs_.size(); ++number) {
    for (const Slot& slot : pairs_[number].slots) total_units_ -= slot.capacity;
  }
  if (count < pairs_.size()) pairs_.resize(count);
}

}  // namespace vm
