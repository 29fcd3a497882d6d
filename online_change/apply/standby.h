// The second data area of the standby strategy (C2, C3, docs/adr/0011-two-strategies.md). In idle
// time, unit by unit (C5), the areas of the running version are copied to a snapshot and to the
// second area, and the plan's steps carried out from the snapshot to there. At the boundary, blocks
// that differ from the snapshot by then are copied again and the steps that touch them done again
// (C7): so the second area is what the in-place strategy would have made of the running one, which
// keeps version 1's data. Until the areas are exchanged the running one is only read.
#pragma once

#include <memory>
#include <vector>

#include "online_change/apply/transfer.h"
#include "vm/exec/memory.h"
#include "vm/load/generation.h"

namespace online_change {

class Standby {
 public:
  // `transfer` is of kind kApart and outlives it. Not at a boundary: reserves memory, and writes
  // the constant pools of both generations. Refuses (kTooLarge) what does not fit into `limit`
  // bytes (0: no limit) together with the running version's data.
  static base::Result<std::unique_ptr<Standby>> make(const vm::Generation& running,
                                                     const vm::Generation& next, Transfer& transfer,
                                                     uint64_t limit);

  // The next unit of idle time's work. False: nothing was left.
  bool unit(const uint8_t* active);
  uint64_t units_left() const;
  // At the boundary, when no unit is left. False: ended by `on_loss` or interrupted.
  bool close(const uint8_t* active, const OnLoss& on_loss, const Interrupted& interrupted);

  // Version 2's data behind close(); whatever is exchanged for it, after that.
  vm::Memory& data() { return data_; }
  uint64_t compared_bytes() const { return compared_bytes_; }
  // What the last close() did.
  const BoundaryWork& work() const { return work_; }

  // For make().
  Standby(Transfer& transfer, vm::Memory data, vm::Memory snapshot)
      : transfer_(transfer), data_(std::move(data)), snapshot_(std::move(snapshot)) {}

 private:
  void add_blocks(const ir::Image& running);
  bool copy_drift(const uint8_t* active, const Interrupted& interrupted);
  bool touches_drift(const Piece& piece) const;
  bool drifted_in(uint64_t begin, uint64_t size) const;

  Transfer& transfer_;
  vm::Memory data_;
  vm::Memory snapshot_;
  std::vector<ir::Extent> blocks_;  // of the running version's areas; none crosses a page
  uint64_t compared_bytes_ = 0;
  size_t blocks_done_ = 0;
  size_t pieces_done_ = 0;
  std::vector<bool> lossy_;    // by piece: its values in the snapshot would lose something
  std::vector<bool> drifted_;  // by page
  bool any_drift_ = false;
  BoundaryWork work_;
};

}  // namespace online_change
