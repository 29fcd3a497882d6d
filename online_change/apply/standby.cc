#include "online_change/apply/standby.h"

#include <cstring>

namespace online_change {
namespace {

// Between two looks at the deadline.
constexpr size_t kBlocksPerLook = 16;
// A unit of a pass: bytes that are compared, a copied one for kCopyWeight; and values, one that is
// converted slowly for kSlowWeight. Both are some 10 us.
constexpr uint64_t kUnitBytes = 64u << 10;
constexpr uint64_t kCopyWeight = 4;
constexpr uint64_t kUnitValues = 512;
constexpr uint64_t kSlowWeight = 8;

}  // namespace

uint64_t Standby::units_left() const {
  const size_t pieces = transfer_.pieces().size();
  if (passing_) return 1 + blocks_.size() - looked_ + pieces - again_at_;
  return blocks_.size() - copied_ + pieces - moved_;
}

bool Standby::unit(const uint8_t* active) {
  if (copied_ < blocks_.size()) {
    copy_block(copied_++, active);
  } else if (moved_ < transfer_.pieces().size()) {
    move_from_snapshot(moved_++);
  } else if (!passing_) {
    return false;
  } else if (looked_ < blocks_.size()) {
    look(active);
  } else {
    move_again();
  }
  return true;
}

bool Standby::has_changed(size_t block, const uint8_t* active) const {
  const ir::Extent& at = blocks_[block];
  return ahead_[block] ||
         std::memcmp(active + at.offset, snapshot_.data() + at.offset, at.size) != 0;
}

void Standby::put_back(uint8_t* memory) const {
  for (const ir::Extent& at : blocks_) {
    std::memcpy(memory + at.offset, data_.data() + at.offset, at.size);
  }
}

void Standby::copy_block(size_t block, const uint8_t* active) {
  const ir::Extent& at = blocks_[block];
  std::memcpy(snapshot_.data() + at.offset, active + at.offset, at.size);
  std::memcpy(data_.data() + at.offset, active + at.offset, at.size);
  ahead_[block] = false;
}

void Standby::add_pieces_of(const ir::Extent& block) {
  for (const uint32_t piece : of_page_.of(block.offset / PagePieces::kPageBytes)) again_.add(piece);
}

void Standby::move_from_snapshot(size_t piece) {
  const Piece& one = transfer_.pieces()[piece];
  bool lossy = transfer_.is_late(one);
  auto on_loss = [&](const Loss&) { return lossy = true; };
  transfer_.move(one, snapshot_.data(), data_.data(), on_loss);
  lossy ? always_.add(piece) : always_.remove(piece);
}

void Standby::begin_pass() {
  passing_ = true;
  looked_ = 0;
  again_at_ = 0;
  passed_ = {};
}

void Standby::look(const uint8_t* active) {
  for (uint64_t done = 0; looked_ < blocks_.size() && done < kUnitBytes; ++looked_) {
    const ir::Extent& block = blocks_[looked_];
    done += block.size;
    if (!has_changed(looked_, active)) continue;
    copy_block(looked_, active);
    add_pieces_of(block);
    done += kCopyWeight * block.size;
    passed_.copied += block.size;
  }
}

// What close() would have done is counted with it.
void Standby::move_again() {
  for (uint64_t done = 0; done < kUnitValues; ++again_at_) {
    again_at_ = PieceSet::next_of(again_, always_, again_at_);
    if (again_at_ == PieceSet::kNone) return end_pass();
    const Piece& piece = transfer_.pieces()[again_at_];
    transfer_.count(piece, passed_);
    const bool slow = piece.kind == StepKind::kConvert && piece.fast == nullptr;
    done += piece.count * (slow ? kSlowWeight : 1);
    if (again_.has(again_at_)) move_from_snapshot(again_at_);
  }
}

void Standby::end_pass() {
  passing_ = false;
  ++passes_;
  again_.clear();
  passed_.compared = compared_bytes_;
  found_ = passed_;
}

bool Standby::copy_drift(const uint8_t* active, const Interrupted& interrupted) {
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (i % kBlocksPerLook == 0 && interrupted && interrupted()) return false;
    const ir::Extent& block = blocks_[i];
    work_.compared += block.size;
    if (!has_changed(i, active)) continue;
    std::memcpy(data_.data() + block.offset, active + block.offset, block.size);
    add_pieces_of(block);
    ahead_[i] = true;
    work_.copied += block.size;
  }
  return true;
}

// What a pass has begun is done here too: the pieces of its blocks are in again_ until it ends.
bool Standby::close(const uint8_t* active, const OnLoss& on_loss, const Interrupted& interrupted) {
  work_ = {};
  behind_ = true;
  if (!copy_drift(active, interrupted)) return false;
  for (size_t i = PieceSet::next_of(again_, always_, 0); i != PieceSet::kNone;
       i = PieceSet::next_of(again_, always_, i + 1)) {
    const Piece& piece = transfer_.pieces()[i];
    if (interrupted && interrupted()) return false;
    transfer_.count(piece, work_);
    if (!transfer_.move(piece, active, data_.data(), on_loss)) return behind_ = false;
  }
  behind_ = false;
  return true;
}

}  // namespace online_change
