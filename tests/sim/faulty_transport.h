// The way between a tool and a controller, in one thread, with what can happen to a message on it.
#pragma once

#include "tests/differential/random.h"
#include "vm/runtime/ports.h"
#include "vm/runtime/socket_server.h"

namespace sim {

enum class Fault : uint8_t {
  kNone,
  kRequestLost,  // the connection goes before the controller gets it
  kAnswerLost,   // it is carried out, and nobody hears of it
  kTwice,        // the controller gets it again: a replay
  kDamaged,      // one bit of the request is another one
  kCut,          // the end of the request is missing
};
inline constexpr uint32_t kFaultCount = 6;

class FaultyTransport : public vm::Transport {
 public:
  explicit FaultyTransport(vm::Service& service) : service_(service) {}

  // The exchange after `exchanges` more has this fault; those behind it find the connection lost.
  void arm(Fault fault, uint32_t exchanges, uint64_t seed);
  base::Result<base::Bytes> exchange(base::ByteSpan request) override;
  bool lost() const { return lost_; }
  // Has it a fault, or had it one?
  bool armed() const { return armed_; }

 private:
  vm::Service& service_;
  Fault fault_ = Fault::kNone;
  uint32_t exchanges_ = 0;
  uint64_t seed_ = 0;
  bool lost_ = false;
  bool armed_ = false;
};

}  // namespace sim
