// A controller as `stvm serve` makes it, in one thread on a storage of the test: it boots, answers
// requests, is changed, and comes back after a cut.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "online_change/store/boot.h"
#include "tools/stvm/controller_service.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/io.h"

namespace plc {

// Compiled, linked against `base` when there is one, verified.
ir::VerifiedImage build(const std::string& source, const ir::Image* base = nullptr);

class Plc : public vm::Boundary {
 public:
  explicit Plc(vm::Storage& storage) : storage_(storage) {}

  // With a source it is given that program, as on the command line.
  base::Status boot(const std::string& source = {});
  base::Status boot(const std::optional<ir::VerifiedImage>& given, bool create = false);

  void run(int scans);
  std::string get(const std::string& path) const;
  void set(const std::string& path, const std::string& value);
  // The retained values of now are durable.
  base::Status save();

  base::Status change(const std::string& source, uint32_t flags = vm::kAllowLoss);
  base::Status change(const ir::VerifiedImage& next, uint32_t flags = vm::kAllowLoss,
                      const std::string& health = {});
  base::Status undo() { return ask(vm::Command::kUndo); }
  // What a clean end stores (D4); then boot() is the next start.
  void stop();
  base::Status accept() { return ask(vm::Command::kAccept); }
  base::Status ask(vm::Command command) { return ask(vm::Request{.command = command}); }
  base::Status ask(vm::Request request);
  base::Result<base::Bytes> answer_to(vm::Request request);
  base::Status stage(const ir::VerifiedImage& next);
  vm::StatusReport status();

  // Asked at each boundary that a command needs; what is not kDone comes instead of its job.
  std::function<Outcome()> at_boundary;
  // The keys that the next boot() starts it with; none at first.
  std::function<std::unique_ptr<stvm::Trust>(online_change::Store&)> make_trust;
  int64_t wall_ns = 2;  // since 1970
  uint64_t most_upload = base::kMaxImageBytes;  // of the next boot()
  // Called behind each job.
  std::function<void()> behind_job;
  // As in a replay: no cycle comes by itself.
  void stand() {
    stands_ = true;
    service_->stand_between_cycles();
  }

  vm::Controller& controller() { return *controller_; }
  vm::VirtualClock& clock() { return clock_; }
  vm::Service& service() { return *service_; }
  online_change::Store& store() { return *store_; }
  // What its field devices say of themselves; there are none at first.
  std::vector<vm::DeviceStatus>& devices() { return io_.devices; }
  const online_change::Boot& found() const { return *boot_; }

 private:
  struct Field : vm::NullIo {
    std::vector<vm::DeviceStatus> status() const override { return devices; }
    std::vector<vm::DeviceStatus> devices;
  };

  Outcome run(const std::function<void()>& job, int64_t timeout_ns) override;
  void pause(int64_t) override {
    if (!stands_) controller_->cycle();
  }

  vm::Storage& storage_;
  bool stands_ = false;
  vm::VirtualClock clock_;
  Field io_;
  std::unique_ptr<online_change::Store> store_;
  std::optional<online_change::Boot> boot_;
  std::unique_ptr<stvm::Trust> trust_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<stvm::ControllerService> service_;
};

}  // namespace plc
