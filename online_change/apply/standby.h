// The second data area of the standby strategy (C2, C3, docs/adr/0011-two-strategies.md). In idle
// time, unit by unit (C5), the areas of the running version are copied to a snapshot and to the
// second area, and the plan's steps carried out from the snapshot to there. Further passes in idle
// time bring blocks that differ from the snapshot by then up to date, in both, and do the steps
// again that touch them; at the boundary that is done once more, from what runs (C7). So the second
// area is what the in-place strategy would have made of the running one, which keeps version 1's
// data. Each pass counts what it found: that is what the boundary will find, if the program goes on
// writing as it does. Until the areas are exchanged the running one is only read.
#pragma once

#include <memory>
#include <vector>

#include "online_change/apply/piece_set.h"
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
  bool is_made() const {  // the first copy
    return copied_ == blocks_.size() && moved_ == transfer_.pieces().size();
  }
  bool rests() const { return is_made() && !passing_; }
  // Another pass over what runs; when it rests.
  void begin_pass();
  uint32_t passes() const { return passes_; }  // that have ended
  // Changes with each unit; 0 when it rests.
  uint64_t units_left() const;
  // At the boundary, when nothing of the first copy is left. False: ended by `on_loss` or
  // interrupted; it can be called again, at a later boundary too.
  bool close(const uint8_t* active, const OnLoss& on_loss, const Interrupted& interrupted);

  // The last close() was interrupted.
  bool behind() const { return behind_; }

  // Version 2's data after close(); whatever is exchanged for it, after that.
  vm::Memory& data() { return data_; }
  // After the switch: all values of version 1, as it found them.
  void put_back(uint8_t* memory) const;
  uint64_t compared_bytes() const { return compared_bytes_; }
  // What the last close() did, and what it would have done at the last pass.
  const BoundaryWork& work() const { return work_; }
  const BoundaryWork& found() const { return found_; }

  // For make().
  Standby(Transfer& transfer, vm::Memory data, vm::Memory snapshot)
      : transfer_(transfer), data_(std::move(data)), snapshot_(std::move(snapshot)) {}

 private:
  void add_blocks(const ir::Image& running);
  bool has_changed(size_t block, const uint8_t* active) const;
  void copy_block(size_t block, const uint8_t* active);
  void add_pieces_of(const ir::Extent& block);
  void move_from_snapshot(size_t piece);
  void look(const uint8_t* active);
  void move_again();
  void end_pass();
  bool copy_drift(const uint8_t* active, const Interrupted& interrupted);

  Transfer& transfer_;
  vm::Memory data_;
  vm::Memory snapshot_;
  std::vector<ir::Extent> blocks_;  // of the running version's areas; none crosses a page
  uint64_t compared_bytes_ = 0;
  PagePieces of_page_;
  // How far the first copy is: blocks that are copied, then pieces that are moved.
  size_t copied_ = 0;
  size_t moved_ = 0;
  // How far a pass is: blocks that were looked at, then where its pieces go on.
  bool passing_ = false;
  size_t looked_ = 0;
  size_t again_at_ = 0;
  uint32_t passes_ = 0;
  PieceSet again_;   // what they read or write has changed since they were moved
  PieceSet always_;  // made at the boundary anyway, or of values there that would lose something
  std::vector<bool> ahead_;  // by block: close() has written newer bytes than the snapshot has
  bool behind_ = false;
  BoundaryWork found_;
  BoundaryWork passed_;  // of the pass that goes on
  BoundaryWork work_;
};

}  // namespace online_change
