#include "linker/next_frame.h"

namespace linker {
namespace {

using ir::FieldKind;
using ir::Opcode;
using ir::OpcodeRow;
using ir::Unit;

bool takes_next_frame(Opcode op) { return ir::opcode_row(op).calls || op == Opcode::NATIVE; }

std::optional<CallOf> call_of(std::span<const Unit> code, uint32_t at) {
  const Unit& unit = code[at];
  const OpcodeRow& row = ir::opcode_row(unit.opcode());
  if (unit.opcode() == Opcode::NATIVE) return CallOf{true, unit.c};
  if (row.c.kind == FieldKind::kCode) return CallOf{false, unit.c};
  if (row.x.kind == FieldKind::kCode) return CallOf{false, code[at + 1].x()};
  return std::nullopt;  // of an instance: it has no arguments in the frame
}

uint32_t width(const Unit& unit) { return ir::opcode_row(unit.opcode()).extended ? 2 : 1; }

bool names_frame(const ir::Field& field, ir::Base base, uint16_t value, uint16_t slot) {
  return field.is_near() && base == ir::Base::kFrame && value == slot;
}

}  // namespace

NextFrame::NextFrame(std::span<const Unit> code) : code_(code) {}

void NextFrame::enter(uint32_t unit) {
  at_ = unit;
  const auto arrival = arriving_.find(unit);
  if (arrival == arriving_.end()) return;
  if (!reached_) {
    last_ = arrival->second;
  } else if (last_ != arrival->second) {
    last_ = std::nullopt;
  }
  reached_ = true;
}

void NextFrame::leave(uint32_t unit) {
  const Opcode op = code_[unit].opcode();
  const OpcodeRow& row = ir::opcode_row(op);
  if (takes_next_frame(op)) {
    last_ = call_of(code_, unit);
    put_.clear();
  }
  if (row.b.kind == FieldKind::kRel32) {
    const uint32_t target = unit + 1 + code_[unit].bc();
    const auto [found, first] = arriving_.try_emplace(target, last_);
    if (!first && found->second != last_) found->second = std::nullopt;
  }
  // The jumps after a switch are its ways on, and so is what comes after them.
  if (row.ends && row.x.kind == FieldKind::kNumber) {
    switch_left_ = code_[unit + 1].y();
  } else if (switch_left_ > 0) {
    --switch_left_;
  } else if (row.ends) {
    reached_ = false;
  }
}

std::optional<CallOf> NextFrame::next_call() const {
  for (uint32_t i = at_; i < code_.size(); i += width(code_[i])) {
    if (takes_next_frame(code_[i].opcode())) return call_of(code_, i);
  }
  return std::nullopt;
}

std::optional<CallOf> NextFrame::write(uint32_t offset) {
  put_.insert(offset);
  return next_call();
}

std::optional<CallOf> NextFrame::read(uint32_t offset) const {
  return put_.contains(offset) ? next_call() : last_;
}

std::optional<CallOf> NextFrame::point(uint32_t offset, uint16_t slot) {
  return is_filled(slot) ? write(offset) : read(offset);
}

// Is something copied to where the pointer leads, before it is another one?
bool NextFrame::is_filled(uint16_t slot) const {
  for (uint32_t i = at_ + width(code_[at_]); i < code_.size(); i += width(code_[i])) {
    const Unit& unit = code_[i];
    const Opcode op = unit.opcode();
    const OpcodeRow& row = ir::opcode_row(op);
    if (takes_next_frame(op)) return false;
    if (names_frame(row.b, unit.base_b(), unit.b, slot) ||
        names_frame(row.c, unit.base_c(), unit.c, slot)) {
      return false;
    }
    if (names_frame(row.a, unit.base_a(), unit.a, slot)) return !row.a.writes();
  }
  return false;
}

}  // namespace linker
