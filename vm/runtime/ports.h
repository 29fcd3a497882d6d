// The interfaces through which every outside effect goes (invariant 6). The
// simulator replaces them all.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/result.h"

namespace vm {

// Time in ns since the controller started; never goes back.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual int64_t now_ns() = 0;
  // Returns at or after `deadline_ns`.
  virtual void wait_until(int64_t deadline_ns) = 0;
  // The executions just done took `safe_points`; a virtual clock may let time pass for it.
  virtual void consumed(uint64_t safe_points) = 0;
};

// Field devices: the process image as the driver sees it. Called by the control
// thread between scans; must not block.
class IoPort {
 public:
  virtual ~IoPort() = default;
  // Fills `inputs` (%I bytes) with the newest values.
  virtual void receive(std::span<uint8_t> inputs) = 0;
  // Takes a consistent copy of `outputs` (%Q bytes).
  virtual void send(std::span<const uint8_t> outputs) = 0;
};

// Durable records of fixed maximum size, by name ("slot_a", "control", "retain_0").
class Storage {
 public:
  virtual ~Storage() = default;
  virtual base::Result<base::Bytes> read(std::string_view name) = 0;
  // All or nothing, durable when it returns.
  virtual base::Status write(std::string_view name, base::ByteSpan bytes) = 0;
  virtual bool exists(std::string_view name) = 0;
};

// One request in, one answer out; framing is the transport's affair.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual base::Result<base::Bytes> exchange(base::ByteSpan request) = 0;
};

}  // namespace vm
