#include "linker/data.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/device_tasks.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"
#include "ir/types/shared_bytes.h"

namespace linker {
namespace {

constexpr size_t kZeroGap = 16;  // a shorter run of zeros stays inside a data run

void store_id(uint32_t id, uint8_t* slot) {
  for (uint32_t i = 0; i < 4; ++i) slot[i] = static_cast<uint8_t>(id >> (8 * i));
}

// The parts of an area that are not zero.
void add_runs(uint32_t offset, const base::Bytes& bytes, std::vector<ir::DataRun>& runs) {
  size_t at = 0;
  while (at < bytes.size()) {
    if (bytes[at] == 0) {
      ++at;
      continue;
    }
    size_t end = at;
    for (size_t i = at; i < bytes.size() && i < end + kZeroGap; ++i) {
      if (bytes[i] != 0) end = i + 1;
    }
    runs.push_back({offset + static_cast<uint32_t>(at),
                    base::Bytes(bytes.begin() + static_cast<ptrdiff_t>(at),
                                bytes.begin() + static_cast<ptrdiff_t>(end))});
    at = end;
  }
}

class DataTables {
 public:
  DataTables(ir::Image& image, const std::vector<InstanceNode>& nodes)
      : image_(image),
        nodes_(nodes),
        initial_(image.types, image.constants, image.layouts),
        slots_(image.types.size(), Slots::kUnknown) {}

  void run() {
    std::vector<std::vector<uint32_t>> children(nodes_.size());
    for (uint32_t i = 1; i < nodes_.size(); ++i) {
      if (!nodes_[i].program) children[nodes_[i].parent].push_back(i);
    }
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      add_area(nodes_[i], children[i]);
      add_members(nodes_[i]);
    }
    std::sort(image_.data.begin(), image_.data.end(),
              [](const ir::DataRun& a, const ir::DataRun& b) { return a.offset < b.offset; });
    join_retained();
  }

 private:
  uint32_t data_of(const InstanceNode& node) const { return image_.instances[node.id].data; }

  void add_area(const InstanceNode& node, const std::vector<uint32_t>& children) {
    base::Bytes bytes(image_.layouts[node.type].used, 0);
    initial_.write_area(node.type, node.init, bytes);
    for (uint32_t child : children) {
      store_id(nodes_[child].id, bytes.data() + nodes_[child].slot_offset);
    }
    if (&node == &nodes_[kGlobalsNode]) name_programs(bytes);
    add_runs(data_of(node), bytes, image_.data.own());
  }

  // A global of program type holds the ID of the program instance of its name.
  void name_programs(base::Bytes& globals) const {
    const std::vector<ir::Member>& members = image_.types[image_.globals].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (image_.types[members[i].type].kind != ir::Kind::kProgram) continue;
      for (const InstanceNode& node : nodes_) {
        if (!node.program || !ir::same_name(node.name, members[i].name)) continue;
        store_id(node.id, globals.data() + image_.layouts[image_.globals].member_offsets[i]);
      }
    }
  }

  void add_members(const InstanceNode& node) {
    const std::vector<ir::Member>& members = image_.types[node.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      const ir::Member& member = members[i];
      if (member.section == ir::Section::kInOut) continue;
      const uint32_t at = data_of(node) + image_.layouts[node.type].member_offsets[i];
      if (member.section == ir::Section::kStamp) continue;  // never retained
      if (member.retain || node.retained) retain(member.type, at, 0);
      bind(member, at);
    }
  }

  // Instance slots are not values: their instances are retained themselves.
  void retain(ir::TypeId id, uint32_t at, uint32_t depth) {
    const ir::Type& type = image_.types[id];
    if (image_.types.is_instance(id) || depth > 200) return;
    if (!holds_slots(id, 0)) {
      image_.retain.push_back({at, image_.layouts[id].size});
    } else if (ir::is_structure(type.kind)) {
      for (size_t i = 0; i < type.members.size(); ++i) {
        retain(type.members[i].type, at + image_.layouts[id].member_offsets[i], depth + 1);
      }
    } else {
      const uint32_t size = image_.layouts[type.base].size;
      for (uint32_t i = 0; i < image_.layouts[id].size; i += size) {
        retain(type.base, at + i, depth + 1);
      }
    }
  }

  enum class Slots : uint8_t { kUnknown, kNone, kSome };

  bool holds_slots(ir::TypeId id, uint32_t depth) {
    Slots& known = slots_[id.index];
    if (known == Slots::kUnknown) known = finds_slots(id, depth) ? Slots::kSome : Slots::kNone;
    return known == Slots::kSome;
  }
  bool finds_slots(ir::TypeId id, uint32_t depth) {
    const ir::Type& type = image_.types[id];
    if (image_.types.is_instance(id) || depth > 200) return true;
    if (type.kind == ir::Kind::kArray) return holds_slots(type.base, depth + 1);
    if (!ir::is_structure(type.kind)) return false;
    return std::any_of(type.members.begin(), type.members.end(), [&](const ir::Member& member) {
      return holds_slots(member.type, depth + 1);
    });
  }

  // Neighbours of one area; each range lies in one.
  void join_retained() {
    std::vector<uint32_t> begins;
    for (const InstanceNode& node : nodes_) begins.push_back(data_of(node));
    std::sort(begins.begin(), begins.end());
    std::vector<ir::RetainRange>& ranges = image_.retain;
    std::sort(ranges.begin(), ranges.end(),
              [](const auto& a, const auto& b) { return a.data < b.data; });
    std::vector<ir::RetainRange> joined;
    for (const ir::RetainRange& range : ranges) {
      bool next = !joined.empty() && joined.back().data + joined.back().size == range.data;
      if (next && !std::binary_search(begins.begin(), begins.end(), range.data)) {
        joined.back().size += range.size;
      } else {
        joined.push_back(range);
      }
    }
    ranges = std::move(joined);
  }

  void bind(const ir::Member& member, uint32_t at) {
    if (ir::is_shared(image_.types, member)) return bind_shared(member, at);
    if (member.address.bit_offset != ir::kOpenAddress) {
      bind_address(image_, member.address, at, member.type);
    }
  }

  // Bits are parts of the others.
  void bind_shared(const ir::Member& global, uint32_t at) {
    const std::vector<ir::Member>& members = image_.types[global.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (ir::is_shared_bit(members[i])) continue;
      bind_address(image_, ir::shared_address(image_.types, global, i),
                   at + image_.layouts[global.type].member_offsets[i], members[i].type);
    }
  }

  ir::Image& image_;
  const std::vector<InstanceNode>& nodes_;
  InitialValues initial_;
  std::vector<Slots> slots_;  // by type
};

}  // namespace

void bind_address(ir::Image& image, const ir::DirectAddress& address, uint32_t data,
                  ir::TypeId type) {
  if (address.area != ir::DirectArea::kNone) image.io.push_back({address, data, type});
}

base::Status size_process_image(ir::Image& image) {
  if (image.io.empty()) return base::Ok{};
  const ir::Layouts natural = ir::natural_layouts(image.types);
  for (const ir::IoBinding& binding : image.io) {
    const uint64_t end = binding.address.bit_offset +
                         ir::located_bits(image.types, natural, binding.type, binding.address);
    if (binding.address.area == ir::DirectArea::kMarker) continue;
    const bool input = binding.address.area == ir::DirectArea::kInput;
    uint32_t& bytes = input ? image.input_bytes : image.output_bytes;
    bytes = std::max(bytes, static_cast<uint32_t>((end + 7) / 8));
    if (bytes <= base::kMaxDeviceBytes) continue;
    return base::Error{base::Refusal::kTooMany,
                       std::string(input ? "%I" : "%Q") + " has " + std::to_string(bytes) +
                           " bytes; the limit is " + std::to_string(base::kMaxDeviceBytes)};
  }
  return base::Ok{};
}

// %M as far as devices can exchange what is there.
static uint32_t marker_bytes(const ir::Image& image) {
  uint64_t bytes = 0;
  const ir::Layouts natural = ir::natural_layouts(image.types);
  for (const ir::IoBinding& row : image.io) {
    const bool marker = row.address.area == ir::DirectArea::kMarker;
    if (!marker || !ir::is_locatable(image.types, row.type)) continue;
    const uint64_t end = (row.address.bit_offset +
                          ir::located_bits(image.types, natural, row.type, row.address) + 7) /
                         8;
    if (end <= base::kMaxDeviceBytes) bytes = std::max(bytes, end);
  }
  return static_cast<uint32_t>(bytes);
}

base::Status place_devices(ir::Image& image, const std::vector<ir::Device>& devices) {
  auto cover = [&] {
    const ir::ProcessImageSize size = ir::process_image_size(image.devices);
    image.input_bytes = std::max(image.input_bytes, size.input_bytes);
    image.output_bytes = std::max(image.output_bytes, size.output_bytes);
    return ir::ProcessImageSize{image.input_bytes, image.output_bytes, marker_bytes(image)};
  };
  image.devices = devices;
  if (devices.empty()) return base::Ok{};
  const ir::ProcessImageSize located = cover();
  for (ir::Device& device : image.devices) {
    if (device.map.empty()) ir::add_default_map(device, located);
  }
  const ir::ProcessImageSize all = cover();
  std::optional<ir::DeviceFault> fault = ir::find_fault(image.devices, &all);
  if (!fault) fault = ir::find_task_fault(image);
  if (!fault) return base::Ok{};
  return base::Error{base::Refusal::kBadMapping,
                     "device `" + image.devices[fault->device].name + "`: " + fault->text};
}

void fill_data_tables(ir::Image& image, const std::vector<InstanceNode>& nodes) {
  DataTables(image, nodes).run();
}

}  // namespace linker
