#include "online_change/apply/used_data.h"

#include <algorithm>

namespace online_change {
namespace {

// Areas that are no further apart are copied as one; what lies between them is nobody's.
constexpr uint32_t kGap = 64;

}  // namespace

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

uint64_t total_bytes(const std::vector<ir::Extent>& extents) {
  uint64_t bytes = 0;
  for (const ir::Extent& one : extents) bytes += one.size;
  return bytes;
}

}  // namespace online_change
