// Globals of a CONFIGURATION between its resources, which run in one process with a control thread
// and data memory each (docs/adr/0017-resources.md).
//
// After each of its cycles a resource publishes all that it writes and another one reads, as one
// block; when a cycle of the other one begins, the newest block is taken. So a scan sees values of
// one cycle of the writer, whole, and they do not change while it runs. Neither side waits, locks
// or allocates: between each two versions that meet there is a triple buffer.
//
// What is exchanged follows from the versions that run: variables of the same name and type, one
// side writes, the other does not. prepare() makes the buffers of a version beside those in use, so
// a change and its undo only have to say which version runs. A version that would write what
// another resource writes is refused. Variables whose types differ are left alone until they are
// the same again, and status() says so.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ir/bytecode/verify.h"
#include "vm/runtime/ports.h"

namespace vm {

inline constexpr const char* kStagedState = "staged";

class GlobalExchange {
 public:
  struct Resource {
    std::string name;
    ir::VerifiedImage image;  // that it will start with
  };
  // kTwoWriters.
  static base::Result<std::unique_ptr<GlobalExchange>> make(const std::vector<Resource>& resources);
  GlobalExchange();  // of nobody: see make()
  ~GlobalExchange();

  size_t size() const { return members_.size(); }

 private:
  friend class ResourcePort;
  struct Edition;
  struct Link;
  struct Network;
  class Section;
  struct Member;

  // Off the control threads.
  base::Status prepare(size_t resource, const ir::VerifiedImage& version);
  void settle(size_t resource);
  std::vector<DeviceStatus> status(size_t resource, int64_t now_ns) const;
  std::vector<std::string> faults(size_t resource, uint32_t mine, size_t other) const;
  base::Status check_writers(size_t resource, const Edition& edition) const;
  void forget_unused(size_t resource);
  void connect();
  // Control thread of the resource.
  void use(size_t resource, const base::Digest& version);
  void take(size_t resource, uint8_t* memory, int64_t now_ns);
  void publish(size_t resource, const uint8_t* memory);

  std::vector<std::unique_ptr<Member>> members_;
  mutable std::mutex mutex_;  // of whoever prepares and asks; never of a control thread
  uint32_t last_number_ = 0;
  std::unique_ptr<const Network> owned_;
  std::atomic<const Network*> network_{nullptr};
};

// The devices of one resource, and its share of the exchange, as the one IoPort of its controller.
class ResourcePort : public IoPort {
 public:
  // All of them must outlive it.
  ResourcePort(GlobalExchange& exchange, size_t resource, Clock& clock, IoPort& devices)
      : exchange_(exchange), resource_(resource), clock_(clock), devices_(devices) {}

  base::Status prepare(const ir::VerifiedImage& version) override;
  void use(const base::Digest& version) override;
  void settle() override;
  void at_boundary(const ProcessImage& image, uint8_t* memory) override {
    devices_.at_boundary(image, memory);
  }
  void take_globals(const SharedGlobals&, uint8_t* memory) override {
    exchange_.take(resource_, memory, clock_.now_ns());
  }
  void publish_globals(const SharedGlobals&, const uint8_t* memory) override {
    exchange_.publish(resource_, memory);
  }
  // After the rows of the devices, with the driver "resource": one for each other resource that it
  // takes values from or has a type in common with that differs; and one, in the state
  // kStagedState, for each variable that a prepared version would no longer exchange.
  std::vector<DeviceStatus> status() const override;
  void receive(std::span<uint8_t> inputs) override { devices_.receive(inputs); }
  void lost_tasks(std::span<uint8_t> tasks) override { devices_.lost_tasks(tasks); }
  void send(std::span<const uint8_t> outputs) override { devices_.send(outputs); }

 private:
  GlobalExchange& exchange_;
  size_t resource_;
  Clock& clock_;
  IoPort& devices_;
};

}  // namespace vm
