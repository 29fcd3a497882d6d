// The interfaces through which every outside effect goes (invariant 6). The
// simulator replaces them all.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace ir {
class VerifiedImage;
}

namespace vm {

class ProcessImage;
class SharedGlobals;

// Time in ns since the controller started; never goes back.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual int64_t now_ns() = 0;
  // Returns at or after `deadline_ns`.
  virtual void wait_until(int64_t deadline_ns) = 0;
  // The executions just done took `safe_points`; a virtual clock may let time pass for it.
  virtual void consumed(uint64_t safe_points) = 0;
  // Work has just been done that is expected to take so long (at a boundary, by the model of the
  // pause, online_change/plan/pause.h); a virtual clock lets that time pass.
  virtual void worked(int64_t expected_ns) = 0;
  // How long a scan of that task lasts at least, without what runs above it: only a virtual clock
  // says more than 0 (B11).
  virtual int64_t scan_ns(std::string_view /*task*/) const { return 0; }
};

struct DeviceStatus {
  std::string name;
  std::string driver;
  std::string state;  // "waiting", "online", "lost", "off"
  uint64_t exchanges = 0;
  uint64_t errors = 0;
  int64_t age_ns = -1;  // of the newest inputs; -1: there never were any
  std::string error;    // the last one
  uint64_t writes = 0;  // of others to %Q and %M
  std::string last_writer = {};
  int64_t error_age_ns = -1;  // since when `error` is known; -1: not at all, or in virtual time
};

// Field devices: the process image as the driver sees it. Called by the control thread outside of
// all scans, or before and after one while others are suspended (B12); must not block.
class IoPort {
 public:
  virtual ~IoPort() = default;

  // Off the control thread: makes the devices of `version` ready beside those that are used;
  // whatever else was prepared is gone.
  virtual base::Status prepare(const ir::VerifiedImage& version);
  // At a boundary: the devices of that version, which was prepared or used before, from now on.
  virtual void use(const base::Digest& /*version*/) {}
  // Off the control thread: nothing but what is used will be needed any more.
  virtual void settle() {}
  // Control thread, at a boundary after each cycle: for devices that exchange %M, or let others
  // write %Q. `memory` is data memory, `image` says where variables are in it.
  virtual void at_boundary(const ProcessImage& /*image*/, uint8_t* /*memory*/) {}
  // Control thread, at a boundary: when a cycle begins, values of globals that other resources
  // write; after it, those that this one writes (shared_globals.h).
  virtual void take_globals(const SharedGlobals& /*globals*/, uint8_t* /*memory*/) {}
  virtual void publish_globals(const SharedGlobals& /*globals*/, const uint8_t* /*memory*/) {}
  // Off the control thread.
  virtual std::vector<DeviceStatus> status() const;

  // Fills `inputs` (%I bytes) with the newest values.
  virtual void receive(std::span<uint8_t> inputs) = 0;
  // Control thread, after each receive(): the byte of each task whose device was online and has
  // been lost since becomes 1; `tasks` are those of the version that is used, in its order.
  virtual void lost_tasks(std::span<uint8_t> /*tasks*/) {}
  // Takes a consistent copy of `outputs` (%Q bytes).
  virtual void send(std::span<const uint8_t> outputs) = 0;
};

// Durable files of fixed size, by name ("slot_a", "control_0"). Nothing is repeated after a
// failure: what a failed call leaves in its file is unknown, up to a mixture, and only replace()
// makes it known again. What is written is durable when sync() of that file has returned without an
// error, and in no order before.
class Storage {
 public:
  struct Piece {
    uint64_t offset = 0;
    base::ByteSpan bytes;
  };

  virtual ~Storage() = default;
  // The file is there, durably, with room for at least `size` bytes: what it holds stays, new bytes
  // are zero. Before anything else is done with it. After an error it may still be readable.
  virtual base::Status open(std::string_view name, uint64_t size) = 0;
  // The size of a file, opened or not; kFileNotFound.
  virtual base::Result<uint64_t> size(std::string_view name) = 0;
  // `size` bytes from `offset` on, fewer where the file ends.
  virtual base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) = 0;
  // Inside the size that was opened.
  virtual base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) = 0;
  // An error too when what was written can no longer be found by its name (check()).
  virtual base::Status sync(std::string_view name) = 0;
  // A new file of `size` bytes, these pieces and zeros, takes the place of whatever the name leads
  // to. It is durable when it returns without an error; after an error or a cut the name leads to
  // the old file or to the whole new one. Nothing of the old one is used, so calls for it may have
  // failed, and it may be gone.
  virtual base::Status replace(std::string_view name, uint64_t size,
                               std::span<const Piece> pieces) = 0;
  // Does the name still lead to the file that was opened? kFileNotFound: no, somebody has removed
  // it or put another one there. Any other error: nobody can tell now.
  virtual base::Status check(std::string_view name) = 0;
};

// One request in, one answer out; framing is the transport's affair.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual base::Result<base::Bytes> exchange(base::ByteSpan request) = 0;
};

}  // namespace vm
