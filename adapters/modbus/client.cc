#include "adapters/modbus/client.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include "adapters/modbus/values.h"
#include "ir/bytecode/devices.h"

namespace modbus {
namespace {

using vm::PointRange;

int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

class Client : public vm::IoDriver {
 public:
  Client(const ir::Device& device, Context context)
      : context_(std::move(context)),
        timeout_ns_(ir::number_setting(device, "timeout_ms") * 1'000'000),
        high_first_(ir::setting(device, "word_order") == "high"),
        serial_(ir::find_driver(device.driver)->id == ir::DriverId::kModbusRtu) {
    modbus_set_slave(context_.get(), static_cast<int>(ir::number_setting(device, "unit")));
    modbus_set_byte_timeout(context_.get(), 0, 0);  // the response timeout holds for all of it
  }
  ~Client() override { close(); }

  base::Status exchange(const vm::Exchange& exchange) override {
    deadline_ns_ = now_ns() + timeout_ns_;
    base::Status done = connect();
    if (done.ok() && !exchange.outputs.empty()) {
      done = each(exchange.points.outputs, [&](const PointRange& range, uint32_t at, uint32_t n) {
        return write(exchange, range, at, n);
      });
    }
    if (done.ok() && !exchange.inputs.empty()) {
      done = each(exchange.points.inputs, [&](const PointRange& range, uint32_t at, uint32_t n) {
        return read(exchange, range, at, n);
      });
    }
    return done;
  }

  void disconnect() override { close(); }

 private:
  void close() {
    if (connected_) modbus_close(context_.get());
    connected_ = false;
  }

  base::Status connect() {
    if (connected_) return base::Ok{};
    if (!in_time()) return failed("to connect");
    if (modbus_connect(context_.get()) != 0) {
      if (serial_) return vm::exchange_failed("to connect: " + reason_of_port());
      return failed("to connect");
    }
    connected_ = true;
    return base::Ok{};
  }

  // What is left of the exchange's time is what the next answer may take.
  bool in_time() {
    const int64_t left = deadline_ns_ - now_ns();
    errno = ETIMEDOUT;
    if (left <= 0) return false;
    set_response_timeout(context_.get(), left);
    return true;
  }

  static bool is_bits(const PointRange& range) {
    return range.table == ir::PointTable::kCoil || range.table == ir::PointTable::kDiscrete;
  }

  static std::string name_of(const PointRange& range, uint32_t at, uint32_t count) {
    const auto& table = ir::table_rows()[static_cast<size_t>(range.table)];
    std::string out(table.name);
    out += " " + std::to_string(range.first + at);
    if (count > 1) out += ".." + std::to_string(range.first + at + count - 1);
    return out;
  }

  base::Status failed(const std::string& what) {
    const std::string text = what + ": " + reason();
    if (!is_exception(errno)) close();
    return vm::exchange_failed(text);
  }

  // Calls `part(range, first point in it, points)` for each request.
  template <class Part>
  base::Status each(const std::vector<PointRange>& ranges, Part part) {
    for (const PointRange& range : ranges) {
      const uint32_t most = is_bits(range) ? MODBUS_MAX_WRITE_BITS : MODBUS_MAX_WRITE_REGISTERS;
      for (uint32_t at = 0; at < range.count; at += most) {
        const uint32_t count = std::min(most, range.count - at);
        if (in_time() && part(range, at, count)) continue;
        return failed(name_of(range, at, count));
      }
    }
    return base::Ok{};
  }

  bool write(const vm::Exchange& exchange, const PointRange& range, uint32_t at, uint32_t count) {
    modbus_t* const line = context_.get();
    const int first = static_cast<int>(range.first + at);
    const int number = static_cast<int>(count);
    if (is_bits(range)) {
      for (uint32_t i = 0; i < count; ++i) bits_[i] = get_bit(exchange.outputs, range, at + i);
      return number == 1 ? modbus_write_bit(line, first, bits_[0]) == 1
                         : modbus_write_bits(line, first, number, bits_.data()) == number;
    }
    for (uint32_t i = 0; i < count; ++i) {
      words_[i] = get_register(exchange.outputs, range, at + i, high_first_);
    }
    return number == 1 ? modbus_write_register(line, first, words_[0]) == 1
                       : modbus_write_registers(line, first, number, words_.data()) == number;
  }

  bool read(const vm::Exchange& exchange, const PointRange& range, uint32_t at, uint32_t count) {
    modbus_t* const line = context_.get();
    const int first = static_cast<int>(range.first + at);
    const int number = static_cast<int>(count);
    if (is_bits(range)) {
      const auto read_bits =
          range.table == ir::PointTable::kCoil ? modbus_read_bits : modbus_read_input_bits;
      if (read_bits(line, first, number, bits_.data()) != number) return false;
      for (uint32_t i = 0; i < count; ++i) set_bit(exchange.inputs, range, at + i, bits_[i] != 0);
      return true;
    }
    const auto read_words = range.table == ir::PointTable::kHolding ? modbus_read_registers
                                                                    : modbus_read_input_registers;
    if (read_words(line, first, number, words_.data()) != number) return false;
    for (uint32_t i = 0; i < count; ++i) {
      set_register(exchange.inputs, range, at + i, high_first_, words_[i]);
    }
    return true;
  }

  Context context_;
  const int64_t timeout_ns_;
  const bool high_first_;
  const bool serial_;  // or by TCP
  bool connected_ = false;
  int64_t deadline_ns_ = 0;
  std::array<uint8_t, MODBUS_MAX_READ_BITS> bits_{};
  std::array<uint16_t, MODBUS_MAX_READ_REGISTERS> words_{};
};

}  // namespace

std::unique_ptr<vm::IoDriver> make_client(const ir::Device& device, Context context) {
  return std::make_unique<Client>(device, std::move(context));
}

}  // namespace modbus
