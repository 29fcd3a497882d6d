#include "vm/runtime/memory_report.h"

#include <algorithm>

namespace vm {

MemoryReport memory_report(const ir::Image& image) {
  MemoryReport report;
  report.capacity = image.data_capacity;
  for (const ir::Extent& extent : image.free) {
    report.free += extent.size;
    report.largest_free = std::max<uint64_t>(report.largest_free, extent.size);
  }
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (!row.live) continue;
    const bool program = image.types[row.type].kind == ir::Kind::kProgram;
    AreaRoom& room = id == 0 ? report.globals : program ? report.programs : report.instances;
    const ir::TypeLayout& layout = image.layouts[row.type];
    ++room.areas;
    room.used += layout.used;
    room.slack += std::max(layout.used, layout.area_capacity) - layout.used;
  }
  return report;
}

}  // namespace vm
