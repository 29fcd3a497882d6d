#include "vm/io/device_io.h"

#include <algorithm>

#include "base/check.h"
#include "ir/bytecode/device_tasks.h"
#include "ir/types/time_units.h"
#include "vm/io/bit_copy.h"
#include "vm/runtime/event_ring.h"
#include "vm/runtime/process_image.h"
#include "vm/runtime/safe_outputs.h"

namespace vm {
namespace {

// Do both use the same connection? Only the map may differ then.
bool same_line(const ir::Device& a, const ir::Device& b) {
  return a.name == b.name && a.driver == b.driver && a.settings == b.settings;
}

void set_bit(std::span<uint8_t> bytes, uint32_t bit, bool value) {
  const auto mask = static_cast<uint8_t>(1u << (bit % 8));
  if (value) {
    bytes[bit / 8] |= mask;
  } else {
    bytes[bit / 8] &= static_cast<uint8_t>(~mask);
  }
}

// "": the setting can have that value. `setting` null: the driver has none of that name.
std::string bad_override(const ir::Device& device, const ir::SettingRow* setting,
                         const std::string& value) {
  if (setting == nullptr) return "is no setting of \"" + device.driver + "\"";
  if (setting->kind != ir::SettingKind::kFlag) return ir::bad_value(*setting, value);
  return "belongs to the map, which is part of the program";
}

// What the version's outputs become when another one does not exchange them any more: safe, for
// good (vm/runtime/safe_outputs.h).
LeftOutputs left_outputs(const ir::Image& image, const DevicePoints& points) {
  LeftOutputs left{base::Bytes(points.output_bytes), base::Bytes(points.output_bytes)};
  const SafeOutputs::AtTheEnd safe = SafeOutputs::at_the_end(image);
  for (const PointRange& range : points.outputs) {
    if (range.at.area != ir::DirectArea::kOutput) continue;
    copy_bits(safe.value, range.at.bit_offset, left.value, range.byte * 8, range.bits());
    copy_bits(safe.held, range.at.bit_offset, left.held, range.byte * 8, range.bits());
  }
  return left;
}

}  // namespace

// One device in one version. `port` null: it is off.
struct DeviceIo::Binding {
  ir::Device device;
  ir::LossPolicy loss;
  std::optional<uint32_t> task = {};  // of the version; nothing: none is trapped by a loss
  bool online = false;                // at the last receive()
  bool lost = false;                  // between it and the one before
  bool hangs = false;                 // it was lost so, and that was told
  int64_t hangs_since_ns = 0;
  ExchangePort* port = nullptr;
  std::shared_ptr<ExchangeSet> set;
};

bool DeviceIo::has_quality(const Binding& binding) {
  return binding.device.quality.area != ir::DirectArea::kNone;
}

struct DeviceIo::Tables {
  explicit Tables(const ir::VerifiedImage& of)
      : version(of),
        mapped_inputs(of.image().input_bytes),
        received(of.image().input_bytes),
        markers(ir::process_image_size(of.image().devices).marker_bytes),
        outputs(of.image().output_bytes) {}

  // The bytes behind an address, as sent next.
  std::span<const uint8_t> area(ir::DirectArea wanted, std::span<const uint8_t> sent) const {
    if (wanted == ir::DirectArea::kInput) return received;
    return wanted == ir::DirectArea::kMarker ? std::span<const uint8_t>(markers) : sent;
  }

  const Binding* of(const ExchangePort& port) const {
    for (const Binding& binding : bindings) {
      if (binding.port == &port) return &binding;
    }
    return nullptr;
  }

  ir::VerifiedImage version;
  std::vector<Binding> bindings;
  base::Bytes mapped_inputs;  // bits that some device provides
  base::Bytes received;       // %I as received last, for devices that show it
  base::Bytes markers;        // %M at the last boundary
  base::Bytes outputs;        // where others' writes meet the variables
  bool writable = false;      // others write %Q or %M
};

base::Result<DeviceOverride> parse_device_override(const std::string& text) {
  const size_t equals = text.find('=');
  const size_t dot = text.find('.');
  if (equals == std::string::npos || dot == std::string::npos || dot > equals || dot == 0) {
    return base::Error{
        base::Refusal::kUsage,
        "--device " + text + ": expected NAME.KEY=VALUE, as in press.address=plc:502"};
  }
  return DeviceOverride{text.substr(0, dot), text.substr(dot + 1, equals - dot - 1),
                        text.substr(equals + 1)};
}

DeviceIo::DeviceIo(Options options) : options_(std::move(options)) {}
DeviceIo::~DeviceIo() = default;

base::Status DeviceIo::apply_overrides(const std::vector<ir::Device>& devices,
                                       std::vector<ir::Device>& out) const {
  out = devices;
  for (const DeviceOverride& row : options_.overrides) {
    const std::string what = "--device " + row.device + "." + row.key;
    const auto device = std::find_if(out.begin(), out.end(), [&](const ir::Device& candidate) {
      return candidate.name == row.device;
    });
    if (device == out.end()) {
      if (!first_) continue;  // a version may have dropped it
      return base::Error{base::Refusal::kUsage, what + ": the program has no such device"};
    }
    const ir::SettingRow* setting = ir::find_setting(*ir::find_driver(device->driver), row.key);
    const std::string bad = bad_override(*device, setting, row.value);
    if (!bad.empty()) return base::Error{base::Refusal::kUsage, what + " " + bad};
    const auto given =
        std::find_if(device->settings.begin(), device->settings.end(),
                     [&](const ir::DeviceSetting& candidate) { return candidate.key == row.key; });
    if (given == device->settings.end()) {
      device->settings.push_back({row.key, row.value});
    } else {
      given->value = row.value;
    }
  }
  return base::Ok{};
}

base::Result<ExchangePort*> DeviceIo::port_for(const ir::Device& device) {
  for (const auto& port : ports_) {
    if (same_line(port->device(), device)) return port.get();
  }
  auto driver = options_.make_driver(device);
  if (!driver.ok()) {
    return base::Error{driver.error().refusal,
                       "device `" + device.name + "`: " + driver.error().text};
  }
  ports_.push_back(std::make_unique<ExchangePort>(device, std::move(*driver),
                                                  options_.virtual_clock == nullptr,
                                                  options_.log, options_.confined));
  return ports_.back().get();
}

base::Result<std::unique_ptr<DeviceIo::Tables>> DeviceIo::build(const ir::VerifiedImage& version) {
  auto tables = std::make_unique<Tables>(version);
  std::vector<ir::Device> devices;
  if (base::Status set = apply_overrides(version.image().devices, devices); !set.ok()) {
    return set.error();
  }
  for (ir::Device& device : devices) {
    Binding binding;
    for (const ir::DeviceMapping& mapping : device.map) {
      if (mapping.to_device) continue;
      for (uint32_t bit = 0; bit < mapping.bits(); ++bit) {
        set_bit(tables->mapped_inputs, mapping.at.bit_offset + bit, true);
      }
    }
    if (device.quality.area != ir::DirectArea::kNone) {
      set_bit(tables->mapped_inputs, device.quality.bit_offset, true);
    }
    binding.loss = *ir::parse_loss(ir::setting(device, "on_loss"));
    const std::string bad_task = ir::bad_loss_task(version.image(), binding.loss.task);
    if (!bad_task.empty()) {  // the image's own has been verified
      return base::Error{base::Refusal::kUsage,
                         "--device " + device.name + ".on_loss: " + bad_task};
    }
    binding.task = ir::loss_task(version.image(), binding.loss.task);
    const bool off = options_.virtual_clock != nullptr &&
                     ir::find_driver(device.driver)->id != ir::DriverId::kSimulated;
    if (!off) {
      base::Result<ExchangePort*> port = port_for(device);
      if (!port.ok()) return port.error();
      DevicePoints points = points_of(device);
      const Binding* running = running_ != nullptr ? running_->of(**port) : nullptr;
      LeftOutputs left = left_outputs(version.image(), points);
      const bool same =
          running != nullptr && running->set->points == points && running->set->left == left;
      binding.port = *port;
      for (const PointRange& range : points.outputs) tables->writable |= range.writable;
      binding.set = same ? running->set : (*port)->add(std::move(points), std::move(left));
    }
    binding.device = std::move(device);
    tables->bindings.push_back(std::move(binding));
  }
  return tables;
}

base::Status DeviceIo::prepare(const ir::VerifiedImage& version) {
  keep_running_only();
  auto tables = build(version);
  if (!tables.ok()) {
    keep_running_only();
    return tables.error();
  }
  first_ = false;
  tables_.push_back(std::move(*tables));
  return base::Ok{};
}

void DeviceIo::use(const base::Digest& version) {
  const auto next = std::find_if(tables_.begin(), tables_.end(), [&](const auto& tables) {
    return tables->version.digest() == version;
  });
  base::check(next != tables_.end(), "devices of a version are used that were not prepared");
  for (Binding& binding : (*next)->bindings) {  // the connection goes on, and so does what is seen
    const Binding* before =
        running_ != nullptr && binding.port != nullptr ? running_->of(*binding.port) : nullptr;
    binding.online = before != nullptr && before->online;
    binding.hangs = before != nullptr && before->hangs;
    binding.hangs_since_ns = binding.hangs ? before->hangs_since_ns : 0;
    binding.lost = false;
  }
  running_ = next->get();
  switched_ = true;
  for (const Binding& binding : running_->bindings) {  // what was written to it before
    if (binding.set && binding.set->writes) binding.set->writes->take([](const auto&) {});
  }
  for (const auto& port : ports_) {
    const Binding* binding = running_->of(*port);
    port->use(binding != nullptr ? binding->set.get() : nullptr);
  }
}

void DeviceIo::settle() { keep_running_only(); }

void DeviceIo::keep_running_only() {
  for (const auto& tables : tables_) {
    if (tables.get() == running_) continue;
    for (const Binding& binding : tables->bindings) {
      const Binding* kept =
          running_ != nullptr && binding.port != nullptr ? running_->of(*binding.port) : nullptr;
      const bool shared = kept != nullptr && kept->set == binding.set;
      if (binding.port != nullptr && !shared) binding.port->drop(binding.set);
    }
  }
  std::erase_if(tables_, [&](const auto& tables) { return tables.get() != running_; });
  std::erase_if(ports_, [&](const auto& port) {
    return running_ == nullptr || running_->of(*port) == nullptr;
  });
}

int64_t DeviceIo::now_ns() const {
  return options_.virtual_clock != nullptr ? options_.virtual_clock->now_ns()
                                           : ExchangePort::now_ns();
}

void DeviceIo::receive(std::span<uint8_t> inputs) {
  if (running_ == nullptr) return;
  if (switched_) {  // nobody provides them any more
    for (size_t i = 0; i < inputs.size(); ++i) inputs[i] &= running_->mapped_inputs[i];
    switched_ = false;
  }
  if (running_->bindings.empty()) return;
  const int64_t now = now_ns();
  if (options_.virtual_clock != nullptr && now != exchanged_ns_) exchange_now(now);
  for (Binding& binding : running_->bindings) {
    if (binding.port == nullptr) {
      if (has_quality(binding)) set_bit(inputs, binding.device.quality.bit_offset, false);
      continue;
    }
    ExchangeSet& set = *binding.set;
    bool fresh = binding.port->fresh(now);
    binding.lost = binding.online && !fresh;
    binding.online = fresh;
    if (options_.events != nullptr) tell_hang(binding, now);
    if (fresh && set.inputs.take()) set.received = true;
    fresh = fresh && (set.received || set.points.inputs.empty());  // of this version's points
    if (has_quality(binding)) set_bit(inputs, binding.device.quality.bit_offset, fresh);
    const int64_t received = binding.port->received_ns();
    const bool zero = !fresh && !binding.loss.hold &&
                      (received == INT64_MIN || now - received >= binding.loss.zero_after_ns);
    for (const PointRange& range : set.points.inputs) {
      if (zero) {
        clear_bits(inputs, range.at.bit_offset, range.bits());
      } else if (fresh) {
        copy_bits(set.inputs.newest(), range.byte * 8, inputs, range.at.bit_offset, range.bits());
      }
    }
  }
  std::copy(inputs.begin(), inputs.end(), running_->received.begin());
}

// An exchange that fails is told by its own thread, with the reason. One that does not end can only
// be seen here.
void DeviceIo::tell_hang(Binding& binding, int64_t now) {
  const bool begins = binding.lost && !binding.port->failed();
  if (!begins && !(binding.hangs && binding.online)) return;
  binding.hangs = begins;
  if (begins) binding.hangs_since_ns = binding.port->received_ns();
  const auto kind = begins ? ScanEventKind::kDeviceLost : ScanEventKind::kDeviceBack;
  ScanEvent* const event = options_.events->begin(kind);
  if (event == nullptr) return;
  event->source.add("device ").add(binding.device.name);
  event->text.add(begins ? "its exchange does not end; its newest inputs are " : "online after ");
  event->text.add((now - binding.hangs_since_ns) / ir::kNsPerMillisecond);
  event->text.add(begins ? " ms old" : " ms");
  options_.events->end();
}

void DeviceIo::lost_tasks(std::span<uint8_t> tasks) {
  if (running_ == nullptr) return;
  for (const Binding& binding : running_->bindings) {
    if (binding.lost && binding.task && *binding.task < tasks.size()) tasks[*binding.task] = 1;
  }
}

void DeviceIo::send(std::span<const uint8_t> outputs) {
  if (running_ == nullptr) return;
  for (const Binding& binding : running_->bindings) {
    if (binding.port == nullptr) continue;
    ExchangeSet& set = *binding.set;
    const std::span<uint8_t> work = set.outputs.work();
    for (const PointRange& range : set.points.outputs) {
      copy_bits(running_->area(range.at.area, outputs), range.at.bit_offset, work, range.byte * 8,
                range.bits());
    }
    set.outputs.publish();
  }
  if (options_.virtual_clock != nullptr) exchange_now(now_ns());
}

void DeviceIo::exchange_now(int64_t now) {
  for (const Binding& binding : running_->bindings) {
    if (binding.port != nullptr) binding.port->exchange_now(now);
  }
  exchanged_ns_ = now;
}

// What others wrote becomes the variables' values, as if a task had written it between two cycles.
bool DeviceIo::take_writes() {
  bool any = false;
  for (const Binding& binding : running_->bindings) {
    if (!binding.set || !binding.set->writes) continue;
    any |= binding.set->writes->take([&](const OutsideWrite& write) {
      const bool marker = write.area == ir::DirectArea::kMarker;
      const uint8_t value[2] = {static_cast<uint8_t>(write.value),
                                static_cast<uint8_t>(write.value >> 8)};
      copy_bits(value, 0, marker ? running_->markers : running_->outputs, write.bit, write.bits);
    });
  }
  return any;
}

void DeviceIo::at_boundary(const ProcessImage& image, uint8_t* memory) {
  if (running_ == nullptr || (running_->markers.empty() && !running_->writable)) return;
  image.variables_to_markers(memory, running_->markers);
  if (!running_->writable) return;
  image.variables_to_outputs(memory, running_->outputs);
  if (!take_writes()) return;
  image.markers_to_variables(running_->markers, memory);
  image.outputs_to_variables(running_->outputs, memory);
}

std::vector<DeviceStatus> DeviceIo::status() const {
  std::vector<DeviceStatus> rows;
  if (running_ == nullptr) return rows;
  for (const Binding& binding : running_->bindings) {
    if (binding.port != nullptr) {
      rows.push_back(binding.port->status());
    } else {
      rows.push_back({binding.device.name, binding.device.driver, "off", 0, 0, -1,
                      "not exchanged in virtual time"});
    }
  }
  return rows;
}

}  // namespace vm
