// What people want to know of a device as it happens, and how often it is said.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace vm {

// Takes a line about a device; called by the threads of all devices.
using DeviceLog = std::function<void(const std::string& line)>;

// What others do to a device that serves them; a driver calls it in exchange().
class OutsideEvents {
 public:
  virtual ~OutsideEvents() = default;
  // `who` wrote to %Q or %M, or wanted to write where nobody may: "10.0.0.9:40312", "holding 2..3".
  virtual void written(const std::string& who, const std::string& what) = 0;
  virtual void refused(const std::string& who, const std::string& what) = 0;
};

// Lets some events through at once and then one in each period. The others are counted.
class EventLimit {
 public:
  static constexpr uint64_t kAtOnce = 5;
  static constexpr int64_t kPeriodNs = 10'000'000'000;

  // How many were left out since the last one that passed; nothing: this one is left out, too.
  std::optional<uint64_t> pass(int64_t now_ns) {
    const int64_t periods = (now_ns - counted_ns_) / kPeriodNs;
    counted_ns_ += periods * kPeriodNs;
    left_ = std::min(left_ + static_cast<uint64_t>(periods), kAtOnce);
    if (left_ == 0) {
      ++omitted_;
      return std::nullopt;
    }
    --left_;
    return std::exchange(omitted_, 0);
  }

 private:
  int64_t counted_ns_ = 0;
  uint64_t left_ = kAtOnce;
  uint64_t omitted_ = 0;
};

}  // namespace vm
