#include "online_change/plan/system_edits.h"

#include <algorithm>

#include "ir/types/address_text.h"

namespace online_change {
namespace {

class DeviceEdits {
 public:
  void removed(const ir::Device& device) { add(device, "removed"); }
  void added(const ir::Device& device) { add(device, "new, " + device.driver); }

  void compare(const ir::Device& before, const ir::Device& after) {
    if (before.driver != after.driver) {
      add(after, "driver " + before.driver + " -> " + after.driver);
    }
    for (const ir::DeviceSetting& row : before.settings) {
      const std::string now = ir::setting(after, row.key);
      if (now != row.value) add(after, row.key + " " + row.value + " -> " + now);
    }
    for (const ir::DeviceSetting& row : after.settings) {
      const auto same_key = [&](const auto& other) { return other.key == row.key; };
      if (std::any_of(before.settings.begin(), before.settings.end(), same_key)) continue;
      const std::string then = ir::setting(before, row.key);
      if (then != row.value) add(after, row.key + " " + then + " -> " + row.value);
    }
    if (!(before.quality == after.quality)) {
      add(after, "quality " + quality(before) + " -> " + quality(after));
    }
    entries(after, before.map, after.map, "no longer ");
    entries(after, after.map, before.map, "now ");
  }

  std::vector<SystemEdit> take() { return std::move(rows_); }

 private:
  void add(const ir::Device& device, std::string what) {
    rows_.push_back({"device", device.name, std::move(what)});
  }
  static std::string quality(const ir::Device& device) {
    const bool none = device.quality.area == ir::DirectArea::kNone;
    return none ? "none" : ir::address_text(device.quality);
  }
  void entries(const ir::Device& device, const std::vector<ir::DeviceMapping>& these,
               const std::vector<ir::DeviceMapping>& those, const char* what) {
    for (const ir::DeviceMapping& row : these) {
      if (std::find(those.begin(), those.end(), row) == those.end()) {
        add(device, what + ir::mapping_text(row));
      }
    }
  }

  std::vector<SystemEdit> rows_;
};

const ir::Device* find(const std::vector<ir::Device>& devices, const std::string& name) {
  for (const ir::Device& device : devices) {
    if (device.name == name) return &device;
  }
  return nullptr;
}

}  // namespace

std::vector<SystemEdit> device_edits(const ir::Image& old_image, const ir::Image& new_image) {
  DeviceEdits edits;
  for (const ir::Device& device : new_image.devices) {
    const ir::Device* before = find(old_image.devices, device.name);
    if (before == nullptr) {
      edits.added(device);
    } else {
      edits.compare(*before, device);
    }
  }
  for (const ir::Device& device : old_image.devices) {
    if (find(new_image.devices, device.name) == nullptr) edits.removed(device);
  }
  return edits.take();
}

}  // namespace online_change
