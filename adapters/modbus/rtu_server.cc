#include <cerrno>

#include "adapters/modbus/server.h"
#include "adapters/modbus/serving.h"

namespace modbus {
namespace {

class RtuServer : public Serving {
 public:
  RtuServer(const ir::Device& device, Context context)
      : Serving(device, std::move(context)), port_(ir::setting(device, "port")) {
    modbus_set_slave(this->context(), static_cast<int>(ir::number_setting(device, "unit")));
  }
  ~RtuServer() override { close(); }
  void disconnect() override { close(); }

 private:
  void close() {
    if (open_) modbus_close(context());
    open_ = false;
  }

  base::Status listen() override {
    if (open_) return base::Ok{};
    if (modbus_connect(context()) != 0) {
      return vm::exchange_failed(port_ + ": " + reason_of_port());
    }
    open_ = true;
    return base::Ok{};
  }

  // Noise on the line is no failure of it.
  base::Status serve(int64_t until_ns) override {
    uint8_t request[MODBUS_MAX_ADU_LENGTH];
    for (int64_t left = until_ns - steady_ns(); left > 0; left = until_ns - steady_ns()) {
      modbus_set_indication_timeout(context(), static_cast<uint32_t>(left / 1'000'000'000),
                                    static_cast<uint32_t>(left % 1'000'000'000 / 1000 + 1));
      const int length = modbus_receive(context(), request);
      if (length > 0) answer(request, length, port_);
      const bool gone = length < 0 && (errno == EIO || errno == EBADF || errno == ENXIO ||
                                       errno == ECONNRESET || errno == ENODEV);
      if (!gone) continue;
      const std::string text = port_ + ": " + reason();
      close();
      return vm::exchange_failed(text);
    }
    return base::Ok{};
  }

  const std::string port_;
  bool open_ = false;
};

}  // namespace

base::Result<std::unique_ptr<vm::IoDriver>> make_rtu_server(const ir::Device& device,
                                                            Context context) {
  auto server = std::make_unique<RtuServer>(device, std::move(context));
  if (!server->ok()) return base::Error{base::Refusal::kDeviceFailed, "out of memory"};
  return std::unique_ptr<vm::IoDriver>(std::move(server));
}

}  // namespace modbus
