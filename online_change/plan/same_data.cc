#include "online_change/plan/same_data.h"

#include <algorithm>
#include <optional>

#include "ir/bytecode/bools.h"
#include "ir/bytecode/image_sections.h"
#include "online_change/diff/type_diff.h"
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

bool has_rules(const ir::Image& image) {
  return !image.migrations.empty() || !image.types.old_names().empty();
}

}  // namespace

bool same_types(const EncodedImage& a, const EncodedImage& b) {
  return same_section(a, b, ir::ImageSection::kTypes);
}

bool same_data(const EncodedImage& a, const EncodedImage& b) {
  return a.image.globals == b.image.globals && a.image.data_capacity == b.image.data_capacity &&
         !has_rules(a.image) && !has_rules(b.image) && same_types(a, b) &&
         same_section(a, b, ir::ImageSection::kLayouts) &&
         same_section(a, b, ir::ImageSection::kData) &&
         std::equal(a.image.instances.begin(), a.image.instances.end(), b.image.instances.begin(),
                    b.image.instances.end(), same_instance);
}

SameDataPlans plans_of_same_data(const ir::Image& old_image, const ir::Image& new_image) {
  SameDataPlans plans;
  const Migrations none(new_image, new_image, Migrations::Way::kThere);
  TypeDiffer differ(new_image, new_image, TypeDiffer::Direction::kForward, false, none);
  std::vector<std::optional<uint64_t>> leaves(new_image.types.size());
  uint64_t kept = 0;
  for (uint32_t id = 0; id < new_image.instances.size(); ++id) {
    const ir::Instance& row = new_image.instances[id];
    if (id != 0 && !row.live) continue;
    std::optional<uint64_t>& known = leaves[row.type.index];
    if (!known) known = differ.leaves(new_image, row.type);
    kept += *known;
  }
  const ir::Bools before(old_image);
  const ir::Bools after(new_image);
  BoundaryWork there;
  BoundaryWork back;
  there.values = bools_to_normalise(before, after);
  back.values = bools_to_normalise(after, before);
  plans.forward.counts.kept = plans.inverse.counts.kept = kept;
  plans.forward.predicted_pause_ns = pause_ns(there);
  plans.inverse.predicted_pause_ns = pause_ns(back);
  return plans;
}

}  // namespace online_change
