#include "vm/load/origins.h"

#include <algorithm>

#include "ir/bytecode/regions.h"

namespace vm {
namespace {

using ir::Opcode;

constexpr size_t kMostOrigins = 16;

const ir::FrameSlot* slot_at(const ir::LinkedPou& pou, uint32_t offset) {
  const auto behind =
      std::upper_bound(pou.slots.begin(), pou.slots.end(), offset,
                       [](uint32_t at, const ir::FrameSlot& slot) { return at < slot.offset; });
  return behind == pou.slots.begin() ? nullptr : &*(behind - 1);
}

Origin unknown(Origin::Kind kind) {
  Origin origin;
  origin.kind = kind;
  return origin;
}

Origin place(ir::Base base, uint64_t begin, uint64_t size, bool exact) {
  Origin origin;
  origin.base = base;
  origin.begin = begin;
  origin.end = begin + size;
  origin.exact = exact;
  return origin;
}

bool is_one_of(Opcode op, Opcode first, Opcode last) { return op >= first && op <= last; }

bool join(Origins& to, const Origins& from) {
  bool changed = false;
  if (to.size() == 1 && to.front().kind == Origin::Kind::kAnywhere) return false;
  for (const Origin& origin : from) {
    if (std::find(to.begin(), to.end(), origin) != to.end()) continue;
    changed = true;
    to.push_back(origin);
  }
  if (to.size() <= kMostOrigins) return changed;
  const Origins anywhere = {unknown(Origin::Kind::kAnywhere)};
  to = anywhere;
  return true;
}

}  // namespace

bool makes_address(const ir::Unit& unit) {
  const ir::Field& field = ir::opcode_row(unit.opcode()).a;
  const bool address =
      field.cls == ir::Class::kA || field.cls == ir::Class::kS || field.cls == ir::Class::kW;
  return address && field.is_near() && field.writes();
}

OriginWalk::OriginWalk(const ir::Image& image, const ir::LinkedPou& pou)
    : image_(image),
      pou_(pou),
      code_(std::span(image.code).subspan(pou.first_unit, pou.unit_count)) {
  for (const ir::FrameSlot& slot : pou.slots) {
    const bool given = slot.kind == ir::SlotKind::kParam && !slot.aggregate;
    if (given) all_[slot.offset] = {unknown(Origin::Kind::kInOut)};
  }
  if (!pou.merges.empty()) find_all();
}

// What any unit puts into a slot: for those that hold their address from one block to another.
void OriginWalk::find_all() {
  std::vector<uint32_t> makers;
  for (uint32_t i = 0; i < code_.size(); ++i) {
    if (makes_address(code_[i])) makers.push_back(i);
    if (ir::opcode_row(code_[i].opcode()).extended) ++i;
  }
  for (const uint32_t unit : makers) all_.try_emplace(code_[unit].a);
  for (bool changed = true; changed;) {
    changed = false;
    for (const uint32_t unit : makers) changed |= join(all_[code_[unit].a], of_unit(unit));
  }
}

Origins OriginWalk::of(uint32_t slot) const {
  const auto near = now_.find(slot);
  if (near != now_.end()) return near->second;
  const auto any = all_.find(slot);
  return any != all_.end() ? any->second : Origins{unknown(Origin::Kind::kInOut)};
}

ir::Region OriginWalk::region(uint32_t slot) const {
  const ir::FrameSlot* const found = slot_at(pou_, slot);
  const bool there = found != nullptr && found->offset == slot && slot < pou_.frame_size;
  return there ? found->region : ir::Region{};
}

// An address `by` bytes after that in the slot, of something with so many bytes.
Origins OriginWalk::moved(uint32_t slot, uint64_t by, uint64_t size) const {
  Origins origins = of(slot);
  for (Origin& origin : origins) {
    if (!origin.exact) continue;
    origin.begin += by;
    origin.end = origin.begin + size;
  }
  return origins;
}

Origins OriginWalk::of_unit(uint32_t i) const {
  const ir::Unit& unit = code_[i];
  const Opcode op = unit.opcode();
  const ir::Unit& more = ir::opcode_row(op).extended ? code_[i + 1] : unit;
  const auto bytes = [&](ir::Region region) {
    return uint64_t{ir::region_size(image_.types, image_.layouts, region)};
  };
  if (is_one_of(op, Opcode::INDEX_PLACE_I8, Opcode::INDEX_PLACE_U64)) {
    const ir::LinkedBound& bound = image_.bounds[more.x()];
    return {place(unit.base_c(), more.y(), bound.count * bound.stride, false)};
  }
  if (is_one_of(op, Opcode::INDEX_I8, Opcode::INDEX_U64)) {
    const ir::LinkedBound& bound = image_.bounds[more.x()];
    Origins origins = moved(unit.c, more.y(), bound.count * bound.stride);
    for (Origin& origin : origins) origin.exact = false;
    return origins;
  }
  switch (op) {
    case Opcode::LEA:
      return {place(unit.base_b(), more.x(), bytes(ir::region_of_field(more.y())), true)};
    case Opcode::STR:
      return {place(unit.base_b(), more.x(), uint64_t{more.y()} + 1, true)};
    case Opcode::WSTR:
      return {place(unit.base_b(), more.x(), 2 * (uint64_t{more.y()} + 1), true)};
    case Opcode::LEA_AT:
      return moved(unit.b, more.x(), bytes(ir::region_of_field(more.y())));
    case Opcode::STR_AT:
      return moved(unit.b, more.x(), uint64_t{more.y()} + 1);
    case Opcode::WSTR_AT:
      return moved(unit.b, more.x(), 2 * (uint64_t{more.y()} + 1));
    case Opcode::MOV_A:
    case Opcode::MOV_S:
    case Opcode::MOV_W:
      return of(unit.b);
    case Opcode::INST: {
      Origin origin = place(unit.base_b(), 0, UINT32_MAX, true);
      origin.kind = Origin::Kind::kInstance;
      origin.slot = unit.bc();
      return {origin};
    }
    case Opcode::INST_AT: {
      Origin origin = place(ir::Base::kFrame, 0, UINT32_MAX, true);
      origin.kind = Origin::Kind::kAnyInstance;
      origin.type = region(unit.a).type;
      return {origin};
    }
    case Opcode::RESOLVE:
    case Opcode::RESOLVE_S:
    case Opcode::RESOLVE_W:
      return {unknown(Origin::Kind::kReference)};
    default:  // LD_REF and what may be added: from outside
      return {unknown(Origin::Kind::kInOut)};
  }
}

void OriginWalk::enter(uint32_t i) {
  if (next_merge_ == pou_.merges.size() || pou_.merges[next_merge_].unit != i) return;
  ++next_merge_;
  now_.clear();
}

void OriginWalk::pass(uint32_t i) {
  const ir::Unit& unit = code_[i];
  if (ir::opcode_row(unit.opcode()).calls || unit.opcode() == Opcode::NATIVE) arguments_.clear();
  if (!makes_address(unit)) return;
  Origins origins = of_unit(i);
  if (unit.a >= pou_.frame_size) arguments_.push_back({unit.a, origins});
  now_[unit.a] = std::move(origins);
}

}  // namespace vm
