// What follows from the tables of an image, whatever the code of a POU is.
#include <algorithm>

#include "ir/bytecode/regions.h"
#include "vm/native/facts.h"

namespace vm::native {

using ir::Opcode;

uint32_t slot_number(const ir::LinkedPou& pou, uint32_t offset) {
  const auto behind =
      std::upper_bound(pou.slots.begin(), pou.slots.end(), offset,
                       [](uint32_t at, const ir::FrameSlot& slot) { return at < slot.offset; });
  return behind == pou.slots.begin() ? kNone
                                     : static_cast<uint32_t>(behind - pou.slots.begin() - 1);
}

uint32_t called_body(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                     const ir::Unit& u) {
  ir::Region region;
  uint32_t offset = 0;
  if (u.opcode() == Opcode::CALL_INST_AT) {
    const uint32_t slot = slot_number(pou, u.b);
    if (slot == kNone) return kNone;
    region = pou.slots[slot].region;
    offset = u.c;
  } else if (u.base_b() == ir::Base::kSelf) {
    region = {pou.self, 0};
    offset = u.bc();
  } else {
    return kNone;
  }
  if (!region.type.valid()) return kNone;
  const auto leaf = ir::leaf_at(image.types, image.layouts, region, offset);
  if (!leaf || leaf->kind != ir::LeafKind::kInstanceSlot) return kNone;
  return common.body_of[leaf->type.index];
}

const ir::PouVersion* ImageFacts::version_of(uint32_t pou) const {
  const auto found =
      std::lower_bound(versions.begin(), versions.end(), pou,
                       [](const ir::PouVersion& row, uint32_t at) { return row.pou < at; });
  return found == versions.end() || found->pou != pou ? nullptr : &*found;
}

std::span<const ir::Unit> ImageFacts::code_of(const ir::Image& image,
                                              const ir::LinkedPou& pou) const {
  const auto* const version = version_of(static_cast<uint32_t>(&pou - image.pous.data()));
  if (version != nullptr) return version->units;
  return std::span(image.code).subspan(pou.first_unit, pou.unit_count);
}

ImageFacts::ImageFacts(const ir::Image& image, bool are_bools_clean,
                       std::span<const ir::PouVersion> other_code)
    : versions(other_code), body_of(image.types.size(), kNone), clean_bools(are_bools_clean) {
  for (uint32_t p = 0; p < image.pous.size(); ++p) {
    const ir::LinkedPou& pou = image.pous[p];
    if (!ir::is_body(pou.kind)) continue;
    if (pou.self.valid()) body_of[pou.self.index] = p;
    recursive_bodies |= pou.recursion_depth != 0;
  }
}

}  // namespace vm::native
