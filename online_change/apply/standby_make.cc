// What a second data area needs before idle time fills it.
#include <algorithm>
#include <cstring>

#include "online_change/apply/standby.h"
#include "online_change/apply/used_data.h"

namespace online_change {
namespace {

constexpr uint32_t kPageBytes = PagePieces::kPageBytes;

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
  base::Status fits = check_limit(total_bytes(used_extents(image)), limit);
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
  compared_bytes_ = total_bytes(extents);
  ahead_.resize(blocks_.size());
  const size_t pages = blocks_.empty() ? 0 : blocks_.back().offset / kPageBytes + 1;
  of_page_ = PagePieces(transfer_, pages);
  const std::vector<Piece>& pieces = transfer_.pieces();
  again_ = PieceSet(pieces.size());
  always_ = PieceSet(pieces.size());
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (transfer_.is_late(pieces[i])) always_.add(i);
  }
}

}  // namespace online_change
