#include "vm/runtime/own_outputs.h"

#include <algorithm>

#include "ir/bytecode/located_layouts.h"
#include "ir/types/location.h"

namespace vm {
namespace {

struct Area {
  uint32_t begin = 0;
  uint32_t task = 0;
};

// Areas of instances that belong to a task, and all others, by their place.
std::vector<Area> areas_by_place(const ir::Image& image) {
  std::vector<uint32_t> task_of(image.instances.size(), ir::kNoTask);
  for (uint32_t number = 0; number < image.tasks.size(); ++number) {
    for (uint32_t id : image.tasks[number].programs) task_of[id] = number;
  }
  std::vector<Area> areas;
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (id != 0 && (!row.live || image.layouts[row.type].area_capacity == 0)) continue;
    uint32_t owner = id;
    while (task_of[owner] == ir::kNoTask && image.instances[owner].parent != 0) {
      owner = image.instances[owner].parent;
    }
    areas.push_back({row.data, task_of[owner]});
  }
  std::sort(areas.begin(), areas.end(),
            [](const Area& a, const Area& b) { return a.begin < b.begin; });
  return areas;
}

void mark(uint64_t first_bit, uint64_t bits, base::Bytes& mask) {
  for (uint64_t bit = first_bit; bit < first_bit + bits && bit / 8 < mask.size(); ++bit) {
    mask[bit / 8] |= static_cast<uint8_t>(1u << (bit % 8));
  }
}

}  // namespace

void mark_own_outputs(TaskTables& tables) {
  const ir::Image& image = tables.version.image();
  if (image.output_bytes == 0) return;
  const std::vector<Area> areas = areas_by_place(image);
  const ir::Layouts natural = ir::located_layouts(image);
  for (const ir::IoBinding& io : image.io) {
    if (io.address.area != ir::DirectArea::kOutput) continue;
    auto behind = std::upper_bound(areas.begin(), areas.end(), io.data,
                                   [](uint32_t at, const Area& area) { return at < area.begin; });
    if (behind == areas.begin() || (behind - 1)->task == ir::kNoTask) continue;
    mark(io.address.bit_offset, ir::located_bits(image.types, natural, io.type, io.address),
         tables.tasks[(behind - 1)->task].own_outputs);
  }
  for (const ir::OutputWriter& writer : tables.version.output_writers()) {
    tables.process_image.mark_outputs(writer.data, writer.data + writer.size,
                                      tables.tasks[writer.task].own_outputs);
  }
}

}  // namespace vm
