// All devices of the running version as one IoPort: what their drivers received goes to the mapped
// bits of %I, mapped bits of %Q to what they send; quality bits and loss policies are applied here.
//
// A change of the mapping: prepare() builds the tables of the next version beside the running ones,
// use() stores one pointer at the boundary, and back for undo. A device whose name, driver and
// settings are the same keeps its connection, one whose mapping is the same too its buffers; a new
// one is connected before it is used, and one that is used no more is closed by settle().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ir/bytecode/verify.h"
#include "vm/io/exchange_port.h"
#include "vm/runtime/ports.h"

namespace vm {

class EventRing;  // vm/runtime/event_ring.h

// A setting that is another one on this controller: `--device press.address=10.0.0.7:502`.
struct DeviceOverride {
  std::string device;
  std::string key;
  std::string value;
};
// kUsage when it has not that form.
base::Result<DeviceOverride> parse_device_override(const std::string& text);

class DeviceIo : public IoPort {
 public:
  struct Options {
    DriverFactory make_driver;
    std::vector<DeviceOverride> overrides = {};
    // Set: virtual time. Simulated devices exchange in send(), and in receive() where none was at
    // that instant, on this clock; others are off.
    Clock* virtual_clock = nullptr;
    DeviceLog log = {};
    EventRing* events = nullptr;  // gets devices whose exchange does not end; outlives this
    bool confined = false;        // threads of devices: vm/runtime/thread_filter.h
  };
  explicit DeviceIo(Options options);
  ~DeviceIo() override;

  // kNoDriver, kDeviceFailed; kUsage for an override of what there is not.
  base::Status prepare(const ir::VerifiedImage& version) override;
  void use(const base::Digest& version) override;
  void settle() override;
  std::vector<DeviceStatus> status() const override;

  void receive(std::span<uint8_t> inputs) override;
  void lost_tasks(std::span<uint8_t> tasks) override;
  void send(std::span<const uint8_t> outputs) override;
  void at_boundary(const ProcessImage& image, uint8_t* memory) override;

 private:
  struct Binding;
  struct Tables;
  base::Status apply_overrides(const std::vector<ir::Device>& devices,
                               std::vector<ir::Device>& out) const;
  base::Result<ExchangePort*> port_for(const ir::Device& device);
  base::Result<std::unique_ptr<Tables>> build(const ir::VerifiedImage& version);
  int64_t now_ns() const;
  void exchange_now(int64_t now_ns);
  bool take_writes();
  void tell_hang(Binding& binding, int64_t now_ns);
  static bool has_quality(const Binding& binding);
  void keep_running_only();

  Options options_;
  bool first_ = true;
  std::vector<std::unique_ptr<ExchangePort>> ports_;
  std::vector<std::unique_ptr<Tables>> tables_;
  Tables* running_ = nullptr;
  bool switched_ = false;  // unmapped inputs are to be cleared once
  int64_t exchanged_ns_ = INT64_MIN;  // in virtual time
};

}  // namespace vm
