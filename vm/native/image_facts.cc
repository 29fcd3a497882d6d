// What follows from the tables of an image, whatever the code of a POU is.
#include <algorithm>
#include <numeric>

#include "base/limits.h"
#include "ir/bytecode/regions.h"
#include "vm/load/decode.h"
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

namespace {

constexpr int64_t kFarthest = int64_t{1} << 29;  // of what an instruction reaches from an instance
constexpr size_t kMostKinds = 8;                 // that the type of an instance is compared with

}  // namespace

ImageFacts::ImageFacts(const ir::Image& image, bool are_bools_clean,
                       std::span<const ir::PouVersion> other_code)
    : versions(other_code),
      body_of(image.types.size(), kNone),
      clean_bools(are_bools_clean),
      image_(image),
      instances_of_(image.types.size()) {
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    if (!image.instances[id].live) continue;
    ir::TypeId type = image.instances[id].type;
    for (uint32_t depth = 0; depth < base::kMaxNesting && image.types.contains(type); ++depth) {
      instances_of_[type.index].push_back(id);
      type = image.types[type].kind == ir::Kind::kFunctionBlock ? image.types[type].base
                                                                : ir::TypeId();
    }
  }
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::Type& type = image.types[ir::TypeId(i)];
    const bool extends = type.kind == ir::Kind::kFunctionBlock && type.base.valid();
    if (extends) extensions_.push_back(uint64_t{type.base.index} << 32 | i);
  }
  std::sort(extensions_.begin(), extensions_.end());
  by_prototype_.resize(image.overrides.size());
  std::iota(by_prototype_.begin(), by_prototype_.end(), 0);
  std::sort(by_prototype_.begin(), by_prototype_.end(), [&](uint32_t a, uint32_t b) {
    const uint32_t x = image.overrides[a].prototype;
    const uint32_t y = image.overrides[b].prototype;
    return x != y ? x < y : a < b;
  });
  for (uint32_t p = 0; p < image.pous.size(); ++p) {
    const ir::LinkedPou& pou = image.pous[p];
    if (!ir::is_body(pou.kind)) {
      recursive_methods |= pou.self.valid() && pou.recursion_depth != 0;
      continue;
    }
    if (pou.self.valid()) body_of[pou.self.index] = p;
    recursive_bodies |= pou.recursion_depth != 0;
  }
}

// The verifier has seen that each slot names a live instance of its type, and nothing changes it.
bool ImageFacts::same_for_all(ir::TypeId type, Children& out) const {
  bool first = true;
  for (const uint32_t holder : instances_of_[type.index]) {
    const uint32_t data = image_.instances[holder].data;
    for (uint32_t i = 0; i < out.count; ++i) {
      const uint32_t id = ir::initial_id(image_, data + out.slot + 4 * i);
      const int64_t way = int64_t{image_.instances[id].data} - data;
      if (first && i == 0) out.first = way;
      if (first && i == 1) out.stride = way - out.first;
      if (way != out.first + out.stride * i) return false;
    }
    first = false;
  }
  return !first;
}

const std::vector<Children>& ImageFacts::children(ir::TypeId type) const {
  if (const auto* const known = children_.find(type.index)) return *known;
  std::vector<Children> all;
  const std::vector<ir::Member>& members = image_.types[type].members;
  for (size_t m = 0; m < members.size(); ++m) {
    if (members[m].section == ir::Section::kInOut) continue;
    const ir::Type& row = image_.types[members[m].type];
    const bool array = row.kind == ir::Kind::kArray;
    const ir::TypeId child = array ? row.base : members[m].type;
    if (!image_.types.is_instance(child)) continue;
    uint64_t count = 1;
    if (array) {
      for (const ir::Dimension& dim : row.dims) count *= dim.count();
    }
    if (count > image_.instances.size()) continue;
    Children out{image_.layouts[type].member_offsets[m], static_cast<uint32_t>(count), 0, 0};
    if (!same_for_all(type, out)) continue;
    const int64_t last = out.first + out.stride * (out.count - 1);
    const int64_t end = std::max(out.first, last) + image_.layouts[child].area_capacity;
    if (std::min(out.first, last) >= -kFarthest && end <= kFarthest) all.push_back(out);
  }
  std::sort(all.begin(), all.end(),
            [](const Children& a, const Children& b) { return a.slot < b.slot; });
  return children_[type.index] = std::move(all);
}

const std::vector<ir::TypeId>* ImageFacts::kinds_of(ir::TypeId type) const {
  if (!image_.types.contains(type)) return nullptr;
  if (image_.types[type].kind != ir::Kind::kFunctionBlock) return nullptr;
  const std::vector<ir::TypeId>* all = kinds_.find(type.index);
  if (all == nullptr) {
    std::vector<ir::TypeId> found = {type};
    for (size_t next = 0; next < found.size() && found.size() <= kMostKinds; ++next) {
      const uint64_t base = uint64_t{found[next].index} << 32;
      auto at = std::lower_bound(extensions_.begin(), extensions_.end(), base);
      for (; at != extensions_.end() && *at >> 32 == base >> 32; ++at) {
        found.push_back(ir::TypeId(static_cast<uint32_t>(*at)));
        if (found.size() > kMostKinds) break;
      }
    }
    all = &(kinds_[type.index] = std::move(found));
  }
  return all->size() > kMostKinds ? nullptr : all;
}

bool ImageFacts::has_slots(ir::TypeId type) const {
  if (with_slots_.empty()) with_slots_ = types_with_slots(image_);
  return with_slots_[type.index];
}

std::vector<ir::LinkedOverride> ImageFacts::targets_of(uint32_t prototype) const {
  const std::vector<ir::LinkedOverride>& rows = image_.overrides;
  auto at = std::lower_bound(by_prototype_.begin(), by_prototype_.end(), prototype,
                             [&](uint32_t row, uint32_t p) { return rows[row].prototype < p; });
  std::vector<ir::LinkedOverride> out;
  for (; at != by_prototype_.end() && rows[*at].prototype == prototype; ++at) {
    if (out.size() == kMostKinds) return {};
    out.push_back(rows[*at]);
  }
  return out;
}

const std::vector<ir::TypeId>* Facts::kinds_called(uint32_t i) const {
  const Opcode op = code_[i].opcode();
  const uint32_t x = extension(i).x();
  return common_->kinds_of(op == Opcode::CALL_REF ? ir::region_of_field(x).type
                                                  : image_->pous[x].self);
}

bool may_be_own(const ir::Image& image, const ir::LinkedPou& pou, ir::TypeId type) {
  if (!pou.self.valid()) return false;
  return image.types.is_a(pou.self, type) || image.types.is_a(type, pou.self);
}

const Children* Facts::children(uint64_t offset) const {
  if (!pou_->self.valid()) return nullptr;
  const std::vector<Children>& all = common_->children(pou_->self);
  auto at = std::upper_bound(all.begin(), all.end(), offset,
                             [](uint64_t o, const Children& c) { return o < c.slot; });
  if (at == all.begin()) return nullptr;
  --at;
  return offset < at->slot + uint64_t{4} * at->count ? &*at : nullptr;
}

}  // namespace vm::native
