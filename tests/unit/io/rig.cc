#include "tests/unit/io/rig.h"

#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "linker/link.h"

namespace io_test {
namespace {

class FakeDriver : public vm::IoDriver {
 public:
  explicit FakeDriver(FakeDevice& device) : device_(device) { ++device_.alive; }
  ~FakeDriver() override { --device_.alive; }

  base::Status exchange(const vm::Exchange& exchange) override {
    ++device_.exchanges;
    device_.hangs.wait(true);
    if (device_.broken) return vm::exchange_failed("the device is broken");
    std::lock_guard lock(device_.mutex);
    if (!exchange.outputs.empty()) {
      for (const vm::PointRange& range : exchange.points.outputs) {
        std::copy_n(exchange.outputs.begin() + range.byte, range.count,
                    device_.memory.begin() + range.first);
      }
      device_.written.emplace_back(exchange.outputs.begin(), exchange.outputs.end());
    }
    if (exchange.inputs.empty()) return base::Ok{};
    for (const vm::PointRange& range : exchange.points.inputs) {
      std::copy_n(device_.memory.begin() + 32 + range.first, range.count,
                  exchange.inputs.begin() + range.byte);
    }
    return base::Ok{};
  }

 private:
  FakeDevice& device_;
};

ir::DeviceMapping mapping(uint32_t first, uint32_t count, uint32_t byte, bool out) {
  const auto area = out ? ir::DirectArea::kOutput : ir::DirectArea::kInput;
  return {ir::PointTable::kByte, first, count, out, {area, byte * 8, 8}};
}

}  // namespace

std::optional<ir::VerifiedImage> build(const std::string& source,
                                       const std::vector<ir::Device>& devices) {
  base::SourceMap sources;
  sources.add("test.st", source);
  base::Diagnostics diagnostics;
  auto program = frontend::compile(sources, {}, diagnostics);
  if (!program) {
    ADD_FAILURE() << base::render(diagnostics, sources, base::DiagnosticFormat::kText, false);
    return std::nullopt;
  }
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program->pous.size(); ++i) {
    objects.push_back(std::move(ir::lower(*program, ir::PouId(i))).value());
  }
  linker::Options options;
  options.devices = devices;
  base::Result<ir::Image> image = linker::link(*program, objects, options);
  if (!image.ok()) {
    ADD_FAILURE() << image.error().text;
    return std::nullopt;
  }
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(*image));
  if (!verified.ok()) {
    ADD_FAILURE() << verified.error().text;
    return std::nullopt;
  }
  return *verified;
}

ir::DeviceMapping to_program(uint32_t first, uint32_t count, uint32_t byte) {
  return mapping(first, count, byte, false);
}
ir::DeviceMapping to_device(uint32_t first, uint32_t count, uint32_t byte) {
  return mapping(first, count, byte, true);
}

ir::Device device(const std::string& name, std::vector<ir::DeviceMapping> map,
                  std::vector<ir::DeviceSetting> settings) {
  return {name, "simulated", std::move(settings), std::move(map), {}};
}

std::unique_ptr<vm::IoDriver> fake_driver(FakeDevice& device) {
  return std::make_unique<FakeDriver>(device);
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 600'000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace io_test
