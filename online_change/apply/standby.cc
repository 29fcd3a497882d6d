#include "online_change/apply/standby.h"

#include <algorithm>
#include <cstring>

namespace online_change {
namespace {

constexpr uint32_t kPageBytes = 4096;
// Areas that are no further apart are copied as one; what lies between them is nobody's.
constexpr uint32_t kGap = 64;
// Between two looks at the deadline.
constexpr size_t kBlocksPerLook = 16;

// Areas of live instances, slack included, in order and joined.
std::vector<ir::Extent> used_extents(const ir::Image& image) {
  std::vector<ir::Extent> areas;
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    const ir::TypeLayout& layout = image.layouts[row.type];
    const uint32_t size = std::max(layout.used, layout.area_capacity);
    if ((id == 0 || row.live) && size != 0) areas.push_back({row.data, size});
  }
  std::sort(areas.begin(), areas.end(),
            [](const ir::Extent& a, const ir::Extent& b) { return a.offset < b.offset; });
  std::vector<ir::Extent> joined;
  for (const ir::Extent& area : areas) {
    if (!joined.empty() && area.offset - joined.back().offset <= joined.back().size + kGap) {
      joined.back().size = area.offset + area.size - joined.back().offset;
    } else {
      joined.push_back(area);
    }
  }
  return joined;
}

uint64_t total(const std::vector<ir::Extent>& extents) {
  uint64_t bytes = 0;
  for (const ir::Extent& one : extents) bytes += one.size;
  return bytes;
}

base::Status check_limit(uint64_t used, uint64_t limit) {
  // The area that runs, the second one, the snapshot.
  if (limit == 0 || 3 * used <= limit) return base::Ok{};
  return base::Error{base::Refusal::kTooLarge,
                     "the standby strategy needs the running program's " + std::to_string(used) +
                         " bytes of data three times while it prepares, " +
                         std::to_string(3 * used) + " bytes; the controller's limit is " +
                         std::to_string(limit) + ", which is " + std::to_string(3 * used - limit) +
                         " less; change in place, or raise the limit"};
}

}  // namespace

base::Result<std::unique_ptr<Standby>> Standby::make(const vm::Generation& running,
                                                     const vm::Generation& next, Transfer& transfer,
                                                     uint64_t limit) {
  const ir::Image& image = running.image();
  base::Status fits = check_limit(total(used_extents(image)), limit);
  if (!fits.ok()) return fits.error();
  base::Result<vm::Memory> data = vm::Memory::reserve();
  if (!data.ok()) return data.error();
  base::Result<vm::Memory> snapshot = vm::Memory::reserve();
  if (!snapshot.ok()) return snapshot.error();
  auto made = std::make_unique<Standby>(transfer, std::move(*data), std::move(*snapshot));
  uint8_t* memory = made->data_.data();
  running.write_pool(memory);
  next.write_pool(memory);
  // So that the first scans find their pages.
  const uint32_t stack = std::max(image.stack_bytes, next.image().stack_bytes);
  std::memset(memory + ir::kStackBegin, 0, stack);
  made->add_blocks(image);
  made->lossy_.resize(transfer.pieces().size());
  return made;
}

void Standby::add_blocks(const ir::Image& running) {
  const std::vector<ir::Extent> extents = used_extents(running);
  for (const ir::Extent& extent : extents) {
    const uint64_t end = uint64_t{extent.offset} + extent.size;
    for (uint64_t at = extent.offset; at < end;) {
      const uint64_t page_end = (at / kPageBytes + 1) * kPageBytes;
      const auto size = static_cast<uint32_t>(std::min(end, page_end) - at);
      blocks_.push_back({static_cast<uint32_t>(at), size});
      at += size;
    }
  }
  compared_bytes_ = total(extents);
  if (!blocks_.empty()) drifted_.resize(blocks_.back().offset / kPageBytes + 1);
}

uint64_t Standby::units_left() const {
  return blocks_.size() - blocks_done_ + transfer_.pieces().size() - pieces_done_;
}

bool Standby::unit(const uint8_t* active) {
  if (blocks_done_ < blocks_.size()) {
    const ir::Extent& block = blocks_[blocks_done_++];
    std::memcpy(snapshot_.data() + block.offset, active + block.offset, block.size);
    std::memcpy(data_.data() + block.offset, active + block.offset, block.size);
    return true;
  }
  if (pieces_done_ == transfer_.pieces().size()) return false;
  auto on_loss = [&](const Loss&) {
    lossy_[pieces_done_] = true;
    return true;
  };
  transfer_.move(transfer_.pieces()[pieces_done_], snapshot_.data(), data_.data(), on_loss);
  ++pieces_done_;
  return true;
}

bool Standby::copy_drift(const uint8_t* active, const Interrupted& interrupted) {
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (i % kBlocksPerLook == 0 && interrupted && interrupted()) return false;
    const ir::Extent& block = blocks_[i];
    work_.compared += block.size;
    const uint8_t* now = active + block.offset;
    if (std::memcmp(now, snapshot_.data() + block.offset, block.size) == 0) continue;
    std::memcpy(data_.data() + block.offset, now, block.size);
    drifted_[block.offset / kPageBytes] = any_drift_ = true;
  }
  return true;
}

bool Standby::drifted_in(uint64_t begin, uint64_t size) const {
  if (size == 0) return false;
  const uint64_t last = std::min<uint64_t>((begin + size - 1) / kPageBytes, drifted_.size() - 1);
  for (uint64_t page = begin / kPageBytes; page <= last; ++page) {
    if (drifted_[page]) return true;
  }
  return false;
}

bool Standby::touches_drift(const Piece& piece) const {
  return any_drift_ && (drifted_in(piece.from, transfer_.source_extent(piece)) ||
                        drifted_in(piece.to, transfer_.target_extent(piece)));
}

bool Standby::close(const uint8_t* active, const OnLoss& on_loss, const Interrupted& interrupted) {
  work_ = {};
  if (!copy_drift(active, interrupted)) return false;
  const std::vector<Piece>& pieces = transfer_.pieces();
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (!lossy_[i] && !transfer_.is_late(pieces[i]) && !touches_drift(pieces[i])) continue;
    if (interrupted && interrupted()) return false;
    transfer_.count(pieces[i], work_);
    if (!transfer_.move(pieces[i], active, data_.data(), on_loss)) return false;
  }
  return true;
}

}  // namespace online_change
