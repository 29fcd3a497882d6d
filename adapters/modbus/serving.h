// What both servers do at an exchange; how requests come is up to each.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>

#include "adapters/modbus/line.h"
#include "adapters/modbus/server_tables.h"

namespace modbus {

inline int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

class Serving : public vm::IoDriver {
 public:
  Serving(const ir::Device& device, Context context)
      : context_(std::move(context)),
        tables_(ir::setting(device, "word_order") == "high"),
        period_ns_(ir::number_setting(device, "period_ms") * 1'000'000),
        timeout_ns_(std::max(ir::number_setting(device, "timeout_ms") * 1'000'000, period_ns_)) {
    set_response_timeout(context_.get(), 1'000'000);  // what it sleeps after nonsense
    modbus_set_byte_timeout(context_.get(), 0, kSlowestByteUs);
  }

  bool ok() const { return tables_.ok(); }

  base::Status exchange(const vm::Exchange& exchange) override {
    idle_ = false;
    base::Status ready = listen();
    if (!ready.ok()) return ready;
    tables_.use(exchange.points);
    writes_ = exchange.writes;
    events_ = exchange.events;
    if (!exchange.outputs.empty()) tables_.show(exchange.outputs);
    base::Status served = serve(steady_ns() + period_ns_);
    if (!served.ok()) return served;
    if (!exchange.inputs.empty()) tables_.fetch(exchange.inputs);
    // Where others only read, nothing is missed when they do not.
    idle_ = !exchange.points.inputs.empty() && steady_ns() - asked_ns_ > timeout_ns_;
    if (!idle_) return base::Ok{};
    return vm::exchange_failed("nobody has asked for " + std::to_string(timeout_ns_ / 1'000'000) +
                               " ms");
  }

  bool idle() const override { return idle_; }

 protected:
  static constexpr uint32_t kSlowestByteUs = 20'000;

  virtual base::Status listen() = 0;
  virtual base::Status serve(int64_t until_ns) = 0;

  // False: the connection is of no use any more.
  bool answer(const uint8_t* request, int length, const std::string& who) {
    if (!tables_.answer(context_.get(), request, length, {who, writes_, events_})) return false;
    asked_ns_ = steady_ns();
    return true;
  }
  modbus_t* context() const { return context_.get(); }
  int64_t period_ns() const { return period_ns_; }

 private:
  Context context_;
  ServerTables tables_;
  const int64_t period_ns_;
  const int64_t timeout_ns_;
  vm::WriteQueue* writes_ = nullptr;
  vm::OutsideEvents* events_ = nullptr;
  bool idle_ = false;
  int64_t asked_ns_ = INT64_MIN / 2;
};

}  // namespace modbus
