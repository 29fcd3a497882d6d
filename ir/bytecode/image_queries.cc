// What is asked of an image in memory.
#include <algorithm>
#include <cstring>

#include "base/limits.h"
#include "ir/bytecode/image.h"

namespace ir {

std::vector<uint32_t> Image::program_ids() const {
  std::vector<uint32_t> ids;
  for (uint32_t id = 1; id < instances.size(); ++id) {
    const Instance& row = instances[id];
    if (row.live && types.contains(row.type) && types[row.type].kind == Kind::kProgram) {
      ids.push_back(id);
    }
  }
  return ids;
}

std::string Image::instance_path(uint32_t id) const {
  std::string path;
  for (uint32_t depth = 0; id != 0 && id < instances.size() && depth < base::kMaxCallDepth;
       ++depth) {
    path = path.empty() ? instances[id].name : instances[id].name + "." + path;
    id = instances[id].parent;
  }
  return path;
}

void read_initial(const Image& image, uint32_t offset, std::span<uint8_t> out) {
  std::fill(out.begin(), out.end(), uint8_t{0});
  const uint64_t end = uint64_t{offset} + out.size();
  auto run = std::upper_bound(image.data.begin(), image.data.end(), offset,
                              [](uint32_t at, const DataRun& r) { return at < r.offset; });
  if (run != image.data.begin()) --run;
  for (; run != image.data.end() && run->offset < end; ++run) {
    const uint64_t from = std::max<uint64_t>(offset, run->offset);
    const uint64_t to = std::min<uint64_t>(end, uint64_t{run->offset} + run->bytes.size());
    if (from < to) std::memcpy(&out[from - offset], &run->bytes[from - run->offset], to - from);
  }
}

uint32_t initial_id(const Image& image, uint32_t slot) {
  uint8_t bytes[4];
  read_initial(image, slot, bytes);
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

}  // namespace ir
