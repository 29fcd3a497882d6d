#include "online_change/plan/same_data.h"

#include <algorithm>
#include <optional>

#include "ir/bytecode/bools.h"
#include "ir/bytecode/image_sections.h"
#include "online_change/plan/pause.h"

namespace online_change {
namespace {

bool same_section(const EncodedImage& a, const EncodedImage& b, ir::ImageSection section) {
  const base::ByteSpan x = ir::section_of(a.bytes, section);
  const base::ByteSpan y = ir::section_of(b.bytes, section);
  return !x.empty() && std::equal(x.begin(), x.end(), y.begin(), y.end());
}

bool same_instance(const ir::Instance& a, const ir::Instance& b) {
  return a.type == b.type && a.data == b.data && a.pou == b.pou && a.parent == b.parent &&
         a.generation == b.generation && a.live == b.live && a.name == b.name &&
         a.old_name == b.old_name;
}

bool same_instances(const ir::Image& a, const ir::Image& b) {
  return a.instances.is_one_with(b.instances) ||
         std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    same_instance);
}

// Scalars and strings of a value or an area, as TypeDiffer::leaves() counts them.
class Leaves {
 public:
  explicit Leaves(const ir::Image& image) : types_(image.types), known_(image.types.size()) {}

  uint64_t of(ir::TypeId id) {
    const ir::Type& type = types_[id];
    if (!types_.has_members(id) && type.kind != ir::Kind::kArray) return 1;
    std::optional<uint64_t>& known = known_[id.index];
    if (!known) known = count(id, type);
    return *known;
  }

 private:
  // No type of a verified image, or of the linker's, contains itself.
  uint64_t count(ir::TypeId id, const ir::Type& type) {
    if (type.kind == ir::Kind::kArray) {
      if (types_.is_instance(type.base)) return 0;
      uint64_t count = of(type.base);
      for (const ir::Dimension& dim : type.dims) count *= dim.count();
      return count;
    }
    if (types_.overlaps(id)) return 1;
    uint64_t count = 0;
    for (const ir::Member& member : type.members) {
      if (ir::is_listed(member) && !types_.is_instance(member.type)) count += of(member.type);
    }
    return count;
  }

  const ir::TypeTable& types_;
  std::vector<std::optional<uint64_t>> known_;
};

bool has_rules(const ir::Image& image) {
  return !image.migrations.empty() || !image.types.old_names().empty();
}

}  // namespace

bool same_types(const EncodedImage& a, const EncodedImage& b) {
  return a.image.types.is_one_with(b.image.types) || same_section(a, b, ir::ImageSection::kTypes);
}

bool same_data(const EncodedImage& a, const EncodedImage& b) {
  return a.image.globals == b.image.globals && a.image.data_capacity == b.image.data_capacity &&
         !has_rules(a.image) && !has_rules(b.image) && same_types(a, b) &&
         (a.image.layouts.is_one_with(b.image.layouts) ||
          same_section(a, b, ir::ImageSection::kLayouts)) &&
         (a.image.data.is_one_with(b.image.data) || same_section(a, b, ir::ImageSection::kData)) &&
         same_instances(a.image, b.image);
}

SameDataPlans plans_of_same_data(const ir::Image& old_image, const ir::Image& new_image) {
  SameDataPlans plans;
  Leaves leaves(new_image);
  uint64_t kept = 0;
  for (uint32_t id = 0; id < new_image.instances.size(); ++id) {
    const ir::Instance& row = new_image.instances[id];
    if (id == 0 || row.live) kept += leaves.of(row.type);
  }
  BoundaryWork there;
  BoundaryWork back;
  if (!ir::stay_alike(old_image, new_image)) {
    const ir::Bools before(old_image);
    const ir::Bools after(new_image);
    there.values = bools_to_normalise(before, after);
    back.values = bools_to_normalise(after, before);
  }
  plans.forward.counts.kept = plans.inverse.counts.kept = kept;
  plans.forward.predicted_pause_ns = pause_ns(there);
  plans.inverse.predicted_pause_ns = pause_ns(back);
  return plans;
}

}  // namespace online_change
