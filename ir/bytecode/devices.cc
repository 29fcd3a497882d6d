#include "ir/bytecode/devices.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/types/address_text.h"

namespace ir {
namespace {

// Bits of %I that somebody provides, or points of one table that somebody takes.
struct Claim {
  uint64_t begin = 0;
  uint64_t end = 0;
  size_t device = 0;
  size_t entry = 0;
};

class Checker {
 public:
  Checker(const std::vector<Device>& devices, const ProcessImageSize* size)
      : devices_(devices), size_(size) {}

  std::optional<DeviceFault> run() {
    size_t entries = 0;
    for (at_ = 0; at_ < devices_.size() && !fault_; ++at_) {
      if (at_ >= base::kMaxDevices) {
        fault(DeviceFault::kDevice,
              "there are more than " + std::to_string(base::kMaxDevices) + " devices");
      }
      entries += devices_[at_].map.size();
      if (entries > base::kMaxMappings) {
        fault(DeviceFault::kDevice,
              "the devices have more than " + std::to_string(base::kMaxMappings) + " map entries");
      }
      if (!fault_) check_device();
    }
    if (!fault_) find_overlap(inputs_, "provides the same bits of %I as");
    return std::move(fault_);
  }

 private:
  void fault(size_t entry, std::string text) {
    if (!fault_) fault_ = DeviceFault{at_, entry, std::move(text)};
  }

  void check_device() {
    const Device& device = devices_[at_];
    const DriverRow* driver = find_driver(device.driver);
    if (driver == nullptr) {
      return fault(DeviceFault::kDevice, "there is no driver \"" + device.driver + "\"");
    }
    for (size_t other = 0; other < at_; ++other) {
      if (devices_[other].name == device.name) {
        fault(DeviceFault::kDevice, "there is another device `" + device.name + "`");
      }
    }
    check_settings(*driver, device);
    check_quality(device);
    std::vector<Claim> points;
    for (size_t entry = 0; entry < device.map.size() && !fault_; ++entry) {
      check_mapping(*driver, device.map[entry], entry, points);
    }
    if (!fault_) find_overlap(points, "takes the same points of the device as");
  }

  void check_settings(const DriverRow& driver, const Device& device) {
    for (const DeviceSetting& given : device.settings) {
      const SettingRow* row = find_setting(driver, given.key);
      if (row == nullptr) {
        return fault(DeviceFault::kDevice,
                     "driver \"" + device.driver + "\" has no setting `" + given.key + "`");
      }
      const std::string bad = bad_value(*row, given.value);
      if (!bad.empty()) return fault(DeviceFault::kDevice, "`" + given.key + "` " + bad);
    }
    for (const SettingRow& row : setting_rows()) {
      const bool needed = (row.families & driver.family) != 0 && row.fallback == nullptr;
      const bool given =
          std::any_of(device.settings.begin(), device.settings.end(),
                      [&](const DeviceSetting& setting) { return setting.key == row.key; });
      if (!needed || given) continue;
      return fault(DeviceFault::kDevice, "driver \"" + device.driver + "\" needs `" +
                                             std::string(row.key) +
                                             "`: " + std::string(row.meaning));
    }
  }

  void check_quality(const Device& device) {
    if (device.quality.area == DirectArea::kNone) return;
    if (device.quality.area != DirectArea::kInput || device.quality.bit_size != 1) {
      return fault(DeviceFault::kQuality, "the quality is a bit of %I: \"%IX100.0\"");
    }
    check_place(device.quality, 1, DeviceFault::kQuality);
    const uint64_t bit = device.quality.bit_offset;
    inputs_.push_back({bit, bit + 1, at_, DeviceFault::kQuality});
  }

  // Inside the limit, and inside the process image where that is known.
  void check_place(const DirectAddress& at, uint64_t bits, size_t entry) {
    const uint64_t end = (at.bit_offset + bits + 7) / 8;
    if (end > base::kMaxDeviceBytes) {
      return fault(entry, address_text(at) + " ends at byte " + std::to_string(end) +
                              "; the limit is " + std::to_string(base::kMaxDeviceBytes));
    }
    if (size_ == nullptr || at.area == DirectArea::kMarker) return;
    const bool input = at.area == DirectArea::kInput;
    const uint32_t limit = input ? size_->input_bytes : size_->output_bytes;
    if (end <= limit) return;
    fault(entry, address_text(at) + " ends at byte " + std::to_string(end) + " of " +
                     std::to_string(limit));
  }

  void check_mapping(const DriverRow& driver, const DeviceMapping& map, size_t entry,
                     std::vector<Claim>& points) {
    const TableRow& table = table_rows()[static_cast<size_t>(map.table)];
    const std::string name(table.name);
    if ((table.families & driver.family) == 0) {
      return fault(entry, "driver \"" + std::string(driver.name) + "\" has no `" + name + "`");
    }
    if (map.count == 0) return fault(entry, "it has no points");
    const uint64_t end = uint64_t{map.first} + map.count;
    if (end > uint64_t{table.last_point} + 1) {
      return fault(entry, "`" + name + "` ends at " + std::to_string(table.last_point));
    }
    if (map.at.area == DirectArea::kNone || !aligned(map.at)) return fault(entry, "no address");
    check_direction(driver, table, map, entry);
    check_size(table, map, entry);
    check_place(map.at, map.bits(), entry);
    const uint64_t base = uint64_t{1 + static_cast<uint32_t>(map.table)} << 32;
    // A client may read back what it writes; a server's point is one value.
    const uint64_t way = !driver.server && !map.to_device ? uint64_t{1} << 40 : 0;
    points.push_back({way + base + map.first, way + base + end, at_, entry});
    if (map.to_device || map.at.area != DirectArea::kInput) return;
    inputs_.push_back({map.at.bit_offset, map.at.bit_offset + map.bits(), at_, entry});
  }

  static bool aligned(const DirectAddress& at) {
    const uint32_t size = at.bit_size;
    const bool known = size == 1 || size == 8 || size == 16 || size == 32 || size == 64;
    return known && at.bit_offset % size == 0;
  }

  void check_direction(const DriverRow& driver, const TableRow& table, const DeviceMapping& map,
                       size_t entry) {
    const bool input = map.at.area == DirectArea::kInput;
    const bool output = map.at.area == DirectArea::kOutput;
    const std::string name = "`" + std::string(table.name) + "`";
    if (map.at.area == DirectArea::kMarker && !driver.server) {
      return fault(entry, "devices exchange %I and %Q; %M is a variable of the program");
    }
    if (map.writable && !driver.server) {
      return fault(entry, "`<->` is for servers: others write what the program writes, too");
    }
    if (map.writable && (input || !map.to_device)) {
      return fault(entry, "`<->` needs %Q or %M; use `->` for %I");
    }
    if (map.writable && !table.to_device) {
      return fault(entry, name + " can only be read by others: use `<-`");
    }
    if (map.to_device && !output && !driver.server) {
      return fault(entry, "`<-` sends to the device: only %Q can stand after it");
    }
    if (!map.to_device && !input) {
      return fault(entry, "`->` comes from the device: only %I can stand after it");
    }
    // What a server's client can only read cannot come from there.
    const bool possible = driver.server   ? map.to_device || table.to_device
                          : map.to_device ? table.to_device
                                          : table.to_program;
    if (possible) return;
    fault(entry, name + (driver.server ? " can only be read by others: use `<-`"
                                       : " can only be read: use `->`"));
  }

  void check_size(const TableRow& table, const DeviceMapping& map, size_t entry) {
    const uint32_t size = map.at.bit_size;
    if (table.point_bits == 1) {
      if (size != 1) fault(entry, "a bit needs a bit address: " + bit_place(map));
      return;
    }
    if (size == 1 || size < table.point_bits) {
      return fault(entry, "`" + std::string(table.name) + "` has " +
                              std::to_string(table.point_bits) + " bits: use " +
                              (table.point_bits == 8 ? "%IB, %IW, %ID or %IL" : "%IW, %ID or %IL") +
                              ", or the same with %Q");
    }
    const uint32_t each = size / table.point_bits;
    if (map.count % each == 0) return;
    fault(entry, std::to_string(map.count) + " points are no whole number of " +
                     std::to_string(size) + "-bit values: each takes " + std::to_string(each));
  }

  static std::string bit_place(const DeviceMapping& map) {
    return address_text({map.at.area, map.at.bit_offset, 1});
  }

  std::string place(const Claim& claim) const {
    const Device& device = devices_[claim.device];
    if (claim.entry == DeviceFault::kQuality) return "the quality of `" + device.name + "`";
    return "\"" + mapping_text(device.map[claim.entry]) + "\" of `" + device.name + "`";
  }

  void find_overlap(std::vector<Claim>& claims, const std::string& what) {
    std::stable_sort(claims.begin(), claims.end(),
                     [](const Claim& a, const Claim& b) { return a.begin < b.begin; });
    const Claim* longest = nullptr;
    for (const Claim& claim : claims) {
      if (longest != nullptr && claim.begin < longest->end) {
        const bool first =
            std::pair(claim.device, claim.entry) < std::pair(longest->device, longest->entry);
        const Claim& early = first ? claim : *longest;
        const Claim& late = first ? *longest : claim;
        fault_ =
            DeviceFault{late.device, late.entry, place(late) + " " + what + " " + place(early)};
        return;
      }
      if (longest == nullptr || claim.end > longest->end) longest = &claim;
    }
  }

  const std::vector<Device>& devices_;
  const ProcessImageSize* size_;
  size_t at_ = 0;
  std::vector<Claim> inputs_;
  std::optional<DeviceFault> fault_;
};

}  // namespace

uint64_t DeviceMapping::bits() const {
  return uint64_t{count} * table_rows()[static_cast<size_t>(table)].point_bits;
}

std::string mapping_text(const DeviceMapping& mapping) {
  std::string out(table_rows()[static_cast<size_t>(mapping.table)].name);
  out += " " + std::to_string(mapping.first);
  if (mapping.count > 1) out += ".." + std::to_string(uint64_t{mapping.first} + mapping.count - 1);
  return out +
         (mapping.writable    ? " <-> "
          : mapping.to_device ? " <- "
                              : " -> ") +
         address_text(mapping.at);
}

std::optional<DeviceFault> find_fault(const std::vector<Device>& devices,
                                      const ProcessImageSize* size) {
  return Checker(devices, size).run();
}

ProcessImageSize process_image_size(const std::vector<Device>& devices) {
  ProcessImageSize size;
  auto cover = [&](const DirectAddress& at, uint64_t bits) {
    const auto end = static_cast<uint32_t>((at.bit_offset + bits + 7) / 8);
    if (at.area == DirectArea::kInput) size.input_bytes = std::max(size.input_bytes, end);
    if (at.area == DirectArea::kOutput) size.output_bytes = std::max(size.output_bytes, end);
    if (at.area == DirectArea::kMarker) size.marker_bytes = std::max(size.marker_bytes, end);
  };
  for (const Device& device : devices) {
    cover(device.quality, 1);
    for (const DeviceMapping& mapping : device.map) cover(mapping.at, mapping.bits());
  }
  return size;
}

}  // namespace ir
