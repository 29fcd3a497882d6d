#include "vm/load/last_reads.h"

#include <algorithm>

namespace vm {
namespace {

using ir::Base;
using ir::FieldKind;

bool is_switch(ir::Opcode op) { return op >= ir::Opcode::SWITCH_8 && op <= ir::Opcode::SWITCH_64; }

const ir::Merge* merge_at(const ir::LinkedPou& pou, uint32_t unit) {
  const auto found = std::lower_bound(pou.merges.begin(), pou.merges.end(), unit,
                                      [](const ir::Merge& m, uint32_t at) { return m.unit < at; });
  return found != pou.merges.end() && found->unit == unit ? &*found : nullptr;
}

}  // namespace

LastReads::LastReads(const ir::LinkedPou& pou, std::span<const ir::Unit> code)
    : dead_(code.size(), 0) {
  list_places(pou, code);
  std::vector<uint32_t> units;
  units.reserve(code.size());
  for (uint32_t unit = 0; unit < code.size(); ++unit) {
    units.push_back(unit);
    if (ir::opcode_row(code[unit].opcode()).extended) ++unit;
  }
  for (size_t i = units.size(); i-- > 0;) pass(pou, code[units[i]], units[i]);
}

// Named variables stay; so do those that something has the address of, and what a handler of traps
// finds, as a trap leads there from anywhere.
void LastReads::list_places(const ir::LinkedPou& pou, std::span<const ir::Unit> code) {
  places_.resize(pou.frame_size);
  for (const ir::FrameSlot& slot : pou.slots) {
    const bool is_bool = !slot.aggregate && slot.cls == ir::Class::kB;
    places_[slot.offset].temporary = is_bool && slot.kind == ir::SlotKind::kTemp;
  }
  for (uint32_t unit = 0; unit < code.size(); ++unit) {
    const ir::Unit& u = code[unit];
    const ir::OpcodeRow& row = ir::opcode_row(u.opcode());
    if (u.opcode() == ir::Opcode::TRY) {
      const ir::Merge* const merge = merge_at(pou, unit + 1 + u.bc());
      for (const uint16_t slot : merge == nullptr ? std::vector<uint16_t>() : merge->slots) {
        keep(pou.slots[slot].offset);
      }
    }
    if (row.b.kind == FieldKind::kBc32 && u.base_b() == Base::kFrame) keep(u.bc());
    if (!row.extended) continue;
    const ir::Unit& extension = code[++unit];
    if (row.x.kind == FieldKind::kPlace32) keep(extension.x());
    if (row.y.kind == FieldKind::kPlace32) keep(extension.y());
  }
}

void LastReads::keep(uint32_t offset) {
  if (offset < places_.size()) places_[offset].temporary = false;
}

bool LastReads::is_live(uint32_t offset) const {
  if (offset >= places_.size() || !places_[offset].temporary) return true;
  const Place& place = places_[offset];
  return place.stretch == stretch_ ? place.live : all_live_;
}

void LastReads::set(uint32_t offset, bool live) {
  if (offset >= places_.size()) return;
  places_[offset].live = live;
  places_[offset].stretch = stretch_;
}

void LastReads::begin_stretch(bool all_live) {
  ++stretch_;
  all_live_ = all_live;
}

// What holds a value at a merge may be read after it; nothing else is.
void LastReads::arrive(const ir::LinkedPou& pou, uint32_t unit) {
  const ir::Merge* const merge = merge_at(pou, unit);
  if (merge == nullptr) return begin_stretch(true);
  for (const uint16_t slot : merge->slots) set(pou.slots[slot].offset, true);
}

void LastReads::pass(const ir::LinkedPou& pou, const ir::Unit& u, uint32_t unit) {
  const ir::OpcodeRow& row = ir::opcode_row(u.opcode());
  // The ways out of a SWITCH are the jumps after it, and what is after those.
  if (row.ends) begin_stretch(is_switch(u.opcode()));
  if (row.b.kind == FieldKind::kRel32) arrive(pou, unit + 1 + u.bc());
  const auto in_frame = [](const ir::Field& field, Base base) {
    return field.is_near() && field.cls == ir::Class::kB && base == Base::kFrame;
  };
  const bool a = in_frame(row.a, u.base_a());
  const bool b = in_frame(row.b, u.base_b());
  const bool c = in_frame(row.c, u.base_c());
  uint8_t& dead = dead_[unit];
  if (a && !is_live(u.a)) dead |= 1;
  if (a && row.a.writes()) set(u.a, false);
  if (b && !is_live(u.b)) dead |= 2;
  if (c && !is_live(u.c)) dead |= 4;
  if (a && row.a.reads()) set(u.a, true);
  if (b) set(u.b, true);
  if (c) set(u.c, true);
}

}  // namespace vm
