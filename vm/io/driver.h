// One device behind one driver, as the exchange sees it. A driver is used by one thread, may block
// as long as its timeout says, and connects again by itself: the exchange asks it again later.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "ir/bytecode/devices.h"
#include "vm/io/device_events.h"
#include "vm/io/write_queue.h"

namespace vm {

// Points of one table, and where their values are in the exchanged bytes: as in the process image,
// values little endian, bits packed from bit 0 of a byte on.
struct PointRange {
  ir::PointTable table = ir::PointTable::kBit;
  uint32_t first = 0;
  uint32_t count = 0;
  uint32_t byte = 0;
  ir::DirectAddress at;   // at.bit_size: of one value
  bool writable = false;  // an output that others write, too

  uint32_t bits() const;
  friend bool operator==(const PointRange&, const PointRange&) = default;
};

// What one device exchanges for one version of the program.
struct DevicePoints {
  std::vector<PointRange> inputs;
  std::vector<PointRange> outputs;
  uint32_t input_bytes = 0;
  uint32_t output_bytes = 0;

  friend bool operator==(const DevicePoints&, const DevicePoints&) = default;
};
DevicePoints points_of(const ir::Device& device);
// What `old` writes and `next` does not, with bytes of their own.
DevicePoints outputs_without(const DevicePoints& old, const DevicePoints* next);

struct Exchange {
  const DevicePoints& points;
  base::ByteSpan outputs;        // empty: nothing is written
  std::span<uint8_t> inputs;     // as they were; empty: nothing is read
  int64_t now_ns = 0;            // since the controller began
  WriteQueue* writes = nullptr;  // of what others write to outputs; null: there are none to write
  OutsideEvents* events = nullptr;
};

class IoDriver {
 public:
  virtual ~IoDriver() = default;
  // Writes and reads once, connecting first where that is needed. After an error nothing is known
  // of what was written, and `inputs` are not used.
  virtual base::Status exchange(const Exchange& exchange) = 0;
  // Did the last exchange fail only because nobody wanted anything of it?
  virtual bool idle() const { return false; }
  // Lets the line go; the next exchange connects again.
  virtual void disconnect() {}
};

// Makes the driver of a checked device. kNoDriver, kDeviceFailed.
using DriverFactory =
    std::function<base::Result<std::unique_ptr<IoDriver>>(const ir::Device& device)>;

// The error of an exchange.
base::Error exchange_failed(std::string text);

}  // namespace vm
