#include "online_change/apply/handle_transfer.h"

#include <cstring>

#include "ir/types/handle.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/reference_leaves.h"

namespace online_change {
namespace {

uint64_t load_handle(const uint8_t* memory, uint32_t at) {
  uint64_t handle = 0;
  std::memcpy(&handle, memory + at, sizeof handle);
  return handle;
}

void store(uint8_t* memory, uint32_t at, uint64_t handle) {
  std::memcpy(memory + at, &handle, sizeof handle);
}

}  // namespace

HandleTransfer::HandleTransfer(const ir::Image& old_image, const ir::Image& new_image)
    : old_(old_image),
      moves_(old_image, new_image),
      moves_back_(new_image, old_image, PlaceMoves::Way::kBack) {
  if (moves_.trivial() && moves_back_.trivial()) return;
  for (const ReferenceLeaf& leaf : reference_leaves(new_image)) {
    references_.push_back({leaf.at, moves_.target_in_new(new_image, leaf.type),
                           moves_back_.target_in_old(new_image, leaf.type), 0, 0, 0});
  }
}

void HandleTransfer::for_each_broken(
    const uint8_t* memory, const std::function<void(uint32_t at, ir::TypeId type)>& visit) const {
  if (moves_.trivial()) return;
  const Areas areas(old_);
  for (const ReferenceLeaf& leaf : reference_leaves(old_)) {
    const uint64_t handle = load_handle(memory, leaf.at);
    const Target target = moves_.target_in_old(old_, leaf.type);
    if (handle == 0 || !moves_.follow(handle, target).gone) continue;
    const std::optional<uint32_t> id = areas.instance_at(leaf.at);
    if (!id) continue;
    const uint32_t segment = ir::area_segment(*id, old_.instances[*id].generation);
    const uint64_t itself = ir::make_handle(segment, leaf.at - areas.begin(*id));
    if (moves_.follow(itself, Target{0xffffffffu, false}).handle != 0) visit(leaf.at, leaf.type);
  }
}

std::optional<uint32_t> HandleTransfer::forward(uint8_t* memory, bool allow_loss,
                                                const Interrupted& interrupted) {
  for (size_t i = 0; i < references_.size(); ++i) {
    Reference& one = references_[i];
    one.before = one.after = load_handle(memory, one.at);
    if (one.before == 0) continue;
    const Followed now = moves_.follow(one.before, one.there);
    const bool stop = interrupted && interrupted();
    if (stop || (now.gone && !allow_loss)) {
      while (i-- > 0) store(memory, references_[i].at, references_[i].before);
      return stop ? kInterrupted : one.at;
    }
    one.after = now.handle;
    if (one.after != one.before) store(memory, one.at, one.after);
  }
  return std::nullopt;
}

void HandleTransfer::restore_forward(uint8_t* memory) const {
  for (const Reference& one : references_) store(memory, one.at, one.before);
}

bool HandleTransfer::back(uint8_t* memory, const Interrupted& interrupted) {
  for (size_t i = 0; i < references_.size(); ++i) {
    Reference& one = references_[i];
    one.saved = load_handle(memory, one.at);
    if (interrupted && interrupted()) {
      while (i-- > 0) store(memory, references_[i].at, references_[i].saved);
      return false;
    }
    const bool untouched = one.before != 0 && one.saved == one.after;
    const uint64_t then = untouched ? one.before : moves_back_.follow(one.saved, one.back).handle;
    if (then != one.saved) store(memory, one.at, then);
  }
  return true;
}

void HandleTransfer::restore(uint8_t* memory) const {
  for (const Reference& one : references_) store(memory, one.at, one.saved);
}

}  // namespace online_change
