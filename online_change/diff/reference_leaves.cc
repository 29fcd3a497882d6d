#include "online_change/diff/reference_leaves.h"

#include <map>
#include <utility>

#include "base/limits.h"
#include "online_change/diff/areas.h"

namespace online_change {
namespace {

// Offsets of references inside each type.
class LeafFinder {
 public:
  explicit LeafFinder(const ir::Image& image) : image_(image) {}

  const std::vector<ReferenceLeaf>& inside(ir::TypeId type, bool area, uint32_t depth) {
    auto& known = area ? areas_ : values_;
    const auto found = known.find(type.index);
    if (found != known.end()) return found->second;
    std::vector<ReferenceLeaf> out;
    if (depth < base::kMaxTypeDepth) find(type, area, depth, out);
    return known[type.index] = std::move(out);
  }

 private:
  void find(ir::TypeId id, bool area, uint32_t depth, std::vector<ReferenceLeaf>& out) {
    const ir::Type& type = image_.types[id];
    if (image_.types.is_reference(id)) out.push_back({0, id});
    if (type.kind == ir::Kind::kArray) {
      const std::vector<ReferenceLeaf>& element = inside(type.base, false, depth + 1);
      if (element.empty()) return;
      const uint32_t stride = image_.layouts[type.base].size;
      for (uint32_t at = 0; at + stride <= image_.layouts[id].size; at += stride) {
        for (const ReferenceLeaf& leaf : element) out.push_back({at + leaf.at, leaf.type});
      }
    }
    if (!area && !has_own_parts(image_.types, id)) return;
    for (size_t i = 0; i < type.members.size(); ++i) {
      const ir::Member& member = type.members[i];
      if (member.section == ir::Section::kInOut || image_.types.is_instance(member.type)) continue;
      const uint32_t at = image_.layouts[id].member_offsets[i];
      for (const ReferenceLeaf& leaf : inside(member.type, false, depth + 1)) {
        out.push_back({at + leaf.at, leaf.type});
      }
    }
  }

  const ir::Image& image_;
  std::map<uint32_t, std::vector<ReferenceLeaf>> values_;
  std::map<uint32_t, std::vector<ReferenceLeaf>> areas_;
};

}  // namespace

std::vector<ReferenceLeaf> reference_leaves(const ir::Image& image) {
  LeafFinder finder(image);
  std::vector<ReferenceLeaf> out;
  for (const ir::Instance& instance : image.instances) {
    if (!instance.live) continue;
    for (const ReferenceLeaf& leaf : finder.inside(instance.type, true, 0)) {
      out.push_back({instance.data + leaf.at, leaf.type});
    }
  }
  return out;
}

}  // namespace online_change
