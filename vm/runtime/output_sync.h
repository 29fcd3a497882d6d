// The complete outputs of one task on their way from its scans to what is sent, by the strategy of
// its policy (B5, B6). The work buffer of a scan are the variables: it reads back what it has
// written there, and nothing of it is here before the scan has ended. Of all kinds but
// kFirstUnseen, take() gives what the last scan that has ended left.
#pragma once

#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "ir/bytecode/image.h"
#include "vm/runtime/task_activity.h"

namespace vm {

class OutputSync {
 public:
  // No buffers: the scans' outputs are copied to what is sent next when they end.
  OutputSync() = default;
  OutputSync(ir::IoBuffer strategy, size_t bytes);
  bool used() const { return bytes_ != 0; }
  // At a change: what waits in `old`, of as many bytes, waits here. Both are used().
  void keep(OutputSync& old);

  // All spans have the bytes of the constructor. A scan has ended: the bits of `changed` in
  // `outputs` are what it has changed.
  void write(std::span<const uint8_t> outputs, std::span<const uint8_t> changed);
  // For a transmission: what is to be sent next goes to `outputs`; `taken` becomes which bits.
  void take(std::span<uint8_t> outputs, std::span<uint8_t> taken);
  // Does anything wait for a later transmission? Its bits are set in `waiting`.
  bool waits();
  void mark(std::span<uint8_t> waiting);
  // Tells that those bits of that byte have been written from outside.
  void forget(size_t byte, uint8_t bits);
  void restart();

  // What waits has to be taken before a scan begins, because the scan has the only buffer.
  bool takes_before_scan() const { return strategy_ == ir::IoBuffer::kLocked; }
  // `fresh`: complete outputs of the task have not been sent. `locked`: a scan goes on.
  BufferState state(bool fresh, bool locked) const;

 private:
  // The parts of a buffer: values, and which bits of them have not been taken.
  std::span<uint8_t> values(uint8_t buffer) { return part(2u * buffer); }
  std::span<uint8_t> mask(uint8_t buffer) { return part(2u * buffer + 1); }
  std::span<uint8_t> part(size_t number) {
    return std::span(storage_).subspan(number * bytes_, bytes_);
  }
  uint8_t next();
  void carry(uint8_t from, uint8_t to);
  void take_newest(std::span<const uint8_t> sent);

  ir::IoBuffer strategy_ = ir::IoBuffer::kCopied;
  uint8_t count_ = 0;  // of buffers
  size_t bytes_ = 0;
  base::Bytes storage_;
  uint8_t write_ = 0;
  uint8_t wait_ = 2;
  uint8_t read_ = 1;
  bool fresh_ = false;  // written, and not taken
};

}  // namespace vm
