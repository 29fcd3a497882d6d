// What people want to know of a device as it happens.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace vm {

enum class DeviceEvent : uint8_t { kLost, kBack, kWritten, kRefused };

// Takes what happens to a device; called by the threads of all devices, as often as it happens.
using DeviceLog =
    std::function<void(DeviceEvent event, const std::string& device, const std::string& text)>;

// What others do to a device that serves them; a driver calls it in exchange().
class OutsideEvents {
 public:
  virtual ~OutsideEvents() = default;
  // `who` wrote to %Q or %M, or wanted to write where nobody may: "10.0.0.9:40312", "holding 2..3".
  virtual void written(const std::string& who, const std::string& what) = 0;
  virtual void refused(const std::string& who, const std::string& what) = 0;
};

}  // namespace vm
