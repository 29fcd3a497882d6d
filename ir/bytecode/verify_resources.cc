#include <algorithm>
#include <numeric>

#include "base/limits.h"
#include "ir/bytecode/device_tasks.h"
#include "ir/bytecode/located_layouts.h"
#include "ir/bytecode/verify_parts.h"
#include "ir/types/location.h"
#include "ir/types/longest_time.h"
#include "ir/types/plain_data.h"

namespace ir::verification {
namespace {

class ResourcesVerifier {
 public:
  ResourcesVerifier(const Context& context, const std::vector<uint32_t>& areas)
      : context_(context), image_(context.image), areas_(areas) {}

  base::Status run() {
    if (base::Status s = check_tasks(); !s) return s;
    const Layouts natural = located_layouts(image_);
    for (uint32_t i = 0; i < image_.io.size(); ++i) {
      if (base::Status s = check_binding(natural, i); !s) return s;
    }
    if (base::Status s = check_devices(); !s) return s;
    if (base::Status s = check_safe_outputs(); !s) return s;
    if (base::Status s = check_shared(); !s) return s;
    for (uint32_t i = 0; i < image_.retain.size(); ++i) {
      const RetainRange& range = image_.retain[i];
      if (inside_one_area(range.data, range.size)) continue;
      return refuse(Refusal::kBadRetain, "retain range " + std::to_string(i) + ": " +
                                             std::to_string(range.size) + " bytes at " +
                                             std::to_string(range.data) + " lie in no area");
    }
    return base::Ok{};
  }

 private:
  base::Status check_tasks() const {
    std::vector<bool> taken(image_.instances.size());
    const bool nothing = image_.pous.empty() && image_.instances.size() == 1;  // no_program.h
    if (image_.tasks.empty() && !nothing) return refuse(Refusal::kBadTask, "there is no task");
    int64_t base_cycle = 0;
    for (const ImageTask& task : image_.tasks) {
      base_cycle = std::gcd(base_cycle, std::max<int64_t>(task.period_ns, 0));
    }
    if (base_cycle != 0 && base_cycle < static_cast<int64_t>(base::kMinBaseCycleNs)) {
      return refuse(Refusal::kBadTask,
                    "the control cycle has " + std::to_string(base_cycle) + " ns");
    }
    for (const ImageTask& task : image_.tasks) {
      const auto bad = [&](const std::string& why) {
        return refuse(Refusal::kBadTask, "task `" + task.name + "`: " + why);
      };
      const bool free = task.policy.freewheeling;
      const bool period = task.once || free
                              ? task.period_ns == 0 && task.event == 0 && !(task.once && free)
                              : task.period_ns > 0 || (task.period_ns == 0 && task.event != 0);
      const bool periodic = task.period_ns != 0 && task.event == 0;
      const PolicyConflict* conflict = policy_conflict(task.policy, periodic);
      if (conflict != nullptr) return bad(std::string(conflict->text));
      if (!period) return bad("period of " + std::to_string(task.period_ns) + " ns");
      if (task.event != 0 && !is_event(task.event)) return bad("its event is no BOOL global");
      if (task.period_ns > kLongestTimeNs) return bad("a period of more than a year");
      if (task.watchdog_ns <= 0) {
        return bad("watchdog of " + std::to_string(task.watchdog_ns) + " ns");
      }
      for (uint32_t id : task.programs) {
        const bool live = id != 0 && id < image_.instances.size() && image_.instances[id].live;
        if (!live || !image_.types.is_instance(image_.instances[id].type)) {
          return bad("instance " + std::to_string(id) + " is no program");
        }
        if (taken[id]) return bad("program `" + image_.instances[id].name + "` runs twice");
        taken[id] = true;
      }
    }
    return base::Ok{};
  }

  base::Status check_devices() const {
    const ProcessImageSize size{image_.input_bytes, image_.output_bytes};
    std::optional<DeviceFault> fault = find_fault(image_.devices, &size);
    if (!fault) fault = find_task_fault(image_);
    if (!fault) return base::Ok{};
    return refuse(Refusal::kBadDevice,
                  "device `" + image_.devices[fault->device].name + "`: " + fault->text);
  }

  bool is_event(uint32_t data) const {
    const Type& globals = image_.types[image_.globals];
    const auto& layout = image_.layouts[image_.globals];
    for (size_t i = 0; i < globals.members.size(); ++i) {
      if (image_.instances[0].data + layout.member_offsets[i] != data) continue;
      if (image_.types.root_kind(globals.members[i].type) == Kind::kBool) return true;
    }
    return false;
  }

  // The instance whose area holds the bytes; kNone.
  uint32_t area_of(uint32_t data, uint64_t size) const {
    auto behind =
        std::upper_bound(areas_.begin(), areas_.end(), data,
                         [&](uint32_t at, uint32_t id) { return at < image_.instances[id].data; });
    for (; behind != areas_.begin(); --behind) {  // areas without bytes may share an offset
      const Instance& row = image_.instances[*(behind - 1)];
      const uint64_t end = uint64_t{row.data} + image_.layouts[row.type].area_capacity;
      if (uint64_t{data} + size <= end) return *(behind - 1);
      if (row.data != end) break;
    }
    return kNone;
  }
  bool inside_one_area(uint32_t data, uint64_t size) const { return area_of(data, size) != kNone; }

  base::Status check_binding(const Layouts& natural, uint32_t number) const {
    const IoBinding& io = image_.io[number];
    const auto bad = [&](const std::string& why) {
      return refuse(Refusal::kBadIoAccess, "I/O binding " + std::to_string(number) + ": " + why);
    };
    if (!image_.types.contains(io.type)) return bad("no such type");
    const uint32_t area = area_of(io.data, image_.layouts[io.type].size);
    if (area == kNone) return bad("its variable at " + std::to_string(io.data) + " does not exist");
    const Instance& row = image_.instances[area];
    const auto flags = context_.regions.find({row.type, 0}, io.data - row.data, Region{io.type, 0});
    if (!flags) return bad("there is no " + image_.types.text(io.type) + " at its variable");
    if (io.address.area == DirectArea::kNone) return bad("no address");
    if (io.address.area == DirectArea::kMarker) return base::Ok{};
    const bool input = io.address.area == DirectArea::kInput;
    if (input ? !flags->input : !flags->output) return bad("its variable is not located there");
    if (!is_locatable(image_.types, io.type)) return bad("devices cannot exchange its type");
    const uint64_t bits = located_bits(image_.types, natural, io.type, io.address);
    const uint64_t end = (io.address.bit_offset + bits + 7) / 8;
    const uint32_t limit = input ? image_.input_bytes : image_.output_bytes;
    if (end > limit) {
      return bad("ends at byte " + std::to_string(end) + " of " + std::to_string(limit));
    }
    return base::Ok{};
  }

  base::Status check_safe_outputs() const {
    uint64_t end = 0;
    for (const SafeOutput& row : image_.safe) {
      const bool bytes = row.bits % 8 == 0 && row.bits <= 64 && row.bit_offset % 8 == 0;
      const bool width = row.bits != 0 && (row.bits == 1 || bytes);
      const bool sane = width && (row.bits == 64 || row.value >> row.bits == 0) &&
                        row.hold_ns >= 0 && row.hold_ns <= kLongestTimeNs;
      const bool placed = row.bit_offset >= end &&
                          uint64_t{row.bit_offset} + row.bits <= uint64_t{image_.output_bytes} * 8;
      end = uint64_t{row.bit_offset} + row.bits;
      if (sane && placed) continue;
      return refuse(Refusal::kBadIoAccess, "the safe value at bit " +
                                               std::to_string(row.bit_offset) +
                                               " of the outputs does not fit there");
    }
    return base::Ok{};
  }

  base::Status check_shared() const {
    const std::vector<Member>& members = image_.types[image_.globals].members;
    uint64_t least = 0;
    for (const SharedGlobal& row : image_.shared) {
      const bool there = row.member >= least && row.member < members.size();
      least = uint64_t{row.member} + 1;
      if (there) {
        const Member& member = members[row.member];
        const bool variable = member.section != Section::kStamp && !member.constant &&
                              member.address.area == DirectArea::kNone;
        if (variable && is_plain_data(image_.types, member.type)) continue;
      }
      return refuse(Refusal::kBadSharedGlobal, "global number " + std::to_string(row.member));
    }
    return base::Ok{};
  }

  const Context& context_;
  const Image& image_;
  const std::vector<uint32_t>& areas_;
};

}  // namespace

// In order, disjoint and inside data memory: what follows looks initial bytes up.
base::Status verify_initial_data(const Image& image) {
  uint64_t end = kDataBegin;
  for (const DataRun& run : image.data) {
    const uint64_t behind = uint64_t{run.offset} + run.bytes.size();
    if (run.offset < end || behind > image.data_capacity) {
      return refuse(Refusal::kBadFormat, "initial data at " + std::to_string(run.offset) + ".." +
                                             std::to_string(behind) +
                                             " is out of order or outside data memory");
    }
    end = behind;
  }
  return base::Ok{};
}

std::vector<uint32_t> areas_in_order(const Image& image) {
  std::vector<uint32_t> areas;
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    if (id == 0 || image.instances[id].live) areas.push_back(id);
  }
  std::sort(areas.begin(), areas.end(), [&](uint32_t a, uint32_t b) {
    return image.instances[a].data < image.instances[b].data;
  });
  return areas;
}

base::Status verify_resources(const Context& context, const std::vector<uint32_t>& areas) {
  return ResourcesVerifier(context, areas).run();
}

}  // namespace ir::verification
