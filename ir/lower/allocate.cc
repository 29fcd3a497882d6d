#include "ir/lower/allocate.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

namespace ir::codegen {
namespace {

// In half steps: an instruction reads at an even one and writes at the odd one
// after it, so that its result may take the slot of an operand that ends there.
struct Interval {
  uint32_t reg = 0;
  uint64_t first = ~uint64_t{0};
  uint64_t last = 0;

  void cover(uint64_t position) {
    first = std::min(first, position);
    last = std::max(last, position);
  }
};

std::vector<Interval> intervals_of(const Machine& machine, const Liveness& liveness) {
  std::vector<Interval> intervals(machine.registers.size());
  for (uint32_t r = 0; r < intervals.size(); ++r) intervals[r].reg = r;
  uint64_t at = 0;
  for (size_t b = 0; b < machine.blocks.size(); ++b) {
    const MachineBlock& block = machine.blocks[b];
    liveness.live_in[b].for_each([&](uint32_t i) { intervals[liveness.registers[i]].cover(at); });
    for (const MachineInst& inst : block.insts) {
      at += 2;
      for_each_register(inst, [&](uint32_t r, bool reads, bool writes) {
        if (reads) intervals[r].cover(at);
        if (writes) intervals[r].cover(at + 1);
      });
    }
    at += 2;
    if (block.end.condition.is_register()) intervals[block.end.condition.index].cover(at);
    liveness.live_out[b].for_each(
        [&](uint32_t i) { intervals[liveness.registers[i]].cover(at + 1); });
    at += 2;
  }
  return intervals;
}

using SlotKey = std::tuple<Class, uint32_t, uint8_t>;
using FreeAt = std::pair<uint64_t, uint32_t>;  // last use, slot
using SlotQueue = std::priority_queue<FreeAt, std::vector<FreeAt>, std::greater<>>;

uint32_t add_temporary(Object& object, const Register& reg) {
  Slot slot;
  slot.kind = SlotKind::kTemp;
  slot.cls = reg.cls;
  slot.region = reg.region;
  object.slots.push_back(std::move(slot));
  return static_cast<uint32_t>(object.slots.size() - 1);
}

}  // namespace

void allocate(Machine& machine, const Liveness& liveness, Object& object) {
  std::vector<Interval> intervals = intervals_of(machine, liveness);
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const Interval& a, const Interval& b) { return a.first < b.first; });
  std::map<SlotKey, SlotQueue> queues;
  for (const Interval& interval : intervals) {
    Register& reg = machine.registers[interval.reg];
    if (reg.slot != kNoNumber || interval.first > interval.last) continue;
    SlotQueue& queue = queues[{reg.cls, reg.region.type.index, reg.region.dim}];
    if (!queue.empty() && queue.top().first < interval.first) {
      reg.slot = queue.top().second;
      queue.pop();
    } else {
      reg.slot = add_temporary(object, reg);
    }
    queue.emplace(interval.last, reg.slot);
  }
}

}  // namespace ir::codegen
