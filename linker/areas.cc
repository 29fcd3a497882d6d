#include "linker/areas.h"

#include <algorithm>
#include <span>

#include "base/limits.h"
#include "linker/extents.h"

namespace linker {
namespace {

constexpr uint32_t kAreaAlign = 8;

class Placer {
 public:
  Placer(ir::Image& image, const Slack& slack, const ir::Image* base, bool move_all)
      : image_(image), slack_(slack), base_(base), move_all_(move_all) {}

  base::Result<AreaPlan> place() {
    set_up_free_space();
    std::vector<uint32_t> moving;
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (image_.instances[id].live && !keep(id)) moving.push_back(id);
    }
    if (base_ != nullptr) release();
    for (size_t i = 0; i < moving.size(); ++i) {
      if (!find_place(moving[i])) return out_of_memory(std::span(moving).subspan(i));
    }
    return finish();
  }

 private:
  uint64_t size_of(uint32_t id) const {
    return image_.layouts[image_.instances[id].type].area_capacity;
  }

  bool lived_before(uint32_t id) const {
    return base_ != nullptr && id < base_->instances.size() && base_->instances[id].live &&
           base_->instances[id].generation == image_.instances[id].generation;
  }

  ir::Extent old_area(uint32_t id) const {
    const ir::Instance& row = base_->instances[id];
    return {row.data, base_->layouts[row.type].area_capacity};
  }

  void set_up_free_space() {
    if (base_ == nullptr) {
      free_.add(ir::kDataBegin, base::kMaxDataBytes - ir::kDataBegin);
      return;
    }
    capacity_ = base_->data_capacity;
    for (const ir::Extent& extent : base_->free) free_.add(extent.offset, extent.size);
  }

  // The globals have no ID that could hide a move, but code is relinked anyway.
  bool keep(uint32_t id) {
    if (!lived_before(id) || (move_all_ && id != 0)) return false;
    if (old_area(id).size != size_of(id)) return false;
    image_.instances[id].data = old_area(id).offset;
    kept_.resize(image_.instances.size(), false);
    kept_[id] = true;
    return true;
  }

  void release() {
    kept_.resize(image_.instances.size(), false);
    for (uint32_t id = 0; id < base_->instances.size(); ++id) {
      if (!base_->instances[id].live || kept_[id]) continue;
      const ir::Extent area = old_area(id);
      freed_.add(area.offset, area.size);
    }
  }

  bool find_place(uint32_t id) {
    const uint64_t size = size_of(id);
    std::optional<uint64_t> at = free_.first_fit(size);
    if (!at && !freed_.empty()) {
      for (const auto& [begin, end] : freed_.ranges()) free_.add(begin, end - begin);
      freed_ = Extents();
      at = free_.first_fit(size);
    }
    if (!at && grow()) at = free_.first_fit(size);
    if (!at) return false;
    image_.instances[id].data = static_cast<uint32_t>(*at);
    free_.remove(*at, size);
    return true;
  }

  // Data memory grows when a change needs it (case 71): to what the areas of the running version
  // take, and the free area of the project after them. So the same program again changes nothing.
  bool grow() {
    if (base_ == nullptr) return false;
    const uint32_t grown = capacity_behind(*base_, [&](uint32_t id) { return old_area(id); });
    if (grown <= capacity_) return false;
    free_.add(capacity_, grown - capacity_);
    capacity_ = grown;
    return true;
  }

  // Where areas of these sizes would end that go one after the other to the end of data memory.
  uint64_t end_of(std::span<const uint32_t> ids) const {
    uint64_t end = capacity_;
    for (const auto& [begin, behind] : free_.ranges()) {
      if (behind == capacity_) end = begin;
    }
    for (const uint32_t id : ids) end += size_of(id);
    return end;
  }

  // A7: what did not fit, by how much, and what all of it needs.
  base::Error out_of_memory(std::span<const uint32_t> left) const {
    const uint32_t id = left.front();
    const std::string what = id == 0 ? "the global variables"
                                     : "instance `" + image_.instance_path(id) + "` (" +
                                           image_.types[image_.instances[id].type].name + ")";
    const uint64_t size = size_of(id);
    const uint64_t largest = free_.largest();
    std::string text = what + " needs an area of " + std::to_string(size) +
                       " bytes; the largest free area has " + std::to_string(largest) + " bytes, " +
                       std::to_string(size - largest) + " too few";
    if (left.size() > 1) text += ", and " + std::to_string(left.size() - 1) + " more have no place";
    const uint64_t end = end_of(left);
    if (base_ == nullptr || end > base::kMaxDataBytes) {
      return {base::Refusal::kOutOfMemory, text + "; data memory ends at " +
                                               std::to_string(base::kMaxDataBytes) + " bytes"};
    }
    const uint64_t behind = end - used_end(*base_, [&](uint32_t old) { return old_area(old); });
    return {base::Refusal::kOutOfMemory,
            text + ". Write `free_bytes = " + std::to_string(behind) +
                "` into [slack] of stc.toml, and data memory grows by this change; or free "
                "something."};
  }

  base::Result<AreaPlan> finish() {
    AreaPlan plan;
    for (const auto& [begin, end] : freed_.ranges()) free_.add(begin, end - begin);
    plan.data_capacity = base_ != nullptr ? capacity_ : first_capacity();
    if (base_ == nullptr) {
      const uint64_t limit = base::kMaxDataBytes;
      if (plan.data_capacity < limit) free_.remove(plan.data_capacity, limit - plan.data_capacity);
    }
    for (const auto& [begin, end] : free_.ranges()) {
      plan.free.push_back({static_cast<uint32_t>(begin), static_cast<uint32_t>(end - begin)});
    }
    return plan;
  }

  uint32_t first_capacity() const {
    return capacity_behind(image_, [&](uint32_t id) {
      return ir::Extent{image_.instances[id].data, static_cast<uint32_t>(size_of(id))};
    });
  }

  template <class AreaOf>
  static uint64_t used_end(const ir::Image& image, const AreaOf& area_of) {
    uint64_t end = ir::kDataBegin;
    for (uint32_t id = 0; id < image.instances.size(); ++id) {
      if (!image.instances[id].live) continue;
      const ir::Extent area = area_of(id);
      end = std::max(end, uint64_t{area.offset} + area.size);
    }
    return end;
  }

  template <class AreaOf>
  uint32_t capacity_behind(const ir::Image& image, const AreaOf& area_of) const {
    const uint64_t end = used_end(image, area_of);
    const uint64_t areas = end - ir::kDataBegin;
    const uint64_t share = areas * slack_.free_percent / 100;
    const uint64_t behind = std::max<uint64_t>(slack_.free_bytes, share);
    const uint64_t capacity = (end + behind + kAreaAlign - 1) / kAreaAlign * kAreaAlign;
    return static_cast<uint32_t>(std::min<uint64_t>(capacity, base::kMaxDataBytes));
  }

  ir::Image& image_;
  const Slack& slack_;
  const ir::Image* base_;
  bool move_all_;
  Extents free_;
  Extents freed_;
  std::vector<bool> kept_;
  uint32_t capacity_ = 0;  // with a base
};

}  // namespace

base::Result<AreaPlan> place_areas(ir::Image& image, const Slack& slack, const ir::Image* base,
                                   bool move_all) {
  return Placer(image, slack, base, move_all).place();
}

}  // namespace linker
