#include "vm/io/simulated_driver.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "base/limits.h"
#include "ir/types/address_text.h"
#include "vm/io/bit_copy.h"
#include "vm/io/csv_inputs.h"
#include "vm/io/csv_outputs.h"

namespace vm {
namespace {

constexpr size_t kMostCsvBytes = 256u << 20;

base::Error failed(std::string text) { return {base::Refusal::kDeviceFailed, std::move(text)}; }

base::Result<std::string> read_file(const std::string& name) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "re"), std::fclose);
  if (!file) return failed(name + ": " + std::strerror(errno));
  std::string text;
  char part[65536];
  for (size_t got = 0; (got = std::fread(part, 1, sizeof part, file.get())) != 0;) {
    text.append(part, got);
    if (text.size() > kMostCsvBytes) return failed(name + ": larger than 256 MiB");
  }
  if (std::ferror(file.get()) != 0) return failed(name + ": " + std::strerror(errno));
  return text;
}

// Where the value at `at` is in the exchanged inputs; nullopt: it is not mapped, or not whole.
std::optional<uint32_t> exchanged_bit(const DevicePoints& points, const ir::DirectAddress& at) {
  for (const PointRange& range : points.inputs) {
    if (at.bit_offset < range.at.bit_offset) continue;
    const uint32_t in = at.bit_offset - range.at.bit_offset;
    if (in < range.bits() && range.bits() - in >= at.bit_size) return range.byte * 8 + in;
  }
  return std::nullopt;
}

class SimulatedDriver : public IoDriver {
 public:
  SimulatedDriver(std::optional<CsvInputs> inputs, std::unique_ptr<CsvOutputs> outputs)
      : inputs_(std::move(inputs)), outputs_(std::move(outputs)) {}

  base::Status exchange(const Exchange& exchange) override {
    if (inputs_) inputs_->advance(exchange.now_ns);
    if (inputs_ && inputs_->lost()) return exchange_failed("lost, as the inputs' file says");
    if (inputs_ && !exchange.inputs.empty()) read(exchange);
    if (exchange.outputs.empty() || !outputs_) return base::Ok{};
    return outputs_->write(exchange.points, exchange.outputs, exchange.now_ns);
  }

 private:
  void read(const Exchange& exchange) {
    for (size_t i = 0; i < inputs_->columns().size(); ++i) {
      const ir::DirectAddress& at = inputs_->columns()[i];
      const std::optional<uint32_t> to = exchanged_bit(exchange.points, at);
      if (!to) continue;  // a change of the program took it away
      uint8_t bytes[8];
      for (uint32_t byte = 0; byte < 8; ++byte) {
        bytes[byte] = static_cast<uint8_t>(inputs_->value(i) >> (8 * byte));
      }
      copy_bits(bytes, 0, exchange.inputs, *to, at.bit_size);
    }
  }

  std::optional<CsvInputs> inputs_;
  std::unique_ptr<CsvOutputs> outputs_;
};

}  // namespace

base::Result<std::unique_ptr<IoDriver>> make_simulated_driver(const ir::Device& device) {
  std::optional<CsvInputs> inputs;
  std::unique_ptr<CsvOutputs> outputs;
  if (const std::string name = ir::setting(device, "inputs"); !name.empty()) {
    base::Result<std::string> text = read_file(name);
    if (!text.ok()) return text.error();
    base::Result<CsvInputs> parsed = CsvInputs::parse(name, *text);
    if (!parsed.ok()) return parsed.error();
    const DevicePoints points = points_of(device);
    for (const ir::DirectAddress& column : parsed->columns()) {
      if (exchanged_bit(points, column)) continue;
      return failed(name + ":1: column `" + ir::address_text(column) +
                    "` is not mapped by this device");
    }
    inputs.emplace(std::move(*parsed));
  }
  if (const std::string name = ir::setting(device, "outputs"); !name.empty()) {
    auto opened = CsvOutputs::open(name);
    if (!opened.ok()) return opened.error();
    outputs = std::move(*opened);
  }
  return std::unique_ptr<IoDriver>(
      std::make_unique<SimulatedDriver>(std::move(inputs), std::move(outputs)));
}

}  // namespace vm
