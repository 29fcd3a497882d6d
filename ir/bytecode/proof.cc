#include "ir/bytecode/proof.h"

#include <algorithm>
#include <cstring>

#include "ir/bytecode/image_sections.h"

namespace ir::verification {
namespace {

bool same_section(base::ByteSpan a, base::ByteSpan b, ImageSection section) {
  const base::ByteSpan x = section_of(a, section);
  const base::ByteSpan y = section_of(b, section);
  return x.data() != nullptr && std::equal(x.begin(), x.end(), y.begin(), y.end());
}

bool same_slot(const FrameSlot& a, const FrameSlot& b) {
  return a.offset == b.offset && a.kind == b.kind && a.local == b.local &&
         a.aggregate == b.aggregate && a.cls == b.cls && a.region == b.region;
}

bool same_slots(const LinkedPou& a, const LinkedPou& b) {
  if (a.slots.is_one_with(b.slots)) return true;
  return std::equal(a.slots.begin(), a.slots.end(), b.slots.begin(), b.slots.end(), same_slot);
}

bool same_merges(const LinkedPou& a, const LinkedPou& b) {
  const auto same = [](const Merge& x, const Merge& y) {
    return x.unit == y.unit && x.slots == y.slots;
  };
  if (a.merges.is_one_with(b.merges)) return true;
  return std::equal(a.merges.begin(), a.merges.end(), b.merges.begin(), b.merges.end(), same);
}

std::span<const Unit> code_of(const Image& image, const LinkedPou& pou) {
  return std::span(image.code).subspan(pou.first_unit, pou.unit_count);
}

bool same_units(std::span<const Unit> a, std::span<const Unit> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool same_instance(const Instance& a, const Instance& b) {
  return a.type == b.type && a.data == b.data && a.pou == b.pou && a.parent == b.parent &&
         a.live == b.live && a.old_name == b.old_name;
}

bool same_instances(const Image& a, const Image& b) {
  if (a.instances.is_one_with(b.instances)) return true;
  return std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    same_instance);
}

// Are they the same node of the graph of calls?
bool same_node(const LinkedPou& a, const LinkedPou& b) {
  return a.frame_size == b.frame_size && a.recursion_depth == b.recursion_depth;
}

bool same_facts(const CodeFacts& a, const CodeFacts& b) {
  return a.callees == b.callees && a.native_bytes == b.native_bytes &&
         a.written_outputs == b.written_outputs;
}

bool same_calls(const ImageTask& a, const ImageTask& b) {
  return a.priority == b.priority && a.once == b.once && a.programs == b.programs;
}

bool same_override(const LinkedOverride& a, const LinkedOverride& b) {
  return a.type == b.type && a.prototype == b.prototype && a.target == b.target;
}

}  // namespace

Likeness::Likeness(const Proof* like, base::ByteSpan encoded, const Image& image)
    : like_(like), image_(image) {
  if (like_ == nullptr) return;
  const Image& known = like_->image;
  const auto same = [&](ImageSection section) {
    return same_section(*like_->encoded, encoded, section);
  };
  types_ = known.globals == image_.globals &&
           (known.types.is_one_with(image_.types) || same(ImageSection::kTypes)) &&
           (known.layouts.is_one_with(image_.layouts) || same(ImageSection::kLayouts));
  if (!types_) return;
  constants_ = known.constants.is_one_with(image_.constants) || same(ImageSection::kConstants);
  if (!same_roles()) return;
  instances_ = known.data_capacity == image_.data_capacity && known.free == image_.free &&
               (known.data.is_one_with(image_.data) || same(ImageSection::kData)) &&
               same_instances(known, image_);
  code_ = !image_.instances.empty() && image_.instances[0].data == known.instances[0].data;
  if (!code_) return;
  changed_ = changed_constants(known.pool, image_.pool);
  const auto bounds = std::mismatch(
      known.bounds.begin(), known.bounds.end(), image_.bounds.begin(), image_.bounds.end(),
      [](const LinkedBound& a, const LinkedBound& b) { return a.from == b.from; });
  same_bounds_ = static_cast<size_t>(bounds.first - known.bounds.begin());
  find_changed_parameters();
}

bool Likeness::regions() const {
  return types_ && like_->image.types.is_one_with(image_.types) &&
         like_->image.layouts.is_one_with(image_.layouts);
}

bool Likeness::slots(uint32_t pou) const {
  if (!types_ || pou >= like_->image.pous.size()) return false;
  const LinkedPou& a = like_->image.pous[pou];
  const LinkedPou& b = image_.pous[pou];
  return a.kind == b.kind && a.frame_size == b.frame_size && a.slots.is_one_with(b.slots);
}

bool Likeness::bounds() const { return types_ && like_->image.bounds.is_one_with(image_.bounds); }

bool Likeness::ranges() const {
  return like_ != nullptr && like_->image.ranges.is_one_with(image_.ranges);
}

bool Likeness::calls(const CodeFactsOfAll& code) const {
  if (!instances_ || !image_.migrations.empty() || !like_->image.migrations.empty()) return false;
  const Image& known = like_->image;
  if (known.stack_bytes != image_.stack_bytes || known.call_depth != image_.call_depth ||
      !std::equal(known.tasks.begin(), known.tasks.end(), image_.tasks.begin(), image_.tasks.end(),
                  same_calls) ||
      !std::equal(known.overrides.begin(), known.overrides.end(), image_.overrides.begin(),
                  image_.overrides.end(), same_override)) {
    return false;
  }
  for (size_t i = 0; i < code.size(); ++i) {
    if (!same_node(known.pous[i], image_.pous[i])) return false;
    if (code[i] == like_->code[i]) continue;
    if (code[i] == nullptr || like_->code[i] == nullptr) return false;
    if (!same_facts(*code[i], *like_->code[i])) return false;
  }
  return true;
}

// Every number is a POU of the same kind and type, or none.
bool Likeness::same_roles() const {
  const std::vector<LinkedPou>& known = like_->image.pous;
  return std::equal(known.begin(), known.end(), image_.pous.begin(), image_.pous.end(),
                    [](const LinkedPou& a, const LinkedPou& b) {
                      return a.kind == b.kind && a.self == b.self &&
                             (a.unit_count == 0) == (b.unit_count == 0);
                    });
}

bool Likeness::is_same_constant(const Extent& bytes) const {
  const bool inside = size_t{bytes.offset} + bytes.size <= image_.pool.size();
  return inside && !changed_.meets(bytes.offset, bytes.size);
}

// Nobody looks at the slots of a body, which has no parameters.
void Likeness::find_changed_parameters() {
  new_parameters_.resize(image_.pous.size());
  for (size_t i = 0; i < new_parameters_.size(); ++i) {
    new_parameters_[i] =
        !is_body(image_.pous[i].kind) && !same_slots(like_->image.pous[i], image_.pous[i]);
  }
}

bool Likeness::same_code(uint32_t pou) const {
  const LinkedPou& a = like_->image.pous[pou];
  const LinkedPou& b = image_.pous[pou];
  return a.frame_size == b.frame_size && same_units(code_of(like_->image, a), code_of(image_, b)) &&
         same_slots(a, b) && same_merges(a, b);
}

std::shared_ptr<const CodeFacts> Likeness::code(uint32_t pou) const {
  if (!code_ || !same_code(pou)) return nullptr;
  const std::shared_ptr<const CodeFacts>& facts = like_->code[pou];
  if (facts == nullptr || facts->bounds_end > same_bounds_ ||
      facts->ranges_end > image_.ranges.size()) {
    return nullptr;
  }
  for (const Extent& constant : facts->constants) {
    if (!is_same_constant(constant)) return nullptr;
  }
  for (const uint32_t named : facts->parameters_of) {
    if (new_parameters_[named]) return nullptr;
  }
  return facts;
}

}  // namespace ir::verification
