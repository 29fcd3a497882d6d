#include "linker/areas.h"

#include <algorithm>

#include "base/limits.h"
#include "linker/extents.h"

namespace linker {
namespace {

constexpr uint32_t kAreaAlign = 8;

class Placer {
 public:
  Placer(ir::Image& image, const ir::Image* base, bool move_all)
      : image_(image), base_(base), move_all_(move_all) {}

  base::Result<AreaPlan> place(const Slack& slack) {
    set_up_free_space();
    std::vector<uint32_t> moving;
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (image_.instances[id].live && !keep(id)) moving.push_back(id);
    }
    if (base_ != nullptr) release();
    for (uint32_t id : moving) {
      if (base::Status status = find_place(id); !status.ok()) return status.error();
    }
    return finish(slack);
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

  base::Status find_place(uint32_t id) {
    const uint64_t size = size_of(id);
    std::optional<uint64_t> at = free_.first_fit(size);
    if (!at && !freed_.empty()) {
      for (const auto& [begin, end] : freed_.ranges()) free_.add(begin, end - begin);
      freed_ = Extents();
      at = free_.first_fit(size);
    }
    if (!at) return out_of_memory(id);
    image_.instances[id].data = static_cast<uint32_t>(*at);
    free_.remove(*at, size);
    return base::Ok{};
  }

  // A7: what did not fit, and by how much.
  base::Error out_of_memory(uint32_t id) const {
    const std::string what = id == 0 ? "the global variables"
                                     : "instance `" + image_.instance_path(id) + "` (" +
                                           image_.types[image_.instances[id].type].name + ")";
    const uint64_t size = size_of(id);
    const uint64_t largest = free_.largest();
    return {base::Refusal::kOutOfMemory,
            what + " needs an area of " + std::to_string(size) +
                " bytes; the largest free area has " + std::to_string(largest) + " bytes, " +
                std::to_string(size - largest) +
                " too few. Free something, or start the program anew with a larger free area."};
  }

  base::Result<AreaPlan> finish(const Slack& slack) {
    AreaPlan plan;
    for (const auto& [begin, end] : freed_.ranges()) free_.add(begin, end - begin);
    plan.data_capacity = base_ != nullptr ? base_->data_capacity : first_capacity(slack);
    if (base_ == nullptr) {
      const uint64_t limit = base::kMaxDataBytes;
      if (plan.data_capacity < limit) free_.remove(plan.data_capacity, limit - plan.data_capacity);
    }
    for (const auto& [begin, end] : free_.ranges()) {
      plan.free.push_back({static_cast<uint32_t>(begin), static_cast<uint32_t>(end - begin)});
    }
    return plan;
  }

  uint32_t first_capacity(const Slack& slack) const {
    uint64_t end = ir::kDataBegin;
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (!image_.instances[id].live) continue;
      end = std::max<uint64_t>(end, image_.instances[id].data + size_of(id));
    }
    const uint64_t areas = end - ir::kDataBegin;
    const uint64_t behind = std::max<uint64_t>(slack.free_bytes, areas * slack.free_percent / 100);
    const uint64_t capacity = (end + behind + kAreaAlign - 1) / kAreaAlign * kAreaAlign;
    return static_cast<uint32_t>(std::min<uint64_t>(capacity, base::kMaxDataBytes));
  }

  ir::Image& image_;
  const ir::Image* base_;
  bool move_all_;
  Extents free_;
  Extents freed_;
  std::vector<bool> kept_;
};

}  // namespace

base::Result<AreaPlan> place_areas(ir::Image& image, const Slack& slack, const ir::Image* base,
                                   bool move_all) {
  return Placer(image, base, move_all).place(slack);
}

}  // namespace linker
