#include "tests/fuzz/image_changes.h"

namespace fuzz {
namespace {

void change_slot(ir::FrameSlot& slot, const Change& change) {
  switch (change.how / 4 % 6) {
    case 0:
      return alter(slot.offset, change);
    case 1:
      slot.cls = static_cast<ir::Class>(change.value % ir::kClassCount);
      return;
    case 2:
      slot.kind = static_cast<ir::SlotKind>(change.value % 3);
      return;
    case 3:
      slot.local = static_cast<ir::LocalKind>(change.value % 5);
      return;
    case 4:
      slot.aggregate = !slot.aggregate;
      return;
    default:
      slot.region.type.index = change.value % 40;
      return;
  }
}

void change_pou(ir::LinkedPou& pou, const Change& change) {
  switch (change.how / 4 % 7) {
    case 0:
      return alter(pou.frame_size, change);
    case 1:
      return alter(pou.self.index, change);
    case 2:
      return alter(pou.unit_count, change);
    case 3:
      if (ir::FrameSlot* slot = pick(pou.slots, change.where / 8)) change_slot(*slot, change);
      return;
    case 4:
      if (ir::Merge* merge = pick(pou.merges, change.where)) alter(merge->unit, change);
      return;
    case 5:
      if (ir::Merge* merge = pick(pou.merges, change.where)) {
        merge->slots.assign(1, static_cast<uint16_t>(change.value % (pou.slots.size() + 1)));
      }
      return;
    default:
      pou.kind = static_cast<ir::PouKind>(change.value % ir::kPouKindCount);
      return;
  }
}

void change_unit(ir::Unit& unit, const Change& change) {
  switch (change.how / 4 % 5) {
    case 0:
      return alter(unit.a, change);
    case 1:
      return alter(unit.b, change);
    case 2:
      return alter(unit.c, change);
    case 3:
      unit.op = static_cast<uint16_t>((unit.op & ~0x3ff) | change.value % ir::kOpcodeCount);
      return;
    default:
      unit.op ^= static_cast<uint16_t>(1u << (10 + change.value % 6));
      return;
  }
}

void change_type(ir::Image& image, const Change& change) {
  const uint32_t number =
      ir::kElementaryCount + change.where % (image.types.size() - ir::kElementaryCount);
  ir::Type& type = image.types.own().edit(ir::TypeId(number));
  ir::TypeLayout& layout = image.layouts.own().of[number];
  switch (change.how / 4 % 7) {
    case 0:
      return alter(type.base.index, change);
    case 1:
      return alter(type.capacity, change);
    case 6:
      type.interfaces.assign(1, ir::TypeId(change.value % (image.types.size() + 1)));
      return;
    case 2:
      if (ir::Member* member = pick(type.members, change.value)) {
        member->type.index = change.where / 16 % (image.types.size() + 1);
      }
      return;
    case 3:
      return alter(layout.size, change);
    case 4:
      return alter(layout.area_capacity, change);
    default:
      if (uint32_t* offset = pick(layout.member_offsets, change.where / 16)) alter(*offset, change);
      return;
  }
}

void change_instance(ir::Instance& row, const Change& change) {
  switch (change.how / 4 % 5) {
    case 0:
      return alter(row.data, change);
    case 1:
      return alter(row.type.index, change);
    case 2:
      return alter(row.pou, change);
    case 3:
      return alter(row.parent, change);
    default:
      row.live = !row.live;
      return;
  }
}

void change_override(ir::LinkedOverride& row, const Change& change) {
  switch (change.how / 4 % 3) {
    case 0:
      return alter(row.type.index, change);
    case 1:
      return alter(row.prototype, change);
    default:
      return alter(row.target, change);
  }
}

void change_numbers(ir::Image& image, const Change& change) {
  uint32_t* const numbers[] = {&image.data_capacity, &image.stack_bytes, &image.call_depth,
                               &image.globals.index, &image.input_bytes};
  alter(*numbers[change.where % 5], change);
}

}  // namespace

void apply(ir::Image& image, const Change& change) {
  const auto on = [&](auto* item, auto&& act) {
    if (item != nullptr) act(*item);
  };
  switch (change.what % 16) {
    case 0:
      return on(pick(image.pous, change.where), [&](auto& p) { change_pou(p, change); });
    case 1:
      return change_type(image, change);
    case 2:
      return on(pick(image.instances, change.where), [&](auto& r) { change_instance(r, change); });
    case 3:
      return on(pick(image.bounds, change.where), [&](auto& b) { alter(b.count, change); });
    case 4:
      return on(pick(image.bounds, change.where),
                [&](auto& b) { alter(b.from.type.index, change); });
    case 5:
      return on(pick(image.data, change.where), [&](auto& d) { alter(d.offset, change); });
    case 6:
      return on(pick(image.data, change.where), [&](auto& d) {
        on(pick(d.bytes, change.where / 8), [&](auto& byte) { alter(byte, change); });
      });
    case 7:
      return on(pick(image.pool, change.where), [&](auto& byte) { alter(byte, change); });
    case 8:
      return change_numbers(image, change);
    case 9:  // an instruction in another place
      return on(pick(image.code, change.where),
                [&](auto& unit) { unit = image.code[change.value % image.code.size()]; });
    case 10:
      return on(pick(image.overrides, change.where),
                [&](auto& row) { change_override(row, change); });
    default:
      return on(pick(image.code, change.where), [&](auto& unit) { change_unit(unit, change); });
  }
}

}  // namespace fuzz
